"""Options that the program has as well; test_fisherhill.py runs these, too."""

import os
import tempfile
import unittest

import numpy as np

import fisherhill as fh

import stub

ELBOW = "models/elbow8.osim"
SLOW = "emg_data/curl_slow.sto"

LOADS = """<?xml version="1.0"?>
<OpenSimDocument Version="40000">
<ExternalLoads name="loads"><objects>
<ExternalForce name="cuff"><applied_to_body>ulna</applied_to_body><force_expressed_in_body>humerus</force_expressed_in_body>
<torque_identifier>m_</torque_identifier></ExternalForce>
</objects><datafile>cuff.sto</datafile></ExternalLoads></OpenSimDocument>
"""
AXIS = np.array([0.04940001, 0.03660001, 0.99810825])  # of the elbow, which the humerus holds


class Options(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = fh.load_model(ELBOW)
        cls.trial = fh.load_trial(SLOW, cls.model)

    def test_moment_arms_are_the_slopes_of_lengths(self):
        angles = np.linspace(0.3, 2.0, 12)
        h = 1e-4
        at, below, above = (fh.moment_arms(self.model, {"elbow_flexion": angles + d}) for d in (0, -h, h))
        stub.check(at, "MomentArmsResult")
        self.assertEqual(at.muscles, self.model.muscles)
        slope = (above.length - below.length) / (2 * h)
        np.testing.assert_allclose(at.moment_arm["elbow_flexion"], -slope, atol=2e-6)
        # at a node of replay's motion
        motion = fh.replay(self.model, self.trial)
        one = fh.moment_arms(self.model, {"elbow_flexion": motion.q[:1, 0]})
        np.testing.assert_allclose(one.moment_arm["elbow_flexion"][0], motion.moment_arm[0], atol=1e-9)
        touching = [len(names) > 0 for names in at.touched["TRIlong"]]
        self.assertIn(True, touching)
        turned = fh.moment_arms(self.model, {"elbow_flexion": angles}, lock={"pro_sup": 0.5})
        self.assertGreater(np.abs(turned.length - at.length).max(), 1e-4)
        for postures in ({}, {"knee": [0.0]}, {"elbow_flexion": [np.nan]}, {"elbow_flexion": [0.0, 1], "pro_sup": [0.0]}):
            with self.assertRaises(ValueError):
                fh.moment_arms(self.model, postures)

    def test_fitted_paths_have_the_lengths_of_the_paths(self):
        found = fh.fit_paths(self.model, muscles=["BRA", "BIClong"], tolerance=2e-4)
        stub.check(found, "PathFitResult")
        angles = {"elbow_flexion": np.linspace(0.1, 2.2, 30)}
        before, after = fh.moment_arms(self.model, angles), fh.moment_arms(found.model, angles)
        for muscle in ("BRA", "BIClong"):
            self.assertTrue(found.fits[muscle].written)
            self.assertLess(found.fits[muscle].length_error, 2e-4)
            column = before.muscles.index(muscle)
            error = np.abs(after.length[:, after.muscles.index(muscle)] - before.length[:, column])
            self.assertGreater(error.max(), 0)
            self.assertLess(error.max(), 2e-4)
        kept = fh.fit_paths(self.model, muscles=["TRIlong"], tolerance=1e-9, order=2)
        self.assertFalse(kept.fits["TRIlong"].written)
        self.assertNotEqual(kept.fits["TRIlong"].why_not, "")
        with self.assertRaises(ValueError):
            fh.fit_paths(self.model, muscles=["GLUTmax"])

    def test_muscles_of_another_class_move_the_arm_otherwise_and_what_is_lost_is_said(self):
        other = self.model.with_muscles("Thelen2003")
        self.assertGreater(len(other.warnings), len(self.model.warnings))
        change = fh.replay(other, self.trial).q - fh.replay(self.model, self.trial).q
        self.assertGreater(np.abs(change).max(), 1e-3)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "thelen.osim")
            other.write(file)
            np.testing.assert_array_equal(fh.replay(fh.load_model(file), self.trial).q, fh.replay(other, self.trial).q)
        with self.assertRaisesRegex(ValueError, "Zajac"):
            self.model.with_muscles("Zajac")

    def test_an_external_torque_about_the_elbow_is_that_of_its_column(self):
        def columns(**more):
            t = np.linspace(0, 0.4, 41)
            return {"time": t, "BIClong": np.full(41, 0.06), "BRA": np.full(41, 0.05), **more}

        with tempfile.TemporaryDirectory() as folder:
            loads = os.path.join(folder, "loads.xml")
            with open(loads, "w", encoding="utf-8") as file:
                file.write(LOADS)
            with open(os.path.join(folder, "cuff.sto"), "w", encoding="utf-8") as file:
                file.write("cuff\nversion=1\nnRows=2\nnColumns=7\ninDegrees=no\nendheader\ntime\tf_x\tf_y\tf_z\tm_x\tm_y\tm_z\n")
                for t in (0.0, 0.4):
                    file.write("\t".join(f"{x:.17g}" for x in (t, 0, 0, 0, *(0.4 * AXIS))) + "\n")
            loaded = self.model.with_external_loads(loads)
        pushed = fh.replay(loaded, fh.make_trial(self.model, columns())).q
        torque = fh.replay(self.model, fh.make_trial(self.model, columns(**{"elbow_flexion.torque": np.full(41, 0.4)}))).q
        free = fh.replay(self.model, fh.make_trial(self.model, columns())).q
        np.testing.assert_allclose(pushed, torque, atol=1e-6)
        self.assertGreater(np.abs(pushed - free).max(), 0.01)
        with self.assertRaises(ValueError):  # the loads end at 0.4 s
            fh.replay(loaded, self.trial)

    def test_a_prescribed_motion_may_be_smoothed(self):
        given, smooth = (fh.load_trial(SLOW, self.model, prescribe=["elbow_flexion"], prescribe_cutoff=cutoff)
                         for cutoff in (None, 3))
        (_, rough), (_, even) = given.prescribed["elbow_flexion"], smooth.prescribed["elbow_flexion"]
        self.assertLess(np.abs(np.diff(even, 2)).mean(), 0.5 * np.abs(np.diff(rough, 2)).mean())
        with self.assertRaises(ValueError):
            fh.load_trial(SLOW, self.model, prescribe=["elbow_flexion"], prescribe_cutoff=-1)

    def test_calibration_has_profiles_and_replicates_where_they_are_asked_for(self):
        asked = dict(noise=0.03, step=0.01)
        plain = fh.calibrate(self.model, [self.trial], ["hand.mass"], **asked)
        self.assertIsNone(plain.estimates["hand.mass"].profile)
        self.assertIsNone(plain.estimates["hand.mass"].bootstrap)
        found = fh.calibrate(self.model, [self.trial], ["hand.mass"], profile=["hand.mass"], bootstrap=20, **asked)
        stub.check(found, "CalibrationResult")
        one = found.estimates["hand.mass"]
        self.assertEqual(one.value, plain.estimates["hand.mass"].value)
        for low, high in (one.profile, one.bootstrap):
            self.assertLess(low, one.value)
            self.assertGreater(high, one.value)
        # a profile of a nearly linear model is the interval of the information
        self.assertAlmostEqual((one.profile[1] - one.profile[0]) / (one.upper - one.lower), 1, delta=0.1)
        for wrong in (dict(bootstrap=3), dict(profile=["TRI.radius"]), dict(channel_noise={"elbow_flexion.moment": 1.0})):
            with self.assertRaises(ValueError):
                fh.calibrate(self.model, [self.trial], ["hand.mass"], **wrong)

    def test_discovery_refuses_a_scatter_that_is_none(self):
        for scatter in (-0.1, float("nan")):
            with self.assertRaisesRegex(ValueError, "input_scatter"):
                fh.discover(self.model, [self.trial], input_scatter=scatter)

    def test_reviews_say_what_is_unusual(self):
        self.assertRegex(self.model.remarks[0], "TRIlong.*twice")
        for one in self.model.review() + self.trial.review(self.model):
            stub.check(one, "Remark")
        # the same excitations with the angle in degrees under the name of the one in radians
        columns = {"time": self.trial.times, "elbow_flexion": np.full(len(self.trial.times), 40.0)}
        columns |= dict(zip(self.trial.muscles, self.trial.excitations.T))
        remarks = fh.make_trial(self.model, columns).review(self.model)
        errors = [one for one in remarks if one.weight == "error"]
        self.assertTrue(any("elbow_flexion" in one.subject + one.message for one in errors), remarks)
        with self.assertRaises(TypeError):
            self.trial.review()

    def test_jumps_are_where_lengths_jump(self):
        jumps = fh.length_jumps(self.model)
        self.assertGreater(len(jumps), 0)
        for one in jumps:
            stub.check(one, "LengthJump")
            at = fh.moment_arms(self.model, {one.coordinate: one.value + np.array([-1e-6, 1e-6])})
            k = at.muscles.index(one.muscle)
            self.assertAlmostEqual(at.length[1, k] - at.length[0, k], one.length, delta=1e-6)
            arms = at.moment_arm[one.coordinate][:, k]
            self.assertAlmostEqual(arms[1] - arms[0], one.moment_arm, delta=1e-4)
        self.assertEqual(fh.opensim_differences(self.model), [])  # it has no ellipsoid

    def test_differences_from_opensim_over_an_ellipsoid(self):
        with open("models/elbow8.osim") as text:
            before, cylinder = text.read().split('<WrapCylinder name="TRI">')
        cylinder, after = cylinder.split("</WrapCylinder>", 1)
        for old, new in (("-0.14015 -0.00628319 0.154985", "0.8 0 0.155"), ("<length>0.1</length>", ""),
                         ("<radius>0.016</radius>", "<dimensions>0.02 0.012 0.012</dimensions>")):
            self.assertIn(old, cylinder)
            cylinder = cylinder.replace(old, new)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "ellipsoid.osim")
            with open(file, "w") as text:
                text.write(f'{before}<WrapEllipsoid name="TRI">{cylinder}</WrapEllipsoid>{after}')
            found = fh.opensim_differences(fh.load_model(file))
        self.assertEqual([one.muscle for one in found], ["TRIlong", "TRIlat", "TRImed"])
        for one in found:
            stub.check(one, "OpenSimDifference")
            self.assertEqual(one.ellipsoids, ["TRI"])
            self.assertGreater(one.length, 1e-3)
            self.assertTrue(one.apart[0][0] <= one.length_at <= one.apart[0][1])
            self.assertIn("over TRI differs from the taut string", one.text)

    def test_muscle_states_have_a_row_for_each_of_the_file(self):
        file = "models/muscle_states.csv"
        found = fh.muscle_states(file)
        stub.check(found, "MuscleStatesResult")
        with open(file) as text:
            lines = text.read()
        rows = [line.split(",") for line in lines.splitlines()[1:]]
        self.assertEqual(found.muscle_class, [row[0] for row in rows])
        for column in (found.fibre_velocity, found.tendon_force, found.static_fibre_length, found.static_tendon_force):
            self.assertEqual(column.shape, (len(rows),))
        self.assertTrue((found.tendon_force >= 0).all())
        with self.assertRaisesRegex(ValueError, "class"):
            with tempfile.NamedTemporaryFile("w", suffix=".csv") as other:
                other.write(lines.replace("Thelen2003Muscle", "Nobody"))
                other.flush()
                fh.muscle_states(other.name)

    def test_raw_emg_becomes_a_trial(self):
        found = fh.emg("emg_data/curl_slow_raw.csv", "emg_data/configs/shipped_raw.toml")
        stub.check(found, "EmgResult")
        trial = fh.make_trial(self.model, found.columns)
        np.testing.assert_array_equal(trial.times, found.columns["time"])
        for k, name in enumerate(trial.muscles):
            if name in found.muscles:
                np.testing.assert_array_equal(trial.excitations[:, k], found.columns[name])
        # the shipped trial is what the recording was made from
        np.testing.assert_allclose(found.columns["elbow_flexion_deg"][0], 30.32, atol=1e-9)
        for name in found.muscles:
            truth = self.trial.excitations[:, self.trial.muscles.index(name)]
            self.assertLess(np.sqrt(np.mean((found.columns[name] - truth) ** 2)), 0.12 * truth.max(), name)
        for electrode in found.electrodes.values():
            self.assertEqual(electrode.envelope.shape, electrode.excitation.shape)
            self.assertGreater(electrode.full, 0)
        self.assertEqual((found.offsets, found.latent_excitation), ({}, ""))
        with self.assertRaisesRegex(ValueError, "recordings"):
            fh.emg([], "emg_data/configs/shipped_raw.toml")


if __name__ == "__main__":
    unittest.main()
