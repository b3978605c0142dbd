"""list_effects, also of compare, predictions of calibrate, strict, tables of lengths and recordings against the program."""

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
from beside_program.as_the_program import DEGREE, ELBOW, FAST, PROGRAM, SLOW, AsTheProgram


class Further(AsTheProgram):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def file(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as out:
            out.write(text)
        return path

    def test_effects_are_those_of_the_program(self):
        said = subprocess.run([PROGRAM, "discover", "--list-effects", ELBOW, "--json"], capture_output=True, text=True)
        its = json.loads(said.stdout)
        found = fh.list_effects(self.model)
        stub.check(found, "EffectList")
        self.assertGreater(len(its), 40)
        mine = [vars(one) | {"parameters": [{"name": name, "unit": unit} for name, unit in one.parameters.items()]}
                for one in found.effects]
        self.assertEqual(mine, its)
        said = subprocess.run([PROGRAM, "discover", "--list-effects", ELBOW], capture_output=True, text=True)
        present = [line for line in said.stdout.splitlines() if "the model has it already" in line]
        self.assertEqual([f"{name:<22} the model has it already: {what}" for name, what in found.present.items()], present)
        known = [one.id for one in found.effects]
        self.assertIn(fh.list_effects(self.model, coordinate="pro_sup").effects[0].id, known)
        two = [one.id for one in fh.list_effects(self.model, coordinate=["elbow_flexion", "pro_sup"]).effects]
        self.assertIn("elbow_flexion.coulomb", two)
        self.assertIn("pro_sup.coulomb", two)
        self.assertIn("payload", two)
        with self.assertRaises(ValueError):
            fh.list_effects(self.model, coordinate="knee")

    def test_effects_of_ones_own_stand_beside_the_catalogue(self):
        example = pathlib.Path("emg_data/effects.toml")
        plain = [one.id for one in fh.list_effects(self.model).effects]
        listed = fh.list_effects(self.model, effects=[example]).effects
        self.assertEqual([one.id for one in listed], [*plain, "thinning"])
        self.assertEqual(listed[-1].parameters, {"thinning.c": "N m s/rad", "thinning.v": "rad/s"})
        for call in (lambda: fh.list_effects(self.model, effects=[example, example]),
                     lambda: fh.discover(self.model, [self.slow], effects=[example, str(example)])):
            with self.assertRaisesRegex(ValueError, "there is another effect of this name"):
                call()

    def test_motions_of_others_differ_from_the_reference_as_in_the_program(self):
        times, angle = self.slow.measured["elbow_flexion"]
        file = self.file("other.csv", "time,elbow_flexion_deg\n" + "".join(
            f"{t:.17g},{q / DEGREE:.17g}\n" for t, q in zip(times, angle)))
        summary, _ = self.run_program("compare", ELBOW, SLOW, "--integrators", "vi", "--steps", "0.01", "--also", f"other={file}")
        asked = dict(integrators=["vi"], steps=[0.01], timings=1)
        found = fh.compare(self.model, self.slow, also={"other": file, "arrays": (times, angle)}, **asked)
        stub.check(found, "CompareResult")
        self.assertAlmostEqual(found.also["other"] / DEGREE, summary["also_other_rms_deg"], 12)
        self.assertAlmostEqual(found.also["arrays"], found.also["other"], 12)
        for also, words in (({"x": "nobody.sto"}, "nobody.sto"), ({"x": ([0.0, 1.0], [0.5])}, "'x' has 2 times and 1 values"),
                            ({"x": ([90.0], [0.5])}, "no value between")):
            with self.assertRaisesRegex(ValueError, words):
                fh.compare(self.model, self.slow, also=also, **asked)

    def test_external_loads_are_simulated_by_compare(self):
        loads = self.file("loads.xml", """<?xml version="1.0"?>
<OpenSimDocument Version="40000">
<ExternalLoads name="loads"><objects>
<ExternalForce name="cuff"><applied_to_body>ulna</applied_to_body><force_expressed_in_body>humerus</force_expressed_in_body>
<torque_identifier>m_</torque_identifier></ExternalForce>
</objects><datafile>cuff.sto</datafile></ExternalLoads></OpenSimDocument>
""")
        self.file("cuff.sto", "cuff\nversion=1\nnRows=2\nnColumns=4\ninDegrees=no\nendheader\ntime\tm_x\tm_y\tm_z\n"
                  "0\t0\t0\t0.4\n60\t0\t0\t0.4\n")
        summary, out = self.run_program("compare", ELBOW, SLOW, "--integrators", "vi", "--steps", "0.01", "--external-loads", loads)
        found = fh.compare(self.model.with_external_loads(loads), self.slow, integrators=["vi"], steps=[0.01], timings=1)
        np.testing.assert_allclose(found.reference.disagreement_rms / DEGREE, summary["reference_disagreement_rms_deg"], rtol=1e-14)
        self.assertAlmostEqual(found.runs[0].rms_error / DEGREE, self.column(self.rows(out / "compare.csv"), "rms_deg")[0], 9)
        free = fh.compare(self.model, self.slow, integrators=["vi"], steps=[0.01], timings=1)
        self.assertNotEqual(found.runs[0].rms_error, free.runs[0].rms_error)

    def test_predictions_of_held_out_peaks_are_those_of_the_program(self):
        names = ["TRI.radius", "hand.mass"]
        summary, _ = self.run_program("calibrate", ELBOW, SLOW, "--hold-out", FAST, "--parameters", ",".join(names),
                                      "--step", "0.01")
        found = fh.calibrate(self.model, [self.slow], names, hold_out=[self.fast], step=0.01)
        stub.check(found, "CalibrationResult")
        self.assertEqual(len(found.held_out_predictions), 1)
        for mine, its in zip(found.held_out_predictions, summary["held_out_predictions"], strict=True):
            self.assertEqual([mine.trial, mine.channel, mine.unit], [its["file"], its["channel"], "rad"])
            self.assertEqual([mine.holds_peak, mine.share_of_samples_held],
                             [its["holds_peak"], its["share_of_samples_held"]])
            np.testing.assert_allclose(
                np.array([mine.peak_measured, mine.peak_predicted, mine.sd_of_estimates, mine.noise, *mine.interval]) / DEGREE,
                [its[name] for name in ("peak_measured", "peak_predicted", "sd_of_estimates", "noise")] + its["interval"],
                rtol=1e-14)
        self.assertEqual(fh.calibrate(self.model, [self.slow], names, step=0.01).held_out_predictions, [])

    def test_portions_of_an_ensemble_are_rows_of_the_whole_and_of_the_program(self):
        _, out = self.run_program("ensemble", ELBOW, SLOW, "--parameters", "TRI.radius,hand.mass", "--draws", "7", "--step", "0.02")
        rows = self.rows(out / "draws.csv")
        asked = dict(parameters=["TRI.radius", "hand.mass"], seed=3, step=0.02)
        portions = [fh.ensemble(self.model, self.slow, draws=n, first=first, **asked) for first, n in ((0, 3), (3, 4))]
        for k, name in enumerate(("TRI.radius [m]", "hand.mass [kg]")):
            np.testing.assert_array_equal(np.concatenate([one.parameters[:, k] for one in portions]), self.column(rows, name))
        whole = fh.ensemble(self.model, self.slow, draws=7, **asked)
        np.testing.assert_allclose(np.concatenate([one.course for one in portions]), whole.course, rtol=0, atol=1e-12)
        for wrong in (dict(first=-1), dict(first=1, sobol=True, draws=2)):
            with self.assertRaisesRegex(ValueError, "first = "):
                fh.ensemble(self.model, self.slow, **asked, **wrong)

    def test_no_trial_is_used_twice(self):
        again = fh.load_trial(SLOW, self.model)
        for call, words in (
            (lambda: fh.calibrate(self.model, [self.slow], ["hand.mass"], hold_out=[again]), "is held out and also used"),
            (lambda: fh.calibrate(self.model, [self.slow, again], ["hand.mass"]), "is the same trial as"),
            (lambda: fh.discover(self.model, [self.slow], hold_out=[self.fast, again]), "is held out and also used"),
            (lambda: fh.discover(self.model, [self.slow], hold_out=[self.fast, self.fast]), "is the same trial as"),
            (lambda: fh.sensitivity(self.model, [self.slow, again], ["hand.mass"]), "is the same trial as"),
        ):
            with self.subTest(words), self.assertRaisesRegex(ValueError, words):
                call()

    def test_a_motion_that_leaves_the_range_is_refused_where_that_is_asked_for(self):
        words = ["replay", ELBOW, SLOW, "--initial", "elbow_flexion=-60deg"]
        summary, _ = self.run_program(*words)
        self.run_program(*words, "--strict", status=1)
        start = {"elbow_flexion": -math.pi / 3}
        found = fh.replay(self.model, self.slow, initial=start)
        stub.check(found, "ReplayResult")
        self.assertIn(found.left_range, summary["warnings"])
        with self.assertRaises(RuntimeError) as raised:
            fh.replay(self.model, self.slow, initial=start, strict=True)
        self.assertEqual(str(raised.exception), found.left_range)
        self.assertEqual(fh.replay(self.model, self.slow, strict=True).left_range, "")

    def test_polynomials_of_a_table_are_those_of_the_program(self):
        angles = np.linspace(0.1, 2.2, 60)
        lengths = fh.moment_arms(self.model, {"elbow_flexion": angles})
        k, m = lengths.muscles.index("BRA"), lengths.muscles.index("BIClong")
        table = self.file("lengths.csv", "elbow_flexion,BRA.length_m,BIClong.length_m\n" + "".join(
            f"{q:.17g},{row[k]:.17g},{row[m]:.17g}\n" for q, row in zip(angles, lengths.length)))
        summary, out = self.run_program("moment-arms", ELBOW, "--fit", table, "--fit-tolerance", "0.05")
        found = fh.fit_paths(self.model, table=table, tolerance=0.05e-3)
        stub.check(found, "PathFitResult")
        self.assertEqual(list(found.fits), summary["muscles"])
        for name, its in summary["fits"].items():
            mine = found.fits[name]
            self.assertEqual([mine.written, mine.coordinates, mine.order, mine.length_error],
                             [its["written"], its["coordinates"], its["order"], its["length_error_m"]["largest"]])
        written = fh.load_model(str(out / "fitted_paths.osim"))
        postures = {"elbow_flexion": angles}
        np.testing.assert_array_equal(fh.moment_arms(written, postures).length, fh.moment_arms(found.model, postures).length)
        with self.assertRaisesRegex(ValueError, "its coordinates are free"):
            fh.fit_paths(self.model, table=table, coordinate="elbow_flexion")
        with self.assertRaisesRegex(ValueError, "nobody.csv"):
            fh.fit_paths(self.model, table="nobody.csv")

    def test_a_recording_is_read_as_check_shows_it(self):
        head = ("PathFileType\t4\t(X/Y/Z)\twalk.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n"
                "100\t100\t3\t2\tmm\nFrame#\tTime\tELB\t\t\tWRI\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n")
        file = self.file("walk.trc", head + "".join(f"{k + 1}\t{k / 100}\t{k}\t20\t30\t\t\t\n" for k in range(3)))
        summary, _ = self.run_program("check", file)
        found = fh.read_recording(file)
        stub.check(found, "RecordedFile")
        its = summary["recordings"][0]
        self.assertEqual([list(found.markers), len(found.times), found.frame_rate],
                         [its["markers"], its["frames"], its["frame_rate_Hz"]])
        np.testing.assert_allclose(found.markers["ELB"], [[k / 1000, 0.02, 0.03] for k in range(3)], rtol=1e-15)
        self.assertTrue(np.isnan(found.markers["WRI"]).all())
        for remark in found.remarks:
            self.assertTrue(any(remark in one["message"] for one in summary["findings"]), remark)
        self.assertIn("1 of 2 markers are never seen: WRI", found.remarks)
        for name in ("models/elbow8.osim", "nobody.c3d"):
            with self.assertRaisesRegex(ValueError, name):
                fh.read_recording(name)

    def test_a_trial_from_arrays_declares_latent_excitations_as_a_file_does(self):
        with open(SLOW, encoding="utf-8") as file:
            text = file.read()
        line = "TRIlong 0.5 0.4; BRA 0.3 0.5"
        file = self.file("latent.sto", text.replace("endheader", f"latent_excitation={line}\nendheader", 1))
        read = fh.load_trial(file, self.model)
        columns = {"time": read.times, **dict(zip(read.muscles, read.excitations.T))}
        times, angle = read.measured["elbow_flexion"]  # in every second row
        columns["elbow_flexion"] = np.full(len(read.times), np.nan)
        columns["elbow_flexion"][np.searchsorted(read.times, times)] = angle
        made = fh.make_trial(self.model, columns, latent_excitation=line)
        asked = dict(noise=0.02, step=0.02)
        mine, its = (fh.calibrate(self.model, [one], ["hand.mass"], **asked) for one in (made, read))
        self.assertGreater(len(its.estimates), 5)
        self.assertEqual({name: one.value for name, one in mine.estimates.items()},
                         {name: one.value for name, one in its.estimates.items()})
        for wrong in ("TRIlong", "GLUT 0.5 0.4", "BRA 0.5 0.4; BRA 0.5 0.4"):
            with self.assertRaisesRegex(ValueError, "latent_excitation"):
                fh.make_trial(self.model, columns, latent_excitation=wrong)


del AsTheProgram  # has no tests of its own

if __name__ == "__main__":
    unittest.main()
