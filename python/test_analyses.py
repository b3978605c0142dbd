"""ensemble, compare, compare_muscles and study against the program ($FISHERHILL_PROGRAM) on the shipped data."""

import csv
import json
import math
import os
import signal
import subprocess
import tempfile
import threading
import unittest

import numpy as np

import fisherhill as fh

import stub

PROGRAM = os.environ["FISHERHILL_PROGRAM"]
ELBOW = "models/elbow8.osim"
SLOW = "emg_data/curl_slow.sto"
DEGREE = math.pi / 180


def program(folder, *words):
    """Runs the program; its folder of results."""
    out = os.path.join(folder, "out")
    subprocess.run([PROGRAM, *words, "--out", out, "--force"], check=False, capture_output=True)
    return out


def table(folder, name):
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return list(csv.DictReader(file))


def summary(folder):
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        return json.load(file)


def number(cell):
    return float(cell) if cell else math.nan


class AgainstProgram(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = fh.load_model(ELBOW)
        cls.trial = fh.load_trial(SLOW, cls.model)

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.scratch = scratch.name


class Ensemble(AgainstProgram):
    def is_that_of(self, found, out):
        """draws.csv has nine digits of outputs and all of parameters, band.csv is made of seven."""
        stub.check(found, "EnsembleResult")
        rows = table(out, "draws.csv")
        self.assertEqual(len(rows), len(found.outcome))
        self.assertEqual([row["outcome"] for row in rows], found.outcome)
        for i, law in enumerate(found.laws):
            column = f"{law.name} [{law.unit}]" if law.unit else law.name
            self.assertEqual([float(row[column]) for row in rows], list(found.parameters[:, i]))
        for name, values in found.outputs.items():
            wanted = [number(row[f"{name}_deg"]) for row in rows]
            np.testing.assert_allclose(values / DEGREE, wanted, rtol=1e-8)
        for name in ("nominal", "mean", "p5", "p50", "p95"):
            wanted = [float(row[f"{name}_deg"]) for row in table(out, "band.csv")]
            np.testing.assert_allclose(getattr(found.band, name) / DEGREE, wanted, rtol=1e-6)
        told = summary(out)
        for name, spread in found.spread.items():
            for of in ("nominal", "mean", "sd", "p5", "p50", "p95"):
                np.testing.assert_allclose(getattr(spread, of) / DEGREE, told[f"{name}_deg"][of], rtol=1e-7, atol=1e-9)
        self.assertEqual(dict(zip(*np.unique(found.outcome, return_counts=True))), told["outcomes"])

    def test_draws_are_those_of_the_program(self):
        out = program(self.scratch, "ensemble", ELBOW, SLOW, "--draws", "40", "--seed", "5")
        found = fh.ensemble(self.model, self.trial, draws=40, seed=5, threads=2)
        self.is_that_of(found, out)
        self.assertEqual(len(found.laws), 285)
        self.assertGreater(found.left_range, 0)
        self.assertEqual(found.course.shape, (40, 46))
        fewer = fh.ensemble(self.model, self.trial, draws=7, seed=5)
        np.testing.assert_array_equal(fewer.course, found.course[:7])

    def test_distributions_are_those_of_the_program(self):
        out = program(self.scratch, "ensemble", ELBOW, SLOW, "--draws", "20", "--parameters", "TRI.radius,hand.mass",
                      "--distribution", "uniform", "--spread", "0.5", "--prior", "hand.mass=0.6:0.2", "--bounds",
                      "hand.mass=0.5:0.9", "--band-points", "5", "--step", "0.02", "--initial", "elbow_flexion=0.4")
        found = fh.ensemble(self.model, self.trial, draws=20, parameters=["TRI.radius", "hand.mass"],
                            distribution="uniform", spread=0.5, prior={"hand.mass": (0.6, 0.2)},
                            bounds={"hand.mass": (0.5, 0.9)}, band_points=5, step=0.02, initial={"elbow_flexion": 0.4})
        self.is_that_of(found, out)
        for law, told in zip(found.laws, summary(out)["parameters"]):
            self.assertEqual([law.name, law.unit, law.mean, law.sd, law.lower, law.upper],
                             [told[key] for key in ("name", "unit", "mean", "sd", "from", "to")])

    def test_a_covariance_is_drawn_as_in_the_program(self):
        names, values = ["TRI.radius", "hand.mass"], [[1e-6, -1.5e-5], [-1.5e-5, 4e-4]]
        file = os.path.join(self.scratch, "c.csv")
        with open(file, "w", encoding="utf-8") as out:
            csv.writer(out).writerows([names, *values])
        out = program(self.scratch, "ensemble", ELBOW, SLOW, "--draws", "30", "--covariance", file)
        found = fh.ensemble(self.model, self.trial, draws=30, covariance=(names, values))
        self.is_that_of(found, out)
        self.assertLess(np.corrcoef(found.parameters.T)[0, 1], -0.5)
        for wrong, words in ((([*names, "ulna.mass"], values), "2 × 2 values for 3 names"),
                             ((names, [[1e-6, 0], [1, 4e-4]]), "must be symmetric"),
                             ((names, [[1e-6, 3e-5], [3e-5, 4e-4]]), "covariance: not positive definite")):
            with self.assertRaisesRegex(ValueError, words):
                fh.ensemble(self.model, self.trial, draws=2, covariance=wrong)

    def test_sobols_indices_are_those_of_the_program(self):
        names = ["TRI.radius", "hand.mass", "BRA.max_isometric_force"]
        out = program(self.scratch, "ensemble", ELBOW, SLOW, "--draws", "16", "--sobol", "--output", "max",
                      "--parameters", ",".join(names), "--seed", "2")
        found = fh.ensemble(self.model, self.trial, draws=16, seed=2, parameters=names, sobol=True, output="max")
        self.is_that_of(found, out)
        for i, row in enumerate(table(out, "sobol.csv")):
            self.assertEqual(row["parameter"], names[i])
            for of in ("first", "total"):
                wanted = [float(row[of + end]) for end in ("", "_low", "_high")]
                interval = getattr(found.sobol, of + "_interval")[i]
                np.testing.assert_allclose([getattr(found.sobol, of)[i], *interval], wanted, rtol=1e-6)

    def test_channels_are_those_of_the_program(self):
        channels = ["shoulder_elv", "elbow_flexion.speed", "BIClong.tendon_force"]
        joints = ["elbow_flexion", "shoulder_elv"]
        out = program(self.scratch, "ensemble", ELBOW, SLOW, "--draws", "6", "--parameters", "hand.mass", "--sobol",
                      "--observe", ",".join(channels), *(word for name in joints for word in ("--coordinate", name)))
        found = fh.ensemble(self.model, self.trial, draws=6, parameters=["hand.mass"], sobol=True, observe=channels,
                            coordinate=joints)
        stub.check(found, "EnsembleResult")
        self.assertEqual([one.name for one in found.channels], channels)
        self.assertEqual([one.unit for one in found.channels], ["rad", "rad/s", "N"])
        told = summary(out)["channels"]
        for channel in found.channels:
            shown = DEGREE if channel.unit.startswith("rad") else 1
            for name, spread in channel.spread.items():
                for of in ("nominal", "mean", "sd", "p5", "p50", "p95"):
                    wanted = told[channel.name][name][of]
                    np.testing.assert_allclose(getattr(spread, of) / shown, math.nan if wanted is None else wanted,
                                               rtol=1e-7, atol=1e-9)
            np.testing.assert_allclose(channel.sobol.total, [one["total"] for one in told[channel.name]["sobol"]["indices"]],
                                       rtol=1e-5)
            self.assertEqual(channel.course.shape, (18, 46))
        self.assertEqual(found.coordinate, "shoulder_elv")
        np.testing.assert_array_equal(found.course, found.channels[0].course)
        np.testing.assert_array_equal(found.outputs["max"], found.channels[0].outputs["max"])

    def test_a_prescribed_elbows_moment_is_that_of_replay(self):
        trial = fh.load_trial(SLOW, self.model, prescribe=["elbow_flexion"])
        found = fh.ensemble(self.model, trial, draws=3, parameters=["hand.mass"], observe=["elbow_flexion.moment"],
                            band_points=451)
        alone = fh.replay(self.model, trial)
        np.testing.assert_allclose(found.band.nominal, -alone.reaction["elbow_flexion"], rtol=0, atol=1e-9)
        self.assertEqual([found.channels[0].unit, found.left_range], ["N·m", 0])
        with self.assertRaisesRegex(ValueError, "no coordinate is free to be observed: observe must name what is"):
            fh.ensemble(self.model, trial, draws=3)

    def test_rules(self):
        for words, more in (
            ("no parameter is called 'TRI.radios'", {"parameters": ["TRI.radios"]}),
            ("draws = 0, must be 1 to 10000000", {"draws": 0}),
            ("threads = -1, must be ≥ 0", {"threads": -1}),
            ("band_points = 1", {"band_points": 1}),
            ("distribution 'cauchy'", {"distribution": "cauchy"}),
            ("output 'speed'", {"output": "speed"}),
            ("sobol: 285 parameters, at most 32", {"sobol": True}),
            ("spread = 0", {"spread": 0.0}),
            ("observe: 'elbow' is nothing that can be measured", {"observe": ["elbow"]}),
            ("observe: 'elbow_flexion' is given twice", {"observe": ["elbow_flexion", "elbow_flexion"]}),
            ("prior: ulna.mass is not one of the parameters", {"parameters": ["hand.mass"], "prior": {"ulna.mass": (1, 1)}}),
            ("standard deviation = 0 must be > 0", {"parameters": ["hand.mass"], "prior": {"hand.mass": (0.5, 0)}}),
        ):
            with self.assertRaisesRegex(ValueError, words):
                fh.ensemble(self.model, self.trial, **more)

    def test_control_c_ends_it(self):
        threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            fh.ensemble(self.model, self.trial, draws=100000)


class Compare(AgainstProgram):
    def test_integrators_are_compared_as_by_the_program(self):
        out = program(self.scratch, "compare", ELBOW, SLOW, "--integrators", "vi,vi-left,cvode", "--steps", "0.005,0.01,0.3")
        found = fh.compare(self.model, self.trial, integrators=["vi", "vi-left", "cvode"], steps=[0.005, 0.01, 0.3], timings=1)
        stub.check(found, "CompareResult")
        rows = table(out, "compare.csv")
        self.assertEqual(len(rows), 9)
        for run, row in zip(found.runs, rows, strict=True):
            self.assertEqual([run.integrator, run.outcome], [row["integrator"], row["status"]])
            for value, key in ((run.step, "step_s"), (run.rms_error / DEGREE, "rms_deg"), (run.max_error / DEGREE, "max_deg"),
                               (run.newton_per_step, "newton_per_step"), (run.energy_error, "energy_error_J"),
                               (run.failed_at, "failed_at_s")):
                np.testing.assert_allclose(value, number(row[key]), rtol=1e-7, atol=1e-12, err_msg=key)
        self.assertGreater(found.runs[0].wall, 0)
        self.assertEqual(found.runs[0].q.shape, (len(found.runs[0].time), 1))
        told = summary(out)
        self.assertEqual(found.reference.status, told["reference_status"])
        self.assertAlmostEqual(found.reference.second_rms / DEGREE, told["reference_second_rms_deg"], places=9)
        self.assertEqual(set(found.observed_order), {"vi", "vi-left"})
        for integrator in ("vi", "vi-left"):
            self.assertAlmostEqual(found.largest_stable_step[integrator].stable, told["largest_stable_step_s"][integrator])
            self.assertAlmostEqual(found.observed_order[integrator].order, told["observed_order"][integrator])
        self.assertAlmostEqual(found.observed_order["vi"].order, 2, delta=0.3)

    def test_muscle_classes_are_compared_as_by_the_program(self):
        out = program(self.scratch, "compare", ELBOW, SLOW, "--muscles", "Thelen2003,RigidTendon", "--noise", "0.5")
        found = fh.compare_muscles(self.model, self.trial, classes=["Thelen2003", "RigidTendon"], noise=0.5 * DEGREE)
        told = summary(out)["muscle_classes"]
        bounds = table(out, "muscle_bounds.csv")
        for one, wanted in zip(found, told, strict=True):
            stub.check(one, "MuscleClassMotion")
            self.assertEqual([one.name, one.outcome, one.lost], [wanted["class"], wanted["status"], wanted["lost"]])
            self.assertEqual(one.determined_combinations, wanted["determined_combinations"])
            for value, key in ((one.rms, "rms_deg"), (one.max, "max_deg"), (one.measured_rms, "measured_rms_deg"),
                               (one.unexplained_rms, "unexplained_rms_deg")):
                self.assertAlmostEqual(value / DEGREE, wanted[key], places=9, msg=key)
            for row in bounds:
                bound = one.bounds[row["parameter"]]
                self.assertAlmostEqual(bound.sd / abs(bound.value) / float(row[one.name]), 1, places=4)
        self.assertGreater(found[1].measured_rms, found[1].unexplained_rms)

    def test_rules(self):
        for words, more in (("integrators: 'euler'", {"integrators": ["euler"]}), ("rise", {"steps": [0.01, 0.005]}),
                            ("list is empty", {"integrators": []})):
            with self.assertRaisesRegex(ValueError, words):
                fh.compare(self.model, self.trial, **more)
        with self.assertRaisesRegex(ValueError, "Hill"):
            fh.compare_muscles(self.model, self.trial, classes=["Hill"])
        with self.assertRaisesRegex(ValueError, "must be vi-adaptive, vi or vi-left"):
            fh.compare_muscles(self.model, self.trial, integrator="rk4")
        with self.assertRaises(ValueError):
            fh.compare_muscles(self.model, self.trial, classes=["Thelen2003"], noise=0.0)

    def test_control_c_ends_it(self):
        threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            fh.compare(self.model, self.trial)


class Study(AgainstProgram):
    def is_that_of(self, rows, out):
        for row, wanted in zip(rows, table(out, "study.csv"), strict=True):
            stub.check(row, "StudyRow")
            for name in ("subject", "status", "verdict"):
                self.assertEqual(getattr(row, name), wanted[name])
            self.assertEqual("+".join(row.effects), wanted["effects"])
            for value, key in ((row.rmse_before, "rmse_train_before_deg"), (row.rmse_after, "rmse_train_deg"),
                               (row.rmse_held_out_before, "rmse_held_out_before_deg"),
                               (row.rmse_held_out, "rmse_held_out_deg"), (row.noise, "noise_deg")):
                np.testing.assert_allclose(value / DEGREE, number(wanted[key]), rtol=5e-6, err_msg=f"{row.subject}: {key}")
                if row.calibration:  # with all digits
                    told = summary(os.path.join(out, "subjects", row.subject, "calibrate"))
                    self.assertAlmostEqual(value / DEGREE, told[key], places=12, msg=f"{row.subject}: {key}")
            np.testing.assert_allclose(row.probability, number(wanted["probability"]), rtol=5e-6)
            if row.parameters:
                self.assertEqual(f"{row.identifiable} of {row.parameters}", wanted["identifiable"])
            self.assertEqual(row.sentence.replace(",", ";"), wanted["sentence"])
            self.assertEqual(row.message.replace(",", ";").replace('"', "'"), wanted["message"])

    def test_the_shipped_study_is_that_of_the_program(self):
        file = "emg_data/study.toml"
        asked = fh.read_study(file)
        stub.check(asked, "StudyFile")
        self.assertEqual([one.name for one in asked.subjects], ["curls", "curls_raw", "hidden_b"])
        self.assertTrue(asked.subjects[1].recordings[1].held_out)
        rows = fh.study(file, threads=2)
        out = program(self.scratch, "study", "run", file)
        self.is_that_of(rows, out)
        estimates = table(out, "estimates.csv")
        self.assertEqual(len(estimates), 6)
        for wanted in estimates:
            row = next(one for one in rows if one.subject == wanted["subject"])
            estimate = row.calibration.estimates[wanted["parameter"]]
            np.testing.assert_allclose([estimate.value, estimate.sd], [float(wanted["estimate"]), float(wanted["sd"])], rtol=1e-8)

    def test_effects_and_subjects_that_fail_are_those_of_the_program(self):
        file = os.path.join(self.scratch, "study.toml")
        times, angle = self.trial.measured["elbow_flexion"]
        columns = {"time": times, "BRA": np.full(len(times), 0.1), "elbow_flexion": angle / DEGREE}
        with open(os.path.join(self.scratch, "degrees.csv"), "w", encoding="utf-8") as out:
            csv.writer(out).writerows([list(columns), *np.transpose(list(columns.values()))])
        model, trials = os.path.abspath(ELBOW), os.path.abspath("emg_data")
        with open(file, "w", encoding="utf-8") as out:
            out.write(f"""discover = true
max_effects = 1
noise_deg = 0.5
step_s = 0.02
lock = ["shoulder_elv=10deg"]
[[subject]]
name = "hidden_a"
model = "{model}"
train = "{trials}/hidden_a/train_1.sto"
[[subject]]
name = "broken"
model = "{model}"
train = "study.toml"
[[subject]]
name = "degrees"
model = "{model}"
train = "degrees.csv"
""")
        rows = fh.study(file)
        self.assertEqual([row.status for row in rows], ["ok", "failed", "failed"])
        self.assertRegex(rows[2].message, "discover: .*degrees.csv: measured 'elbow_flexion': .* rad, must be within")
        self.assertTrue(rows[0].effects)
        self.assertIsNone(rows[0].calibration)
        self.is_that_of(rows, program(self.scratch, "study", "run", file))

    def test_a_moment_at_a_locked_coordinate_is_fitted_and_no_trial_is_used_twice(self):
        columns = dict(zip(self.trial.muscles, self.trial.excitations.T))
        columns = {"time": self.trial.times, **columns, "elbow_flexion.moment": np.full(len(self.trial.times), -3.0)}
        with open(os.path.join(self.scratch, "held.csv"), "w", encoding="utf-8") as out:
            csv.writer(out).writerows([list(columns), *np.transpose(list(columns.values()))])
        file = os.path.join(self.scratch, "study.toml")
        with open(file, "w", encoding="utf-8") as out:
            out.write('parameters = ["BRA.max_isometric_force"]\nlock = ["elbow_flexion=90deg"]\n')
            for name, more in (("once", ""), ("twice", 'hold_out = "held.csv"')):
                out.write(f'[[subject]]\nname = "{name}"\nmodel = "{os.path.abspath(ELBOW)}"\ntrain = "held.csv"\n{more}\n')
        rows = fh.study(file)
        out = program(self.scratch, "study", "run", file)
        for row, wanted in zip(rows, table(out, "study.csv"), strict=True):
            self.assertEqual([row.status, row.message.replace(",", ";")], [wanted["status"], wanted["message"]])
        self.assertRegex(rows[1].message, "is held out and also used for estimation")
        self.assertTrue(math.isnan(rows[0].noise))
        told = summary(os.path.join(out, "subjects/once/calibrate"))["estimates"]["BRA.max_isometric_force"]
        self.assertEqual(rows[0].calibration.estimates["BRA.max_isometric_force"].value, told["value"])

    def test_rules(self):
        file = os.path.join(self.scratch, "study.toml")
        with open(file, "w", encoding="utf-8") as out:
            out.write("parametres = []\n")
        for function in (fh.read_study, fh.study):
            with self.assertRaisesRegex(ValueError, "study.toml:1: "):
                function(file)


if __name__ == "__main__":
    unittest.main()
