"""Model.with_parameters beside the program's --set: the same motions, bounds, estimates and refusals."""

import unittest

import numpy as np

import fisherhill as fh

from beside_program.as_the_program import ELBOW, SLOW, AsTheProgram

SET = {"TRI.radius": 0.018, "hand.mass": 0.7, "BRA.optimal_fibre_length": 0.09}
WORDS = [word for name, value in SET.items() for word in ("--set", f"{name}={value!r}")]


class WithParameters(AsTheProgram):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.other = cls.model.with_parameters(SET)

    def value(self, model, name):
        return next(one.value for one in fh.list_parameters(model) if one.name == name)

    def test_motions_are_those_of_replay_with_set(self):
        summary, out = self.run_program("replay", ELBOW, SLOW, *WORDS)
        found = fh.replay(self.other, self.slow)
        lines = (out / "states.sto").read_text(encoding="utf-8").splitlines()
        table = lines[lines.index("endheader") + 1:]
        column = table[0].split("\t").index("/jointset/elbow/elbow_flexion/value")
        its = np.array([float(line.split("\t")[column]) for line in table[1:]])
        np.testing.assert_allclose(found.q[:, 0], its, rtol=1e-12, atol=1e-12)
        degrees = np.degrees(found.rms_error["elbow_flexion"])
        self.assertAlmostEqual(degrees, summary["rms_error_deg"], 10)
        self.assertGreater(abs(degrees - np.degrees(fh.replay(self.model, self.slow).rms_error["elbow_flexion"])), 0.1)
        self.assertEqual({name: one["value"] for name, one in summary["set_parameters"].items()},
                         {name.replace("fibre", "fiber"): value for name, value in SET.items()})

    def test_the_model_that_was_given_stays(self):
        before = self.value(self.model, "TRI.radius")
        self.assertEqual(self.value(self.other, "TRI.radius"), 0.018)
        self.assertEqual(before, 0.016)
        same = self.model.with_parameters()
        self.assertEqual([vars(one) for one in fh.list_parameters(same)], [vars(one) for one in fh.list_parameters(self.model)])

    def test_a_dict_and_arguments_of_their_own_are_alike(self):
        named = self.model.with_parameters({"TRI.radius": np.float64(0.018)}, **{"hand.mass": 1})
        self.assertEqual(self.value(named, "TRI.radius"), 0.018)
        self.assertEqual(self.value(named, "hand.mass"), 1)

    def test_bounds_are_those_of_sensitivity_with_set(self):
        summary, _ = self.run_program("sensitivity", ELBOW, SLOW, "--parameters", "TRI.radius,BRA.point1.x", *WORDS)
        found = fh.sensitivity(self.other, [self.slow], ["TRI.radius", "BRA.point1.x"])
        its = {one["name"]: one for one in summary["parameters"]}
        for name, value, bound in zip(found.names, found.values, found.bound_joint):
            self.assertEqual(its[name]["value"], value)
            self.assertAlmostEqual(its[name]["bound_joint"] / bound, 1, 9)

    def test_a_calibration_starts_there(self):
        summary, out = self.run_program("calibrate", ELBOW, SLOW, "--parameters", "TRI.radius", "--step", "0.01", *WORDS)
        found = fh.calibrate(self.other, [self.slow], ["TRI.radius"], step=0.01)
        row = self.rows(out / "parameters.csv")[0]
        self.assertEqual(float(row["nominal"]), 0.018)
        self.assertAlmostEqual(found.estimates["TRI.radius"].value / summary["estimates"]["TRI.radius"]["value"], 1, 9)
        # the numbers that were set and not estimated are in the model that is written
        written = fh.load_model(out / "calibrated.osim")
        self.assertAlmostEqual(self.value(written, "hand.mass"), 0.7, 12)

    def test_refusals_are_the_programs(self):
        for name, value, words in (
            ("TRI.raduis", 0.018, "^no parameter is called 'TRI.raduis'; nearest: TRI.radius"),
            ("hand.mass", -0.1, "^hand.mass = -0.1 kg, must be ≥ 0$"),
            ("hand.mass", float("nan"), "finite"),
            ("TRI.radius", 1.0, "must be below"),
            ("emg.BRA.gain", 1.5, "belongs to a trial"),
            ("initial.elbow_flexion", 0.5, "belongs to a trial"),
        ):
            self.one_line(lambda: self.model.with_parameters({name: value}), words)
        self.one_line(lambda: self.model.with_parameters({"hand.mass": 1}, **{"hand.mass": 1}), "'hand.mass' is given twice")
        self.one_line(lambda: self.model.with_parameters({"BRA.pennation": 0.1, "BRA.pennation_angle": 0.1}), "given twice")
        self.one_line(lambda: self.model.with_parameters({"activation.time_scale": 0.1, "BRA.time_scale": 0.1}), "set the same")
        self.one_line(lambda: self.model.with_parameters({"hand.mass": 1}, coordinate="knee"), "knee")
        for call, words in ((lambda: self.model.with_parameters({"hand.mass": "heavy"}), "hand.mass: a str, must be a number"),
                            (lambda: self.model.with_parameters({"hand.mass": None}), "hand.mass: a NoneType"),
                            (lambda: self.model.with_parameters({3: 1.0}), "name is a int"),
                            (lambda: self.model.with_parameters(0.5), "values: a float, must be a dict")):
            with self.assertRaisesRegex(TypeError, words):
                call()


if __name__ == "__main__":
    unittest.main()
