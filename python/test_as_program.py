"""The numbers of functions against those that the program writes for the same question (beside_program)."""

import math
import unittest

import numpy as np

import fisherhill as fh

import stub
from beside_program.as_the_program import DEGREE, ELBOW, FAST, SLOW, AsTheProgram


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
            (lambda: fh.sensitivity(self.model, [self.slow], one, observe={"BRA.activation": math.inf}), "must be > 0 and finite"),
            (lambda: fh.profile_likelihood(self.model, [self.slow], one, one[0], noise=0), "noise = 0.*, must be > 0"),
            (lambda: fh.parameter_sweep(self.model, self.slow, one[0], [0.2]), "values: TRI.radius = 0.2 m, must be"),
            (lambda: fh.profile_likelihood(self.model, [self.slow], one, "hand.mass"), "profile: hand.mass is not one"),
            (lambda: fh.global_sensitivity(self.model, [self.slow], ["all"]), "must be at most 32"),
            (lambda: fh.global_sensitivity(self.model, [self.slow], one, method="fast"), "method 'fast'"),
            (lambda: fh.global_sensitivity(self.model, [self.slow], one, samples=1), "samples|trajectories"),
            (lambda: fh.global_sensitivity(self.model, [], one), "trials: empty"),
        ):
            self.one_line(call, words)


