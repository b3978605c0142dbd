"""The numbers of functions against those that the program writes for the same question.

Run from the top of the source tree, with the program's path in FISHERHILL_PROGRAM; without that there is nothing to do.
"""

import csv
import json
import math
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import fisherhill as fh

import stub

ELBOW = "models/elbow8.osim"
SLOW = "emg_data/curl_slow.sto"
FAST = "emg_data/curl_fast.sto"
DEGREE = math.pi / 180
PROGRAM = os.environ.get("FISHERHILL_PROGRAM", "")


@unittest.skipUnless(PROGRAM, "FISHERHILL_PROGRAM is not set")
class AsTheProgram(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = fh.load_model(ELBOW)
        cls.slow, cls.fast = (fh.load_trial(file, cls.model) for file in (SLOW, FAST))

    def run_program(self, *words, status=0):
        """summary.json, and the folder that it lies in."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        out = pathlib.Path(folder.name) / "out"
        done = subprocess.run([PROGRAM, *words, "--out", str(out), "--seed", "3", "--threads", "2"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, status, done.stderr)
        return json.loads((out / "summary.json").read_text(encoding="utf-8")), out

    def rows(self, file):
        with open(file, encoding="utf-8") as table:
            return list(csv.DictReader(table))

    def column(self, rows, name):
        return np.array([float(row[name]) for row in rows])


class Sensitivity(AsTheProgram):
    def same_parameters(self, found, summary, unit):
        self.assertEqual(len(summary["parameters"]), len(found.names))
        for one in summary["parameters"]:
            k = found.names.index(one["name"])
            for mine, its in ((found.values, "value"), (found.prior_sd, "prior_sd"), (found.bound_alone, "bound_alone"),
                              (found.bound_joint, "bound_joint")):
                self.assertEqual(mine[k], math.inf if one[its] is None else one[its])
            self.assertEqual(found.normalised_sensitivity[k] * unit, one["normalised_sensitivity"])
            self.assertEqual(found.identifiable[k], one["identifiable"])
        self.assertEqual(found.sentences, summary["not_told_apart"])
        self.assertEqual(found.determined_combinations, summary["determined_combinations"])

    def same_channels(self, found, summary):
        self.assertEqual(len(found.further_channels), len(summary["further_channels"]))
        for mine, its in zip(found.further_channels, summary["further_channels"]):
            self.assertEqual(
                [mine.channel, mine.noise, mine.unit, mine.information, mine.parameter, mine.bound_before, mine.bound_after],
                [its[name] for name in ("channel", "noise", "unit", "information_nats", "parameter", "bound_before",
                                        "bound_after")])

    def test_of_the_coordinate_in_two_trials(self):
        summary, out = self.run_program("sensitivity", ELBOW, SLOW, FAST, "--parameters", "*.radius,hand.mass,emg.delay")
        found = fh.sensitivity(self.model, [self.slow, self.fast], ["*.radius", "hand.mass", "emg.delay"], further_channels=True)
        stub.check(found, "SensitivityResult")
        self.same_parameters(found, summary, 180 / math.pi)
        self.same_channels(found, summary)
        self.assertEqual(found.observed, ["elbow_flexion"])
        self.assertEqual(sum(len(one) for one in found.outputs), summary["samples"])
        np.testing.assert_allclose(np.array([self.column(self.rows(out / "fisher.csv"), name) for name in found.names]).T,
                                   found.fisher, rtol=1e-8)

    def test_of_channels(self):
        summary, _ = self.run_program("sensitivity", ELBOW, SLOW, "--parameters", "*.radius,*.mass,BRA.*", "--observe",
                                      "elbow_flexion=0.01", "--observe", "BRA.tendon_force=5")
        observe = {"BRA.tendon_force": 5, "elbow_flexion": 0.01}
        found = fh.sensitivity(self.model, [self.slow], ["*.radius", "*.mass", "BRA.*"], observe=observe,
                               further_channels=True)
        stub.check(found, "SensitivityResult")
        self.assertEqual(found.observed, list(observe))
        n = len(found.times[0])
        self.assertEqual(len(found.outputs[0]), 2 * n)
        # channels are in another order there, and sums round otherwise
        for one in summary["parameters"]:
            k = found.names.index(one["name"])
            self.assertAlmostEqual(found.bound_joint[k] / one["bound_joint"], 1, 9)
        self.assertNotIn("elbow_flexion", [one.channel for one in found.further_channels])
        self.assertEqual({one.channel for one in found.further_channels},
                         {one["channel"] for one in summary["further_channels"]})
        # information adds up
        force, angle = (fh.sensitivity(self.model, [self.slow], ["*.radius", "*.mass", "BRA.*"], observe={name: sd})
                        for name, sd in observe.items())
        np.testing.assert_allclose(force.fisher + angle.fisher, found.fisher, rtol=1e-9)
        np.testing.assert_allclose(angle.fisher, found.gamma[0][n:].T @ found.gamma[0][n:] / 0.01**2, rtol=1e-9)
        np.testing.assert_array_equal(force.gamma[0], found.gamma[0][:n])

    def test_what_a_further_channel_adds_is_there_when_it_is_observed(self):
        best = fh.sensitivity(self.model, [self.slow], ["TRI.radius", "hand.mass"], noise=0.01,
                              further_channels=True).further_channels[0]
        self.assertNotEqual(best.channel, "elbow_flexion")
        both = fh.sensitivity(self.model, [self.slow], ["TRI.radius", "hand.mass"],
                              observe={"elbow_flexion": 0.01, best.channel: best.noise})
        self.assertAlmostEqual(both.bound_joint[both.names.index(best.parameter)] / best.bound_after, 1, 9)

    def test_sweep(self):
        summary, out = self.run_program("sensitivity", ELBOW, SLOW, "--parameter", "TRI.radius", "--values", "0.012,0.02")
        found = fh.parameter_sweep(self.model, self.slow, "TRI.radius", [0.012, 0.02])
        stub.check(found, "ParameterSweepResult")
        self.assertEqual([found.parameter, found.unit, found.model_value],
                         [summary["sweep"][name] for name in ("parameter", "unit", "model_value")])
        for k, one in enumerate(summary["sweep"]["runs"]):
            self.assertEqual(found.values[k], one["value"])
            self.assertAlmostEqual(found.rms_change[k] / DEGREE, one["rms_change_deg"], 12)
            self.assertAlmostEqual(found.max_change[k] / DEGREE, one["max_change_deg"], 12)
            self.assertAlmostEqual(np.abs(found.motions[k] - found.nominal).max(), found.max_change[k], 14)
        self.assertEqual(found.outcome, ["ok", "ok"])
        rows = self.rows(out / "sweep.csv")
        np.testing.assert_allclose(self.column(rows, "time"), found.time, rtol=1e-8)
        np.testing.assert_allclose(self.column(rows, "TRI.radius=0.02") * DEGREE, found.motions[1], rtol=1e-8)
        np.testing.assert_allclose(found.nominal, fh.replay(self.model, self.slow).q[:, 0], rtol=0, atol=1e-14)

    def test_profile_and_global_sensitivity(self):
        names = ["TRI.radius", "hand.mass"]
        summary, out = self.run_program("sensitivity", ELBOW, SLOW, "--parameters", ",".join(names), "--profile", names[0],
                                        "--global", "both", "--samples", "4")
        profile = fh.profile_likelihood(self.model, [self.slow], names, names[0])
        stub.check(profile, "ProfileLikelihoodResult")
        self.assertEqual({"parameter": profile.parameter, "bounded_below": profile.bounded_below,
                          "bounded_above": profile.bounded_above}, summary["profile"])
        rows = self.rows(out / "profile.csv")
        np.testing.assert_allclose(self.column(rows, "value"), profile.values, rtol=1e-8)
        np.testing.assert_allclose(self.column(rows, "cost"), profile.costs, rtol=1e-8)
        self.assertAlmostEqual(self.column(rows, "threshold")[0], profile.threshold, 7)
        self.assertEqual(profile.parameters.shape, (13, 2))
        np.testing.assert_array_equal(profile.parameters[:, 0], profile.values)

        found = fh.global_sensitivity(self.model, [self.slow], names, samples=4, seed=3, threads=2)
        stub.check(found, "GlobalSensitivityResult")
        self.assertEqual((found.morris.runs, found.sobol.runs), (summary["morris_runs"], summary["sobol_runs"]))
        rows = self.rows(out / "global.csv")
        self.assertEqual([row["parameter"] for row in rows], found.names)
        for mine, its in ((found.morris.mean_absolute / DEGREE, "morris_mean_absolute"), (found.morris.sd / DEGREE, "morris_deviation"),
                          (found.sobol.first, "sobol_first"), (found.sobol.first_sd, "sobol_first_sd"),
                          (found.sobol.total, "sobol_total"), (found.sobol.total_sd, "sobol_total_sd")):
            np.testing.assert_allclose(self.column(rows, its), mine, rtol=1e-8)
        screened = fh.global_sensitivity(self.model, [self.slow], names, method="morris", samples=4, seed=3)
        self.assertIsNone(screened.sobol)
        np.testing.assert_array_equal(screened.morris.mean_absolute, found.morris.mean_absolute)

    def test_wrong_questions_are_one_line(self):
        one = ["TRI.radius"]
        for call, words in (
            (lambda: fh.sensitivity(self.model, [self.slow], one, observe={"BRA.length": 1}), "observe: 'BRA.length'"),
            (lambda: fh.sensitivity(self.model, [self.slow], one, observe={"elbow_flexion": 0}), "observe: noise of"),
            (lambda: fh.sensitivity(self.model, [self.slow], one, observe={"elbow_flexion.moment": 1}), "moment"),
            (lambda: fh.parameter_sweep(self.model, self.slow, one[0], [0.2]), "values: TRI.radius = 0.2 m, must be"),
            (lambda: fh.profile_likelihood(self.model, [self.slow], one, "hand.mass"), "profile: hand.mass is not one"),
            (lambda: fh.global_sensitivity(self.model, [self.slow], ["all"]), "must be at most 32"),
            (lambda: fh.global_sensitivity(self.model, [self.slow], one, method="fast"), "method 'fast'"),
            (lambda: fh.global_sensitivity(self.model, [self.slow], one, samples=1), "samples|trajectories"),
            (lambda: fh.global_sensitivity(self.model, [], one), "trials: empty"),
        ):
            with self.subTest(words), self.assertRaisesRegex(ValueError, words) as raised:
                call()
            self.assertEqual(str(raised.exception).count("\n"), 0)


del AsTheProgram  # has no tests of its own

if __name__ == "__main__":
    unittest.main()
