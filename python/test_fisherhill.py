"""The module against closed forms, against itself and against its own rules; run from the top of the source tree."""

import math
import os
import pathlib
import signal
import tempfile
import threading
import time
import unittest

import numpy as np

import fisherhill as fh

import stub
from test_options import Options  # noqa: F401, run with these
from test_systems import Systems  # noqa: F401, run with these

ELBOW = "models/elbow8.osim"
SLOW = "emg_data/curl_slow.sto"
HIDDEN = "emg_data/hidden_a/train_1.sto"
DEGREE = math.pi / 180


class Arms(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = fh.load_model(ELBOW)
        cls.trial = fh.load_trial(SLOW, cls.model)

    def columns(self):
        t, angle = self.trial.measured["elbow_flexion"]
        measured = np.full(len(self.trial.times), np.nan)
        measured[np.searchsorted(self.trial.times, t)] = angle
        columns = dict(zip(self.trial.muscles, self.trial.excitations.T))
        return {"time": self.trial.times, **columns, "elbow_flexion": measured}

    def test_replay_gives_rows_for_times_and_columns_for_muscles(self):
        motion = fh.replay(self.model, self.trial)
        stub.check(motion, "ReplayResult")
        rows = len(motion.time)
        self.assertEqual(motion.outcome, "ok")
        self.assertEqual(motion.q.shape, (rows, 1))
        self.assertEqual(motion.tendon_force.shape, (rows, len(motion.muscles)))
        self.assertEqual(motion.muscles, self.model.muscles)
        t, angle = self.trial.measured["elbow_flexion"]
        error = np.sqrt(np.mean((np.interp(t, motion.time, motion.q[:, 0]) - angle) ** 2))
        # linear here, the cubic of Hermite there
        self.assertAlmostEqual(error, motion.rms_error["elbow_flexion"], places=4)

    def test_a_trial_of_arrays_is_the_trial_of_the_file(self):
        trial = fh.make_trial(self.model, self.columns())
        np.testing.assert_array_equal(fh.replay(self.model, trial).q, fh.replay(self.model, self.trial).q)

    def test_a_prescribed_joint_has_a_reaction_and_a_moment_to_compare_with(self):
        columns = self.columns()
        columns["elbow_flexion"] = np.full(len(self.trial.times), 1.0)
        trial = fh.make_trial(self.model, columns, prescribe=["elbow_flexion"])
        self.assertEqual(list(trial.prescribed), ["elbow_flexion"])
        self.assertEqual(trial.measured, {})
        held = fh.replay(self.model, trial)
        stub.check(held, "ReplayResult")
        np.testing.assert_allclose(held.q, 1.0, atol=1e-12)
        columns["elbow_flexion.moment"] = np.interp(columns["time"], held.time, -held.reaction["elbow_flexion"])
        measured = fh.make_trial(self.model, columns, prescribe=["elbow_flexion"])
        self.assertIn("elbow_flexion.moment", measured.channels)
        again = fh.replay(self.model, measured)
        self.assertLess(again.channel_rms_error["elbow_flexion.moment"], 1e-6)
        del columns["elbow_flexion"]
        locked = fh.replay(self.model, fh.make_trial(self.model, columns, hold={"elbow_flexion": 1.0}))
        np.testing.assert_allclose(locked.reaction["elbow_flexion"], held.reaction["elbow_flexion"], atol=1e-9)

    def test_a_model_is_made_of_a_file(self):
        model = fh.Model(pathlib.Path(ELBOW))
        self.assertEqual((model.name, model.muscles), (self.model.name, self.model.muscles))

    def test_a_motion_that_the_model_prescribes_is_that_of_a_column(self):
        with open(ELBOW, encoding="utf-8") as file:
            text = file.read()
        at = text.index("<default_value>", text.index('<Coordinate name="elbow_flexion">'))
        sine = (
            "<prescribed>true</prescribed><prescribed_function><Sine><amplitude>0.3</amplitude>"
            "<omega>4</omega><phase>0</phase><offset>1</offset></Sine></prescribed_function>"
        )
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "swinging.osim")
            with open(path, "w", encoding="utf-8") as file:
                file.write(text[:at] + sine + text[at:])
            model = fh.load_model(path)
        columns = self.columns()
        del columns["elbow_flexion"]
        own = fh.replay(model, fh.make_trial(model, columns))
        np.testing.assert_allclose(own.q[:, 0], 1 + 0.3 * np.sin(4 * own.time), atol=1e-12)
        columns["elbow_flexion"] = 1 + 0.3 * np.sin(4 * self.trial.times)
        given = fh.replay(self.model, fh.make_trial(self.model, columns, prescribe=["elbow_flexion"]))
        np.testing.assert_allclose(own.reaction["elbow_flexion"], given.reaction["elbow_flexion"], atol=0.02)
        free = fh.replay(model, fh.make_trial(model, columns), coordinate="elbow_flexion")
        self.assertEqual(free.reaction, {})
        with self.assertRaisesRegex(ValueError, "no trial measures the moment"):
            fh.discover(model, [fh.make_trial(model, columns)])

    def test_integrators_agree_on_the_motion(self):
        fine = fh.replay(self.model, self.trial, integrator="cvode").q[-1, 0]
        for integrator, step, bound in (("vi", 0.005, 2e-3), ("rk4", 2e-4, 2e-3)):
            other = fh.replay(self.model, self.trial, integrator=integrator, step=step).q[-1, 0]
            self.assertLess(abs(other - fine), bound)

    def test_a_step_that_is_too_long_is_said(self):
        self.assertIn("too long", fh.replay(self.model, self.trial, step=0.4).step_too_long)
        self.assertEqual(fh.replay(self.model, self.trial).step_too_long, "")

    def test_sensitivity_is_the_difference_of_two_motions(self):
        name, h = "hand.mass", 1e-4
        found = fh.sensitivity(self.model, [self.trial], [name])
        stub.check(found, "SensitivityResult")
        value = found.values[0]
        outputs = []
        for mass in (value - h, value + h):
            moved = fh.calibrate(self.model, [self.trial], [name], prior={name: (mass, 1e-9)},
                                 bounds={name: (0.1, 2)}).model
            outputs.append(fh.sensitivity(moved, [self.trial], [name]).outputs[0])
        difference = (outputs[1] - outputs[0]) / (2 * h)
        scale = np.abs(found.gamma[0]).max()
        np.testing.assert_allclose(found.gamma[0][:, 0], difference, atol=1e-3 * scale)
        self.assertAlmostEqual(found.fisher[0, 0], np.sum(found.gamma[0] ** 2) / DEGREE**2, delta=1e-6 * found.fisher[0, 0])
        self.assertAlmostEqual(found.bound_alone[0] ** -2, found.fisher[0, 0], delta=1e-6 * found.fisher[0, 0])

    def test_cost_gradient_is_that_of_the_sensitivities_and_of_two_costs(self):
        names = ["hand.mass", "TRI.radius", "BRA.max_isometric_force", "emg.delay"]
        found = fh.cost_gradient(self.model, [self.trial], names, noise=2 * DEGREE)
        stub.check(found, "CostGradientResult")
        self.assertEqual(found.names, names)
        forward = fh.sensitivity(self.model, [self.trial], names)
        measured = np.interp(forward.times[0], self.columns()["time"], self.columns()["elbow_flexion"])
        residual = (forward.outputs[0] - measured) / (2 * DEGREE) ** 2
        self.assertAlmostEqual(found.cost, residual @ (forward.outputs[0] - measured) / 2, delta=1e-6 * found.cost)
        np.testing.assert_allclose(found.gradient, forward.gamma[0].T @ residual, rtol=1e-6)

        h = 1e-4 * found.values[0]
        costs = [fh.cost_gradient(self.model, [self.trial], names, found.values + d * np.eye(4)[0],
                                  noise=2 * DEGREE).cost for d in (-h, h)]
        self.assertAlmostEqual(found.gradient[0], (costs[1] - costs[0]) / (2 * h), delta=1e-4 * abs(found.gradient[0]))

        moved = found.values * 1.01
        plain, known = (fh.cost_gradient(self.model, [self.trial], names, moved, priors=p) for p in (False, True))
        sd = np.array([p.deviation for p in fh.list_parameters(self.model) if p.name in names])
        order = [p.name for p in fh.list_parameters(self.model) if p.name in names]
        off = (moved - found.values) / sd[[order.index(n) for n in names]]
        self.assertAlmostEqual(known.cost - plain.cost, off @ off / 2, delta=1e-9 * known.cost)
        with self.assertRaisesRegex(ValueError, "values for 4 parameters"):
            fh.cost_gradient(self.model, [self.trial], names, [1.0])

    def test_calibrate_finds_the_mass_that_made_the_data(self):
        motion = fh.replay(self.model, self.trial)
        heavy = fh.calibrate(self.model, [self.trial], ["hand.mass"], prior={"hand.mass": (0.6, 1e-9)}).model
        truth = fh.replay(heavy, self.trial, step=0.01)
        columns = self.columns()
        columns["elbow_flexion"] = np.interp(columns["time"], truth.time, truth.q[:, 0])
        made = fh.make_trial(self.model, columns)
        found = fh.calibrate(self.model, [made], ["hand.mass"], noise=0.5 * DEGREE, priors=False)
        stub.check(found, "CalibrationResult")
        self.assertTrue(found.converged)
        mass = found.estimates["hand.mass"]
        self.assertTrue(mass.identifiable)
        self.assertAlmostEqual(mass.value, 0.6, places=3)
        self.assertLess(found.rmse_after, found.rmse_before)
        self.assertLess(abs(fh.replay(found.model, made).q[-1, 0] - truth.q[-1, 0]), 1e-3)
        self.assertNotEqual(motion.q[-1, 0], truth.q[-1, 0])

    def test_calibrate_pulls_a_muscle_without_an_electrode(self):
        found = fh.calibrate(self.model, [self.trial], ["hand.mass"], noise=0.5 * DEGREE, latent={"BRD": (0.5, 5)}, step=0.01)
        self.assertIn("emg.BRD.latent2", found.estimates)
        self.assertNotEqual(found.estimates["emg.BRD.latent1"].value, 0)

    def test_discover_names_the_damping_that_is_hidden(self):
        trial = fh.load_trial(HIDDEN, self.model)
        found = fh.discover(self.model, [trial], noise=0.5 * DEGREE, max_effects=1)
        stub.check(found, "DiscoveryResult")
        self.assertEqual(found.verdict, "named")
        self.assertEqual([one.id for one in found.effects], ["visc"])
        force = found.force_without_a_name
        self.assertEqual(force.follows, "speed")  # as viscosity does
        self.assertLess(force.nats_ahead_of_names, 0)
        self.assertEqual(force.at.shape, force.force.shape)
        damped = np.abs(force.force + 0.3 * force.at)  # N m
        self.assertLess((damped - 4 * force.sd).max(), 0.05)
        viscosity = found.effects[0].parameters["visc.viscosity"]
        self.assertLess(abs(viscosity.value - 0.3), 3 * viscosity.sd)  # emg_data/answers/hidden.json
        self.assertGreater(found.gap.closed, 0.9)
        # the model that comes with it is the one that was scored
        self.assertEqual([one.role for one in found.trials], ["train"])
        for one in found.trials:
            replay = fh.replay(found.model, one.trial)
            self.assertEqual(replay.start_from, "model")
            self.assertAlmostEqual(replay.rms_error["elbow_flexion"], one.after, 12)
            self.assertEqual(found.gap.after, one.after)
            self.assertAlmostEqual(fh.replay(self.model, one.trial).rms_error["elbow_flexion"], one.nominal, 12)
        self.assertIn("TRIlong.max_isometric_force", [one.name for one in found.fitted_parameters])
        self.assertGreater(found.effects[0].moment_peak, found.effects[0].moment_rms)
        self.assertGreater(found.effects[0].moment_rms, 0.1)

    def test_discover_takes_several_channels_with_their_noise(self):
        t = np.arange(0, 1.001, 0.01)
        columns = {"time": t, **{name: np.full(len(t), 0.03) for name in self.model.muscles}}
        columns["BRA"] = 0.03 + 0.2 * np.sin(3 * t) ** 2
        trial = fh.make_trial(self.model, columns)
        motion = fh.replay(self.model, trial, coordinate="elbow_flexion", initial={"elbow_flexion": 0.5})
        random = np.random.default_rng(1)
        measured = {"elbow_flexion": motion.q[:, 0] + 0.005 * random.standard_normal(len(t)),
                    "elbow_flexion.speed": motion.q_dot[:, 0] + 0.02 * random.standard_normal(len(t))}
        trial = fh.make_trial(self.model, {**columns, **measured})
        noise = {"elbow_flexion": 0.005, "elbow_flexion.speed": 0.02}
        found = fh.discover(self.model, [trial], noise=noise, max_effects=1, coordinate=["elbow_flexion"])
        stub.check(found, "DiscoveryResult")
        self.assertEqual(found.verdict, "none")
        self.assertEqual({one.name: one.noise for one in found.outputs}, noise)
        self.assertEqual([one.unit for one in found.outputs], ["rad", "rad/s"])
        self.assertEqual([one.coordinate for one in found.trials[0].starts], ["elbow_flexion"])
        self.assertEqual(found.trials[0].starts[0].value, found.trials[0].start)
        for wrong, why in ((0.005, "that of 'elbow_flexion.speed' is not given"),
                           ({**noise, "elbow_flexion": 0}, "must be > 0"), ({**noise, "ghost": 1}, "'ghost'")):
            with self.assertRaisesRegex(ValueError, why):
                fh.discover(self.model, [trial], noise=wrong, max_effects=1)

    def test_discover_tells_what_could_be_expected_of_held_out_trials(self):
        trials = [fh.load_trial(HIDDEN.replace("train_1", one), self.model) for one in ("train_1", "train_2")]
        found = fh.discover(self.model, trials[:1], hold_out=trials[1:], noise=0.5 * DEGREE, max_effects=1)
        self.assertEqual([one.id for one in found.effects], ["visc"])
        stub.check(found, "DiscoveryResult")
        held = found.gap_held_out
        self.assertGreater(held.expected, held.noise_floor)  # what is left unknown comes on top
        self.assertGreater(held.probability, 0.05)  # else it would be fitted, too
        self.assertLessEqual(held.probability, 1)
        self.assertIs(found.held_out_fitted, False)
        self.assertIsNone(found.gap.expected)  # fitted trials are as near as the fit brought them
        self.assertIsNone(found.gap.probability)

    def test_discover_plans_what_would_tell_names_apart(self):
        trial = fh.load_trial("emg_data/hidden_c/train_1.sto", self.model)  # a mass in the hand, or of it
        found = fh.discover(self.model, [trial], noise=0.5 * DEGREE, max_effects=1)
        stub.check(found, "DiscoveryResult")
        self.assertEqual(found.verdict, "ambiguous")
        self.assertIsNone(found.unknown)
        self.assertGreater(len(found.planned_experiments), 1)
        least = []
        for one in found.planned_experiments:
            self.assertEqual(one.of, found.effects[0].id)
            self.assertLessEqual(set(one.expected_nats), set(found.effects[0].cannot_be_told_from) - {one.of})
            least.append(min(one.expected_nats.values()))
        self.assertEqual(least, sorted(least, reverse=True))
        self.assertGreater(least[0], 0)

    def test_discover_gives_a_formula_of_what_has_no_name(self):
        trials = [fh.load_trial(HIDDEN.replace("train_1", one), self.model) for one in ("train_1", "train_2")]
        found = fh.discover(self.model, trials, noise=0.5 * DEGREE, max_effects=0)
        stub.check(found, "DiscoveryResult")
        self.assertEqual(found.verdict, "unknown")
        self.assertEqual((found.effects, found.planned_experiments), ([], []))
        self.assertGreater(found.unknown.evidence, 5)
        self.assertIsNone(found.unknown.raced)  # one effect at least is needed for that
        others = [one for one in found.undetectable_below if one != "const"]
        raced = fh.discover(self.model, trials, noise=0.5 * DEGREE, max_effects=1, without=others).unknown.raced
        stub.check(raced, "RacedFormula")
        self.assertTrue(raced.wins)
        self.assertEqual([one.expression for one in raced.terms], ["qdot"])  # viscous damping of 0.3 N m s
        self.assertLess(abs(raced.terms[0].value + 0.3), 3 * raced.terms[0].sd)
        self.assertGreater(raced.gap.closed, 0.9)

    def test_only_discover_and_replay_take_a_known_mass_in_the_hand(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "loaded.sto")
            with open(SLOW, encoding="utf-8") as whole, open(file, "w", encoding="utf-8") as to:
                to.write(whole.read().replace("endheader", "known_mass_in_hand_kg=0.8\nendheader", 1))
            loaded = fh.load_trial(file, self.model)
            heavy = os.path.join(folder, "heavy.osim")
            with open(ELBOW, encoding="utf-8") as whole, open(heavy, "w", encoding="utf-8") as to:
                to.write(whole.read().replace("<mass>0.5819</mass>", "<mass>1.3819</mass>", 1))
            truth = fh.replay(fh.load_model(heavy), self.trial)
        self.assertEqual(loaded.known_mass_in_hand, 0.8)
        self.assertEqual(self.trial.known_mass_in_hand, 0)
        np.testing.assert_allclose(fh.replay(self.model, loaded).q, truth.q, rtol=0, atol=1e-12)
        for one in (lambda: fh.sensitivity(self.model, [loaded], ["hand.mass"]),
                    lambda: fh.calibrate(self.model, [loaded], ["hand.mass"]),
                    lambda: fh.calibrate(self.model, [self.trial], ["hand.mass"], hold_out=[loaded]),
                    lambda: fh.make_trial(self.model, self.columns(), known_mass_in_hand=-1)):
            with self.assertRaisesRegex(ValueError, "known.mass"):
                one()
        turned = fh.make_trial(self.model, self.columns(), known_arm_turn=-45 * DEGREE)
        self.assertAlmostEqual(turned.known_arm_turn, -45 * DEGREE)
        with self.assertRaisesRegex(ValueError, "the limb turned by -45 deg, which only discover"):
            fh.sensitivity(self.model, [turned], ["hand.mass"])
        noise = 0.5 * DEGREE
        columns = {name: values[self.trial.times <= 2.5] for name, values in self.columns().items()}
        angle = np.interp(columns["time"], truth.time, truth.q[:, 0])
        columns["elbow_flexion"] = angle + noise * np.random.default_rng(3).standard_normal(len(angle))
        for mass, verdict in ((0.8, "none"), (0.0, "ambiguous")):  # a payload, or the forearm's mass
            trial = fh.make_trial(self.model, columns, known_mass_in_hand=mass)
            self.assertEqual(fh.discover(self.model, [trial], noise=noise, max_effects=1).verdict, verdict)

    def test_a_broken_rule_is_a_value_error_of_one_line(self):
        broken = (
            lambda: fh.load_model("no/such.osim"),
            lambda: fh.load_model(SLOW),
            lambda: fh.Model("no/such.osim"),
            lambda: fh.load_trial(ELBOW, self.model),
            lambda: fh.make_trial(self.model, {"time": [0, 1], "BRA": [0, 2]}),
            lambda: fh.make_trial(self.model, {"time": [0, 0], "BRA": [0, 1]}),
            lambda: fh.make_trial(self.model, {"time": [0, 1], "BRA": [0, 1, 0]}),
            lambda: fh.make_trial(self.model, {}),
            lambda: fh.replay(self.model, self.trial, integrator="euler"),
            lambda: fh.replay(self.model, self.trial, step=0),
            lambda: fh.replay(self.model, self.trial, step=5),
            lambda: fh.replay(self.model, self.trial, coordinate="knee"),
            lambda: fh.sensitivity(self.model, [], ["hand.mass"]),
            lambda: fh.sensitivity(self.model, [self.trial], ["hand.weight"]),
            lambda: fh.calibrate(self.model, [self.trial], ["hand.mass"], loss="l1"),
        )
        for i, one in enumerate(broken):
            with self.subTest(i), self.assertRaises(ValueError) as raised:
                one()
            self.assertEqual(str(raised.exception).count("\n"), 0)
            self.assertGreater(len(str(raised.exception)), 10)

    def test_options_have_names_and_types(self):
        for given in ({"stride": 1}, {"step": "long"}, {"lock": 1}, {"coordinate": 1}):
            for function in (lambda: fh.replay(self.model, self.trial, **given),
                             lambda: fh.list_parameters(self.model, **given),
                             lambda: fh.sensitivity(self.model, [self.trial], ["hand.mass"], **given),
                             lambda: fh.calibrate(self.model, [self.trial], ["hand.mass"], **given),
                             lambda: fh.discover(self.model, [self.trial], **given)):
                with self.subTest(given), self.assertRaises(TypeError):
                    function()

    def test_one_coordinate_is_a_name_or_a_list_of_it(self):
        one, listed = (fh.list_parameters(self.model, coordinate=name) for name in ("elbow_flexion", ["elbow_flexion"]))
        self.assertEqual(one, listed)
        self.assertEqual(len({parameter.name for parameter in one}), len(one))
        for parameter in one:
            stub.check(parameter, "ModelParameter")

    def test_ctrl_c_ends_a_long_call_soon_and_other_threads_run_meanwhile(self):
        trial = fh.load_trial(HIDDEN, self.model)
        # what a shell starts in the background ignores Ctrl-C, and so does its Python
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        ticks = []
        threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        ticker = threading.Thread(target=lambda: [ticks.append(time.sleep(0.01)) for _ in range(30)])
        ticker.start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            fh.discover(self.model, [trial], max_effects=3)
        self.assertLess(time.monotonic() - begin, 10)  # 0.6 s where nobody else works
        self.assertGreater(len(ticks), 5)
        ticker.join()


if __name__ == "__main__":
    unittest.main()