class Design(AsTheProgram):
    SEARCH = {"candidates": 6, "generations": 1, "seed": 3, "threads": 2}
    WORDS = ("--candidates", "6", "--generations", "1")

    def same_trial(self, found, out):
        """What is returned is what is written: to the digits of the file, and as a trial."""
        its = fh.load_trial(str(out / "design.sto"), self.model)
        self.assertEqual(found.trial.muscles, its.muscles)
        np.testing.assert_allclose(found.trial.times, its.times, rtol=1e-12)
        np.testing.assert_allclose(found.trial.excitations, its.excitations, rtol=1e-9)
        again = fh.make_trial(self.model, found.columns)
        np.testing.assert_array_equal(again.excitations, found.trial.excitations)
        for one, step in ((found.trial, 0.01), (again, 0.01)):
            motion = fh.replay(self.model, one, step=step)
            self.assertLess(motion.rms_error["elbow_flexion"], 1e-4)  # cubics between rows

    def same_limits(self, found, summary):
        for mine, its, unit in ((found.lowest, "lowest_deg", DEGREE), (found.highest, "highest_deg", DEGREE),
                                (found.largest_speed, "largest_speed_deg_per_s", DEGREE),
                                (found.largest_torque, "largest_torque_Nm", 1)):
            self.assertAlmostEqual(mine / unit, summary[its], 9)
        self.assertEqual(found.simulations, summary["simulations"])
        self.assertEqual(found.impossible_simulations, summary["impossible_simulations"])
        self.assertEqual(found.improved, summary["improved"])

    def test_of_parameters(self):
        summary, out = self.run_program("design", ELBOW, SLOW, "--parameters", "TRI.radius,hand.mass", *self.WORDS,
                                        "--iterations", "1", "--monte-carlo", "3", "--prior", "hand.mass=0.3")
        found = fh.design(self.model, self.slow, ["TRI.radius", "hand.mass"], prior={"hand.mass": 0.3}, iterations=1,
                          monte_carlo=3, **self.SEARCH)
        stub.check(found, "DesignResult")
        for k, name in enumerate(found.names):
            self.assertEqual(found.bound_before[k], summary["bound_before"][name])
            self.assertEqual(found.bound_after[k], summary["bound_after"][name])
            self.assertEqual(found.monte_carlo.mean[k], summary["monte_carlo_mean"][name])
            self.assertEqual(found.monte_carlo.sd[k], summary["monte_carlo_sd"][name])
        self.assertEqual(found.monte_carlo.converged, summary["monte_carlo_converged"])
        np.testing.assert_array_equal(found.prior_sd, [math.inf, 0.3])
        self.assertTrue(found.improved)
        self.assertLess(found.bound_after[0], found.bound_before[0])
        self.assertLess(found.costs[-1], found.costs[0])
        self.assertEqual(len(found.costs), len(found.found_at) + 1)
        self.same_limits(found, summary)
        self.same_trial(found, out)
        self.assertEqual(max(abs(found.columns["elbow_flexion.torque"])), found.largest_torque)
        self.assertEqual(found.bound_over_time.shape, found.times.shape)
        # without a prior, the last bound over time is that of sensitivity
        alone = fh.design(self.model, self.slow, ["TRI.radius"], iterations=0, **self.SEARCH)
        told = fh.sensitivity(self.model, [alone.trial], ["TRI.radius"], noise=0.5 * DEGREE)
        self.assertAlmostEqual(told.bound_alone[0] / alone.bound_after[0], 1, 2)  # the torque is written on knots
        self.assertAlmostEqual(alone.bound_over_time[-1] / alone.bound_after[0], 1, 9)
        self.assertIsNone(alone.monte_carlo)

    def test_of_excitations_with_nuisance_parameters(self):
        summary, _ = self.run_program(
            "design", ELBOW, SLOW, "--parameters", "TRI.radius", "--nuisance", "*.radius,hand.mass", "--criterion", "A",
            "--torque", "0", "--excite", "extensors,BRA+BRD", "--range", "1deg,128deg", "--candidates", "20", "--generations", "3",
            "--iterations", "0")
        found = fh.design(self.model, self.slow, ["TRI.radius"], nuisance=["*.radius", "hand.mass"], criterion="A", torque=0,
                          excite=["extensors", "BRA+BRD"], range=(DEGREE, 128 * DEGREE), iterations=0,
                          **(self.SEARCH | {"candidates": 20, "generations": 3}))
        stub.check(found, "DesignResult")
        self.assertEqual(found.of_interest, [True] + [False] * (len(found.names) - 1))
        self.assertEqual(found.bound_after[0], summary["bound_after"]["TRI.radius"])
        self.assertEqual(found.simulations, summary["simulations"])
        self.assertEqual(found.largest_torque, 0)
        self.assertEqual(found.largest_excitation_rate, summary["largest_excitation_rate_per_s"])

    def test_of_two_effects(self):
        summary, out = self.run_program("design", ELBOW, SLOW, "--separate", "delay,clock", "--size", "delay=0.03", *self.WORDS)
        found = fh.separate(self.model, self.slow, "delay", "clock", size={"delay": 0.03}, **self.SEARCH)
        stub.check(found, "SeparateResult")
        for mine, its in ((found.effects, "separates"), (found.size, "size"), (found.unit, "unit"),
                          (found.nats_before, "nats_before"), (found.nats_after, "nats_after"),
                          (found.bound_before, "bound_before"), (found.bound_after, "bound_after")):
            self.assertEqual(mine, summary[its], its)
        self.assertEqual(found.nats[0], min(found.nats_before.values()))
        self.assertEqual(found.nats[-1], min(found.nats_after.values()))
        self.same_limits(found, summary)
        self.same_trial(found, out)

    def test_of_a_held_elbow(self):
        """Its moment and a fibre are observed, excitations are sought."""
        names = ["BRA.max_isometric_force", "hand.mass"]
        summary, _ = self.run_program("design", ELBOW, SLOW, "--parameters", ",".join(names), *self.WORDS, "--iterations", "0",
                                      "--prescribe", "elbow_flexion", "--observe", "elbow_flexion.moment=0.5", "--observe",
                                      "BRA.fiber_length=0.001", "--excite", "flexors,extensors")
        held = fh.load_trial(SLOW, self.model, prescribe=["elbow_flexion"])
        observe = {"elbow_flexion.moment": 0.5, "BRA.fiber_length": 0.001}
        found = fh.design(self.model, held, names, observe=observe, excite=["flexors", "extensors"], iterations=0, **self.SEARCH)
        stub.check(found, "DesignResult")
        self.assertEqual(sorted(found.observed), sorted(observe))
        self.assertEqual(found.predicted.shape, (len(found.times), 2))
        self.assertEqual(found.coordinates, [])
        self.assertEqual(list(found.trial.prescribed), ["elbow_flexion"])
        told = fh.sensitivity(self.model, [found.trial], names, observe=observe)
        for k, name in enumerate(names):
            self.assertAlmostEqual(found.bound_after[k] / summary["bound_after"][name], 1, 9)
            self.assertAlmostEqual(found.bound_over_time[-1] / found.bound_after[0], 1, 9)
        np.testing.assert_allclose(np.linalg.inv(told.fisher).diagonal() ** 0.5, found.bound_after, rtol=1e-8)

    def test_of_two_joints(self):
        names = ["BRA.max_isometric_force", "hand.mass"]
        joints = ["elbow_flexion", "shoulder_elv"]
        summary, _ = self.run_program("design", ELBOW, SLOW, "--parameters", ",".join(names), *self.WORDS, "--iterations", "0",
                                      "--coordinate", ",".join(joints), "--torque", "elbow_flexion=3", "--torque",
                                      "shoulder_elv=2", "--range", "shoulder_elv=-3,3", "--speed", "1000")
        found = fh.design(self.model, self.slow, names, coordinate=joints, torque={"elbow_flexion": 3, "shoulder_elv": 2},
                          range={"shoulder_elv": (-3, 3)}, speed=1000 * DEGREE, iterations=0, **self.SEARCH)
        stub.check(found, "DesignResult")
        self.assertEqual(sorted(found.coordinates), joints)
        for k, one in enumerate(summary["coordinates"]):
            self.assertEqual(one["name"], found.coordinates[k])
            self.assertAlmostEqual(found.lowest[k] / DEGREE, one["lowest"], 9)
            self.assertEqual(found.largest_torque[k], one["largest_torque"])
        for k, name in enumerate(names):
            self.assertEqual(found.bound_after[k], summary["bound_after"][name])
        apart = fh.separate(self.model, self.slow, "elbow_flexion.visc", "shoulder_elv.visc", coordinate=joints, torque=2,
                            speed=1000 * DEGREE, candidates=1, generations=0)
        stub.check(apart, "SeparateResult")
        self.assertEqual(apart.predicted.shape, (len(apart.times), 2))

    def test_of_a_dynamometer(self):
        names = ["TRI.radius", "BRA.max_isometric_force"]
        summary, out = self.run_program("design", ELBOW, "--dynamometer", "elbow_flexion", "--parameters", ",".join(names),
                                        "--nuisance", "hand.mass", "--loads", "60", "--efforts", "40,80", "--experiments", "12")
        found = fh.design_on_dynamometer(self.model, "elbow_flexion", names, nuisance=["hand.mass"], loads=[0.6],
                                         efforts=[0.4, 0.8], experiments=12, threads=2)
        stub.check(found, "DynamometerDesignResult")
        for mine, its in ((found.candidates, "candidates"), (found.candidates_not_simulated, "candidates_not_simulated"),
                          (found.candidates_unsuitable, "candidates_unsuitable"),
                          (dict(zip(found.names, found.bound_before)), "bound_before"),
                          (dict(zip(found.names, found.bound_after)), "bound_after")):
            self.assertEqual(mine, summary[its], its)
        self.assertGreater(len({one.kind for one in found.experiments}), 1)
        for k, (mine, its) in enumerate(zip(found.experiments, summary["experiments"], strict=True)):
            self.assertEqual([mine.kind, mine.muscles, mine.torque, mine.instruction, mine.information],
                             [its[name] for name in ("kind", "muscles", "torque_Nm", "instruction", "information_nats")])
            self.assertEqual(dict(zip(found.names, mine.bounds)), its["bounds"])
            for value, name in ((mine.start, "from_deg"), (mine.end, "to_deg"), (mine.speed, "speed_deg_per_s")):
                self.assertAlmostEqual(value / DEGREE, its[name], 9)
            self.assertAlmostEqual(100 * mine.load, its["load_percent"], 12)
            rows = self.rows(out / f"experiment_{k + 1}.csv")
            self.assertEqual(set(rows[0]), set(mine.columns))
            np.testing.assert_allclose(self.column(rows, "BRA"), mine.columns["BRA"], rtol=1e-9)
            self.assertEqual(list(mine.trial.prescribed), [] if mine.kind == "isotonic" else ["elbow_flexion"])

    def test_the_first_bound_of_a_dynamometer_is_that_of_sensitivity(self):
        for kind in ("isometric", "isotonic"):
            found = fh.design_on_dynamometer(self.model, "elbow_flexion", ["BRA.max_isometric_force"], kinds=[kind], experiments=1)
            first = found.experiments[0]
            observe = {"elbow_flexion": 0.5 * DEGREE} if kind == "isotonic" else {"elbow_flexion.moment": 0.5}
            told = fh.sensitivity(self.model, [first.trial], found.names, observe=observe)
            self.assertAlmostEqual(told.bound_joint[0] / first.bounds[0], 1, 9)

    def test_wrong_questions_are_one_line(self):
        slow, one = self.slow, ["TRI.radius"]
        dynamometer = lambda **given: fh.design_on_dynamometer(self.model, "elbow_flexion", one, **given)
        held = fh.load_trial(SLOW, self.model, prescribe=["elbow_flexion"])
        for call, words in (
            (lambda: fh.design(self.model, slow, one, rate=0), "rate = 0.*must be > 0"),
            (lambda: fh.design(self.model, slow, one, rate=1e12), "period .* must be a millionth"),
            (lambda: fh.design(self.model, slow, one, monte_carlo=-1), "monte_carlo = -1"),
            (lambda: fh.separate(self.model, slow, "delay", "clock", rate=1e12), "period .* must be a millionth"),
            (lambda: dynamometer(rate=1e12), "rate must be at most 1e5"),
            (lambda: fh.design_on_dynamometer(self.model, "elbow_flexion", []), "no parameter is given"),
            (lambda: fh.design(self.model, slow, one, noise=-1), "noise of 'elbow_flexion' = -1.*must be > 0"),
            (lambda: fh.design(self.model, slow, one, observe={"elbow_flexion.moment": 1}), "must be prescribed or locked"),
            (lambda: fh.design(self.model, slow, one, observe={"elbow": 1}), "'elbow' is nothing that can be measured"),
            (lambda: fh.design(self.model, slow, one, torque={"knee": 1}), "torque of 'knee': must be a coordinate that is free"),
            (lambda: fh.design(self.model, held, one, observe={"elbow_flexion.moment": 1}), "no input to design"),
            (lambda: fh.separate(self.model, slow, "delay", "clock", observe={"elbow_flexion.speed": 1}),
             "'elbow_flexion' is free to move and must be observed"),
            (lambda: fh.design(self.model, slow, one, criterion="T"), "criterion 'T', must be E, A or D"),
            (lambda: fh.design(self.model, slow, one, prior={"hand.mass": 1}), "prior: hand.mass is neither"),
            (lambda: fh.design(self.model, slow, one, range=(2, 1)), "range: 2 to 1 rad, must rise"),
            (lambda: fh.design(self.model, slow, one, excite=["GLUT"]), "'GLUT' must be a muscle"),
            (lambda: fh.design(self.model, slow, one, torque=0), "input"),
            (lambda: fh.design(self.model, slow, one, excite=["BRA"], excitation_max=2), "within 0 to 1"),
            (lambda: fh.design(self.model, slow, one, nuisance=["hand.mass"], monte_carlo=2), "monte_carlo"),
            (lambda: fh.design(self.model, slow, one, integrator="rk4"), "integrator|variational"),
            (lambda: fh.design(self.model, slow, one, candidates=-1), "must be ≥ 0"),
            (lambda: fh.design(self.model, held, one, candidates=1), "nothing is observed|no input to design"),
            (lambda: fh.separate(self.model, slow, "delay", "delay"), "given twice"),
            (lambda: fh.separate(self.model, slow, "delay", "ghost"), "ghost"),
            (lambda: fh.separate(self.model, slow, "delay", "clock", size={"drag": 1}), "'drag' is not one of the two"),
            (lambda: dynamometer(angles=[7]), "angles: 7 rad .* is outside the range"),
            (lambda: dynamometer(efforts=[40]), "efforts: 4000 % MVC"),
            (lambda: dynamometer(kinds=["isotnic"]), "'isotnic', must be isometric"),
            (lambda: dynamometer(kinds=["passive"], loads=[0.5]), "loads: must have isotonic"),
            (lambda: dynamometer(moment_noise=0), "must be > 0"),
            (lambda: dynamometer(lock={"elbow_flexion": 1}), "must not be locked"),
            (lambda: fh.design_on_dynamometer(self.model, "knee", one), "knee"),
        ):
            self.one_line(call, words)

    def test_ctrl_c_ends_a_search(self):
        for call in (lambda: fh.design(self.model, self.slow, ["all"], candidates=100000),
                     lambda: fh.separate(self.model, self.slow, "delay", "clock", candidates=100000),
                     lambda: fh.design_on_dynamometer(self.model, "elbow_flexion", ["all"],
                                                      angles=list(np.linspace(0.3, 2, 40)))):
            self.ends_soon_after_ctrl_c(call)


del AsTheProgram  # has no tests of its own

if __name__ == "__main__":
    unittest.main()
