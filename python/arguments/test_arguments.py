"""What functions take where the stub says a file, columns, an array: kinds of the same, and what is none."""

import pathlib
import tempfile
import unittest

import numpy as np

import fisherhill as fh

ELBOW = "models/elbow8.osim"
SLOW = "emg_data/curl_slow.sto"


class Frame:
    """What functions ask of a pandas DataFrame."""

    def __init__(self, columns, dtype=float):
        self.columns = list(columns)
        self._rows = np.array(list(columns.values()), dtype).T

    def to_numpy(self):
        return self._rows


class Arguments(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = fh.load_model(ELBOW)
        cls.trial = fh.load_trial(SLOW, cls.model)

    def columns(self, **more):
        return {"time": np.linspace(0, 1, 5), "BRA": np.full(5, 0.1), "elbow_flexion": np.full(5, 0.5)} | more

    def refused(self, error, words, call):
        with self.subTest(words), self.assertRaisesRegex(error, words) as raised:
            call()
        self.assertNotIn("\n", str(raised.exception))
        self.assertIs(type(raised.exception), error)

    def test_a_column_that_is_none_is_named(self):
        wrong = (
            (TypeError, "column '{}': None, must be numbers", None),
            (TypeError, "column '{}': a single float, must be", 0.1),
            (TypeError, "column '{}': a single str|column '{}': could not convert string", "0.1"),
            (TypeError, "column '{}': complex128, must be numbers", np.full(5, 1j)),
            (TypeError, "column '{}': datetime64.*, must be numbers", np.full(5, "2026-01-01", "M8[s]")),
            (ValueError, "column '{}': an array of 5 x 2 numbers, must have one dimension", np.zeros((5, 2))),
            (ValueError, "column '{}': an array of 1 x 5 numbers", np.zeros((1, 5))),
            (ValueError, "column '{}': could not convert string to float: 'half'", ["0.1", "half", "0", "0", "0"]),
            (ValueError, "column '{}': .*inhomogeneous", [[1, 2], [3]]),
            (ValueError, "column '{}': float.. argument must be", [{}, 1, 2, 3, 4]),
            (ValueError, "column '{}' has 4 rows, must be 5 as ", np.zeros(4)),
        )
        for error, words, values in wrong:
            for name in ("BRA", "elbow_flexion"):
                self.refused(error, "^trial: " + words.replace("{}", name),
                             lambda: fh.make_trial(self.model, self.columns(**{name: values})))
            self.refused(error, "^postures: " + words.replace("{}", "pro_sup"),
                         lambda: fh.moment_arms(self.model, {"elbow_flexion": np.zeros(5), "pro_sup": values}))
            self.refused(error, "^trial 1: " + words.replace("{}", "force_N"),
                         lambda: fh.discover_robot("suspended-mass", [{"time": np.zeros(5), "force_N": values}]))
        self.refused(TypeError, "^rerun: column name 3 is a int, must be a str",
                     lambda: fh.make_trial(self.model, self.columns() | {3: np.zeros(5)}, name="rerun"))
        for other, kind in ((None, "NoneType"), ([1, 2], "list"), (1.0, "float")):
            self.refused(TypeError, f"a {kind}, must be a dict of columns or a DataFrame",
                         lambda: fh.make_trial(self.model, other))
            self.refused(TypeError, f"a {kind}, must be a dict of columns or a DataFrame",
                         lambda: fh.moment_arms(self.model, other))
        self.refused(TypeError, "also: times of 'other': None, must be numbers",
                     lambda: fh.compare(self.model, self.trial, also={"other": (None, [1, 2])}, steps=[0.01], timings=1,
                                        integrators=["vi"]))

    def test_one_column_of_two_dimensions_lists_and_other_numbers_are_numbers(self):
        whole = fh.make_trial(self.model, self.columns())
        for bra in ([0.1] * 5, np.full((5, 1), 0.1), ["0.1"] * 5, np.array([0.1] * 5, object)):
            same = fh.make_trial(self.model, self.columns(BRA=bra))
            np.testing.assert_array_equal(same.excitations, whole.excitations)
        whole = fh.make_trial(self.model, self.columns(BRA=np.array([0, 1, 0, 1, 0])))
        np.testing.assert_array_equal(whole.excitations[:, whole.muscles.index("BRA")], [0, 1, 0, 1, 0])
        missing = fh.make_trial(self.model, self.columns(elbow_flexion=[0.5, None, 0.5, float("nan"), 0.5]))
        self.assertEqual(len(missing.measured["elbow_flexion"][0]), 3)

    def test_a_data_frame_is_a_table_of_columns(self):
        columns = self.columns()
        whole = fh.make_trial(self.model, columns)
        for frame in (Frame(columns), Frame(columns, object)):
            same = fh.make_trial(self.model, frame)
            np.testing.assert_array_equal(same.times, whole.times)
            np.testing.assert_array_equal(same.excitations, whole.excitations)
            np.testing.assert_array_equal(same.measured["elbow_flexion"], whole.measured["elbow_flexion"])
        postures = {"elbow_flexion": np.linspace(0, 2, 4), "pro_sup": np.linspace(0.1, 0.2, 4)}
        arms, same = fh.moment_arms(self.model, postures), fh.moment_arms(self.model, Frame(postures))
        np.testing.assert_array_equal(same.length, arms.length)
        self.assertEqual(list(same.moment_arm), list(arms.moment_arm))
        self.refused(ValueError, "trial 1: column 'time': could not convert string to float: 'a'",
                     lambda: fh.discover_robot("suspended-mass", [Frame({"time": ["a", 1], "force_N": [0, 1]}, object)]))
        frame = Frame(columns)
        frame.columns[2] = "BRA"
        self.refused(ValueError, "column 'BRA' is given twice", lambda: fh.make_trial(self.model, frame))
        frame.columns[2] = ("BRA", "mV")
        self.refused(TypeError, "column name .'BRA', 'mV'. is a tuple", lambda: fh.make_trial(self.model, frame))

    def test_a_data_frame_of_pandas(self):
        try:
            import pandas
        except ImportError:
            self.skipTest("pandas is not installed")
        columns = self.columns()
        frame = pandas.DataFrame(columns | {"remark": ["-"] * 5})
        same = fh.make_trial(self.model, frame.drop(columns="remark"))
        np.testing.assert_array_equal(same.excitations, fh.make_trial(self.model, columns).excitations)
        self.refused(ValueError, "column 'remark': could not convert", lambda: fh.make_trial(self.model, frame))

    def test_a_path_is_the_name_of_a_file(self):
        path = pathlib.Path
        model = fh.load_model(path(ELBOW))
        self.assertEqual(fh.load_trial(path(SLOW), model).name, SLOW)
        raw, config = path("emg_data/curl_slow_raw.csv"), path("emg_data/configs/shipped_raw.toml")
        with tempfile.TemporaryDirectory() as folder:
            file = path(folder) / "copy é.osim"
            model.write(file)
            self.assertEqual(fh.load_model(file).muscles, model.muscles)
            for recordings in (raw, [raw], str(raw), [str(raw)]):
                fh.emg(recordings, config, write=path(folder) / "emg.sto")
            self.assertGreater(len(fh.load_trial(path(folder) / "emg.sto", model).times), 10)
            # what must be there is named
            none = path(folder) / "none.file"
            for call in (lambda: model.with_external_loads(none), lambda: fh.read_recording(none),
                         lambda: fh.fit_paths(model, table=none), lambda: fh.study(none), lambda: fh.read_study(none),
                         lambda: fh.discover_robot("suspended-mass", [none]),
                         lambda: fh.compare(model, self.trial, also={"other": none}, steps=[0.01], timings=1,
                                            integrators=["vi"])):
                self.refused(ValueError, "none.file", call)
            trial = {"time": np.linspace(0, 1, 50), "input": np.zeros(50), "force_N": np.linspace(1, 2, 50)}
            self.refused(ValueError, "none.file",
                         lambda: fh.discover_robot("suspended-mass", [trial], with_effects=none))
        self.assertEqual(len(fh.muscle_states(path("models/muscle_states.csv")).muscle_class),
                         len(fh.muscle_states("models/muscle_states.csv").muscle_class))
        for wrong in (1, None, ["a"]):
            with self.assertRaises(TypeError):
                fh.load_model(wrong)

    def test_a_bound_is_not_that_of_half_a_matrix(self):
        information = np.array([[4.0, 1.0], [1.0, 2.0]])
        np.testing.assert_allclose(fh.cramer_rao_bound(information), np.linalg.inv(information))
        for other in (0.0, 1.001, -1.0):
            information[0, 1] = other
            self.refused(ValueError, r"must be symmetric, but entry \(a, b\) is .* and \(b, a\) is 1",
                         lambda: fh.cramer_rao_bound(information, ["a", "b"]))
            self.refused(ValueError, r"must be symmetric, but entry \(a, b\) is .* and \(b, a\) is 1",
                         lambda: fh.identifiability(information, [1, 1], ["a", "b"]))
        information[0, 1] = 1 + 1e-9  # rounding
        fh.cramer_rao_bound(information)
        self.refused(ValueError, "names: 1, must be 2", lambda: fh.cramer_rao_bound(information, ["a"]))

    def test_arrays_that_are_none(self):
        predict = lambda theta: np.ones(3) * theta[0]
        for error, words, call in (
            (ValueError, "gamma: could not convert", lambda: fh.fisher_information("abc", 1)),
            (TypeError, "gamma: None", lambda: fh.fisher_information(None, 1)),
            (TypeError, "noise: None", lambda: fh.fisher_information([[1]], None)),
            (ValueError, "noise: could not convert", lambda: fh.fisher_information([[1]], "a")),
            (ValueError, "noise: 3 dimensions", lambda: fh.fisher_information([[1]], np.ones((1, 1, 1)))),
            (ValueError, "measured: 3 dimensions", lambda: fh.estimate(predict, np.ones((1, 1, 1)), 1, [1])),
            (TypeError, "measured: None", lambda: fh.estimate(predict, None, 1, [1])),
            (TypeError, "outputs: None", lambda: fh.estimate(lambda theta: None, [1, 2, 3], 1, [1])),
            (TypeError, "sensitivities: None",
             lambda: fh.estimate(predict, [1, 2, 3], 1, [1], sensitivities=lambda theta: None)),
            (TypeError, "f: None", lambda: fh.System(lambda x, u, theta, t: None, [1], [0, 1])([1])),
        ):
            self.refused(error, words, call)


if __name__ == "__main__":
    unittest.main()
