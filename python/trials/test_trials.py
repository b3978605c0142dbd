"""Trials as columns and with other excitations; errors of readers name the file and the place in it."""

import os
import tempfile
import unittest

import numpy as np

import fisherhill as fh

SLOW = "emg_data/curl_slow.sto"


class Trials(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = fh.load_model("models/elbow8.osim")
        cls.trial = fh.load_trial(SLOW, cls.model)

    def test_columns_are_those_that_make_trial_takes(self):
        columns = self.trial.columns(self.model)
        self.assertEqual(list(columns)[:9], ["time", *self.trial.muscles])
        self.assertEqual({len(one) for one in columns.values()}, {901})
        again = fh.make_trial(self.model, columns)
        np.testing.assert_array_equal(again.excitations, self.trial.excitations)
        for name, (times, values) in self.trial.measured.items():
            np.testing.assert_array_equal(again.measured[name][0], times)
            np.testing.assert_array_equal(again.measured[name][1], values)

    def test_gaps_loads_channels_and_prescribed_motions_come_back(self):
        times = np.linspace(0, 1, 11)
        angle = 0.5 + 0.1 * times
        angle[[3, 4, 10]] = np.nan
        given = {
            "time": times,
            "BRA": np.linspace(0, 0.5, 11),
            "elbow_flexion": angle,
            "elbow_flexion.torque": np.cos(times),
            "elbow_flexion.speed": 0.1 + times,
            "BRA.fiber_length": np.where(times > 0.5, 0.1, np.nan),
        }
        found = fh.make_trial(self.model, given).columns(self.model)
        for name, values in given.items():
            np.testing.assert_array_equal(found[name], values, err_msg=name)
        given["elbow_flexion"] = 0.5 + 0.1 * times
        moved = fh.make_trial(self.model, given, prescribe=["elbow_flexion"])
        np.testing.assert_array_equal(moved.columns(self.model)["elbow_flexion"], given["elbow_flexion"])
        smooth = fh.make_trial(self.model, given, prescribe=["elbow_flexion"], prescribe_cutoff=5.0)
        np.testing.assert_allclose(smooth.columns(self.model)["elbow_flexion"], given["elbow_flexion"], atol=1e-3)

    def test_other_excitations_are_simulated(self):
        changed = self.trial.excitations.copy()
        changed[:, self.trial.muscles.index("BRA")] = 0.3
        other = self.trial.with_excitations(changed)
        np.testing.assert_array_equal(other.excitations, changed)
        self.assertFalse(np.array_equal(self.trial.excitations, changed))
        made = fh.make_trial(self.model, self.trial.columns(self.model) | {"BRA": np.full(901, 0.3)})
        np.testing.assert_array_equal(fh.replay(self.model, other).q, fh.replay(self.model, made).q)
        for wrong, why in (
            (changed[:, :3], "901 x 3 numbers, must be 901 x 8"),
            (np.full((901, 8), np.nan), "excitation of TRIlong at 0.* s = nan, must be 0 to 1"),
            (changed + 0.8, "must be 0 to 1"),
        ):
            with self.assertRaisesRegex(ValueError, why):
                self.trial.with_excitations(wrong)


class Errors(unittest.TestCase):
    """ValueError of one line that begins with the file and, where there is one, the line in it."""

    def refused(self, name, text, call, expected):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, name)
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            with self.assertRaises(ValueError) as caught:
                call(path)
            said = str(caught.exception)
            self.assertTrue(said.startswith(path + expected), said)
            self.assertNotIn("\n", said)

    def test_they_name_file_and_line(self):
        model = fh.load_model("models/elbow8.osim")
        self.refused("t.csv", "time,BRA\n0,0.1\n0.1,x\n", lambda path: fh.load_trial(path, model), ":3:")
        self.refused("t.csv", "time,BRA\n0,0.1\n0.1,7\n", lambda path: fh.load_trial(path, model), ": column 'BRA' at time = 0.1 s: excitation = 7,")
        self.refused("m.osim", "<OpenSimDocument>\n<Model>\n</OpenSimDocument>\n", fh.load_model, ":")
        self.refused("c.toml", "[input]\nformt = 1\n", lambda path: fh.emg("emg_data/curl_slow_raw.csv", path), ":2:")
        self.refused("s.toml", "title = 3\n", fh.read_study, ":1:")
        self.refused("r.csv", "1\t2\n3\tx\n", fh.read_recording, ":2:")
        self.refused("w.csv", "class\nThelen\n", fh.muscle_states, ":")


if __name__ == "__main__":
    unittest.main()
