"""The robots' numbers against those that the program writes for the same question.

Run from the top of the source tree, with the program's path in FISHERHILL_PROGRAM; without that there is nothing to do.
"""

import csv
import json
import math
import pathlib
import tempfile
import unittest

import numpy as np

import fisherhill as fh

import stub
from beside_program.as_the_program import BesideProgram

NOISE = 0.02  # of the force [N]
GRAVITY = 9.81


def hanging_mass(amplitude, period, bias, seed):
    """A trial of 2 s of a mass on a string below a cart: columns by name. The sensor has a bias [N]."""
    mass, length, steps, every = 0.12, 0.5, 1000, 10
    omega, h = 2 * math.pi / period, 2 / steps

    def cart(t):
        return amplitude * omega**2 * math.cos(omega * t)

    def rate(t, x):
        return np.array([x[1], (cart(t) * math.cos(x[0]) - GRAVITY * math.sin(x[0])) / length])

    x, times, forces = np.zeros(2), [], []
    for k in range(steps + 1):
        t = k * h
        if k % every == 0:
            times.append(t)
            forces.append(mass * (GRAVITY * math.cos(x[0]) + length * x[1]**2 + cart(t) * math.sin(x[0])))
        a = rate(t, x)
        b = rate(t + h / 2, x + h / 2 * a)
        c = rate(t + h / 2, x + h / 2 * b)
        x = x + h / 6 * (a + 2 * b + 2 * c + rate(t + h, x + h * c))
    noise = NOISE * np.random.default_rng(seed).standard_normal(len(times))
    return {"time": np.array(times), "input": np.array([cart(t) for t in times]), "force_N": np.array(forces) + bias + noise}


class RobotsBesideProgram(BesideProgram):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def table(self, columns, name):
        """A file with these columns; every number reads back as the same."""
        file = self.folder / name
        with open(file, "w", encoding="utf-8", newline="") as out:
            rows = csv.writer(out)
            rows.writerow(columns)
            rows.writerows([repr(float(value)) for value in row] for row in zip(*columns.values()))
        return str(file)

    def columns(self, file):
        rows = self.rows(file)
        return {name: self.column(rows, name) for name in rows[0]}

    def same(self, mine, its):
        np.testing.assert_array_equal(np.asarray(mine, float), np.asarray(its, float))


class Discovery(RobotsBesideProgram):
    def setUp(self):
        super().setUp()
        self.trials = [hanging_mass(0.1, 1.2, 0.3, 0), hanging_mass(0.09, 1.3, 0.3, 2)]
        self.files = [self.table(columns, f"trial_{k}.csv") for k, columns in enumerate(self.trials)]

    def same_gap(self, mine, its):
        for name, key in (("nominal", "rmse_nominal_N"), ("calibrated", "rmse_calibrated_N"), ("after", "rmse_after_N"),
                          ("noise_floor", "noise_floor_N"), ("closed", "gap_closed"), ("expected", "rmse_expected_N"),
                          ("probability", "rmse_probability")):
            self.assertEqual(getattr(mine, name), its.get(key), name)

    def same_verdict(self, found, out):
        its = json.loads((out / "verdict.json").read_text(encoding="utf-8"))
        for mine, key in ((found.verdict, "verdict"), (found.sentence, "sentence"), (found.step, "step_s"),
                          (found.probability_vetoed, "probability_vetoed"), (found.held_out_fitted, "held_out_fitted")):
            self.assertEqual(mine, its[key], key)
        self.assertEqual(found.already_in_the_model, list(its["already_in_the_model"]))
        self.assertEqual([one.id for one in found.effects], [one["id"] for one in its["effects"]])
        for mine, effect in zip(found.effects, its["effects"]):
            for name in ("name", "kind", "log_bayes_factor", "probability"):
                self.assertEqual(getattr(mine, name), effect[name], name)
            self.assertEqual({name: vars(one) for name, one in mine.parameters.items()}, effect["parameters"])
        self.assertEqual([c for one in found.effects for c in one.cannot_be_told_from], its["class"])
        self.assertEqual({id: None if math.isinf(size) else size for id, size in found.undetectable_below.items()},
                         its["undetectable_below"])
        self.assertEqual([(one.name, one.estimate, one.sd) for one in found.fitted_parameters],
                         [(one["name"], one["estimate"], one["sd"]) for one in its["fitted_parameters"]])
        self.same_gap(found.gap, its["gap"]["train"])
        self.same_gap(found.gap_held_out, its["gap"]["held_out"])

    def test_of_a_biased_load_cell(self):
        words = ("discover", "--system", "suspended-mass", self.files[0], "--hold-out", self.files[1])
        options = ("--max-effects", 1, "--noise", NOISE, "--without", "saturation")
        summary, out = self.run_program(*words, *options)
        given = {"max_effects": 1, "noise": NOISE, "without": ["saturation"]}
        found = fh.discover_robot("suspended-mass", self.files[:1], hold_out=self.files[1:], **given)
        stub.check(found, "RobotDiscoveryResult")
        self.same_verdict(found, out)
        self.assertEqual(found.verdict, "named")
        bias = found.effects[0].parameters["bias"]
        self.assertLess(abs(bias.value - 0.3), 3 * bias.sd)
        self.assertEqual(found.noise, {"force": NOISE})
        self.assertEqual(found.fits, summary["fits"])
        # the same numbers in columns
        told = []
        again = fh.discover_robot("suspended-mass", self.trials[:1], hold_out=self.trials[1:], progress=told.append, **given)
        self.assertEqual(again.effects, found.effects)
        self.assertEqual((told, told[-1]), (sorted(told), 1))

        # nothing more is missing with the effect, which comes from a file or from the result
        file = str(out / "with_effect.json")
        _, out = self.run_program(*words, "--max-effects", 1, "--with", file)
        for effects in (file, found.effects):
            more = fh.discover_robot("suspended-mass", self.files[:1], hold_out=self.files[1:], max_effects=1,
                                     with_effects=effects)
            self.assertEqual((more.verdict, more.effects), ("none", []))
            self.assertEqual(more.already_in_the_model, ["bias"])
            if effects == file:
                self.same_verdict(more, out)

    def test_of_a_double_pendulum(self):
        motion = fh.optimise_robot_motion("double-pendulum", period=2, iterations=0, trials=1).before
        noise = np.random.default_rng(1).standard_normal((len(motion.time), 2)) * 0.01
        trial = {"time": motion.time, "input": motion.input, "link1_rad": motion.states[:, 1] + noise[:, 0] + 0.1,
                 "link2_rad": motion.states[:, 2] + noise[:, 1]}
        trial = {name: values[:241:4] for name, values in trial.items()}
        file = self.table(trial, "pendulum.csv")
        _, out = self.run_program("discover", "--system", "double-pendulum", file, "--max-effects", "1")
        found = fh.discover_robot("double-pendulum", [trial], max_effects=1)
        stub.check(found, "RobotDiscoveryResult")
        its = json.loads((out / "verdict.json").read_text(encoding="utf-8"))
        self.assertEqual((found.verdict, found.effects[0].id), (its["verdict"], its["effects"][0]["id"]))
        self.assertEqual(found.effects[0].id, "bias_1")
        self.assertEqual({name: vars(one) for name, one in found.effects[0].parameters.items()}, its["effects"][0]["parameters"])
        self.assertEqual(found.effects[0].log_bayes_factor, its["effects"][0]["log_bayes_factor"])
        self.assertEqual(list(found.noise), ["link1", "link2"])

    def test_unknown_columns_may_be_ignored(self):
        trial = self.trials[0] | {"colour": self.trials[0]["time"]}
        given = {"max_effects": 0, "noise": NOISE}
        self.one_line(lambda: fh.discover_robot("suspended-mass", [trial], **given), "column colour is unknown; ignore_extra")
        found = fh.discover_robot("suspended-mass", [trial], ignore_extra=True, **given)
        self.assertEqual(found.warnings, ["trial 1: column colour is unknown and ignored"])

    def test_wrong_questions_are_one_line(self):
        trial, file = self.trials[0], self.files[0]
        other = self.folder / "other.json"
        other.write_text('{"system": "double-pendulum", "effects": []}', encoding="utf-8")
        discover = lambda trials=[trial], **given: fh.discover_robot("suspended-mass", trials, **given)
        no_input = {name: values for name, values in trial.items() if name != "input"}
        for call, words in (
            (lambda: fh.discover_robot("baxter", [trial]), "system 'baxter', must be double-pendulum or suspended-mass"),
            (lambda: discover([]), "trials: empty"),
            (lambda: discover([trial, dict(trial)]), "trial 2: is the same trial as trial 1"),
            (lambda: discover([file], hold_out=[trial]), "trial 2: is held out and also used for estimation"),
            (lambda: discover([no_input]), "trial 1: has no column input"),
            (lambda: discover([trial | {"force": trial["force_N"]}]), "columns force_N and force have the same meaning"),
            (lambda: discover([trial | {"time": -trial["time"]}]), "must be finite and rise"),
            (lambda: discover([trial | {"force_N": trial["force_N"][1:]}]), "column 'force_N' has 100 rows, must be 101"),
            (lambda: discover([file], step=9), "step: 9 s, must not be longer than .*trial_0.csv, which lasts 2 s"),
            (lambda: discover(step=0), "step = 0 s, must be > 0"),
            (lambda: discover(noise=[1, 2]), "2 values for 1 channels"),
            (lambda: discover(without=["visc_1"]), "not in the catalogue of suspended-mass"),
            (lambda: discover(input_scatter=-1), "input_scatter: -1 must be a number"),
            (lambda: discover(with_effects=str(other)), "other.json: system is double-pendulum, must be suspended-mass"),
            (lambda: discover(with_effects=str(self.folder / "none.json")), "none.json"),
            (lambda: discover(["none.csv"]), "none.csv"),
        ):
            self.one_line(call, words)

    def test_ctrl_c_ends_a_search(self):
        self.ends_soon_after_ctrl_c(lambda: fh.discover_robot("suspended-mass", self.trials, step=0.0005))


class Motions(RobotsBesideProgram):
    def same_search(self, found, summary, out):
        self.assertEqual(found.iterations, summary["iterations"])
        self.assertEqual((found.costs[0], found.costs[-1]), (summary["cost_initial"], summary["cost_optimised"]))
        self.assertEqual(found.why, summary["why_it_stopped"])
        search = json.loads((out / "search.json").read_text(encoding="utf-8"))
        for mine, its in ((found.costs, "costs"), (found.slopes, "slopes"), (found.steps, "steps"),
                          (np.linalg.eigvalsh(found.information_before), "eigenvalues_before")):
            np.testing.assert_allclose(mine, search[its], rtol=1e-8)
        self.assertEqual(found.motions_tried, search["motions_tried"])
        for motion, file in ((found.before, "motion_initial.csv"), (found.after, "motion_optimised.csv")):
            columns = self.columns(out / file)
            self.assertEqual(list(columns), ["time", "input", *found.state_names])
            np.testing.assert_allclose(motion.time, columns.pop("time"), rtol=1e-9)
            self.same(motion.input, columns.pop("input"))
            self.same(motion.states.T, list(columns.values()))
            self.assertEqual(motion.information.shape, (len(motion.time), 2, 2))

    def same_trials(self, found, summary):
        for when, mine in (("initial", (found.bound_before, found.trials_before)),
                           ("optimised", (found.bound_after, found.trials_after))):
            self.same(mine[0], summary[f"bound_{when}"])
            self.same(mine[1].covariance, summary[f"monte_carlo_{when}"])
            self.assertEqual(mine[1].converged, summary["trials_converged"][when])
            self.assertEqual(mine[1].estimates.shape, (mine[1].converged, 2))

    def test_in_steps(self):
        options = {"iterations": 1, "measure_every": 2, "objective": {"a": 1e4}, "input_weight": 0.5, "limits": (-0.05, 0.05),
                   "tolerance": 0.02, "amplitude": 0.012, "perturb": 0.001, "trials": 4, "seed": 3, "threads": 2}
        words = ("robot", "double-pendulum", "--discrete", "--trials", 4)
        summary, out = self.run_program(*words, "--iterations", 1, "--measure-every", 2, "--objective", "a=1e4", "--input-weight",
                                        0.5, "--limits", -0.05, 0.05, "--tolerance", 0.02, "--amplitude", 0.012, "--perturb", 0.001)
        found = fh.optimise_robot_motion("double-pendulum", discrete=True, **options)
        stub.check(found, "RobotMotionResult")
        self.same_search(found, summary, out)
        self.same_trials(found, summary)
        self.same(found.information_before, summary["information_initial"])
        self.same(found.information_after, summary["information_optimised"])
        np.testing.assert_allclose(found.after.information[-1], found.information_after, rtol=1e-9)
        self.assertLess(found.costs[-1], found.costs[0])
        # on from there
        summary, out = self.run_program(*words, "--iterations", 0, "--warm-start", out / "motion_optimised.csv", status=1)
        again = fh.optimise_robot_motion("double-pendulum", discrete=True, iterations=0, warm_start=found.after.input, trials=4,
                                         seed=3)
        self.same_search(again, summary, out)
        self.same(again.before.input[1:], found.after.input[1:])

    def test_of_the_double_pendulum(self):
        summary, out = self.run_program("robot", "double-pendulum", "--iterations", 1, "--trials", 4, "--robust", "worst",
                                        "--candidate", 0.085, 0.5, "--candidate", 0.1, 0.4, "--period", 2)
        found = fh.optimise_robot_motion("double-pendulum", iterations=1, trials=4, robust="worst",
                                         candidates=[(0.085, 0.5), (0.1, 0.4)], period=2, seed=3)
        stub.check(found, "RobotMotionResult")
        self.same_search(found, summary, out)
        self.same_trials(found, summary)
        self.assertEqual((found.names, found.units), (["m1", "c"], ["kg", "g m²/s"]))
        self.same(found.robust.candidates, summary["candidates"])
        for mine, its in ((found.robust.initial, "initial"), (found.robust.nominal, "nominal"), (found.robust.robust, "robust")):
            self.same(mine, summary["lambda_min_candidates"][its])

    def test_of_the_suspended_mass_in_the_laboratory(self):
        effects = ("--dry-friction", 1e-4, "--sensor-step", 0.003)
        summary, out = self.run_program("robot", "suspended-mass", "--iterations", 1, "--amplitude", 0.1, "--period", 1.2, *effects)
        found = fh.optimise_robot_motion("suspended-mass", iterations=1, amplitude=0.1, period=1.2,
                                         lab={"dry_friction": 1e-4, "sensor_step": 0.003}, seed=3, threads=2)
        stub.check(found, "RobotMotionResult")
        self.same_search(found, summary, out)
        for mine, its in ((found.estimator_iterations_before, "initial"), (found.estimator_iterations_after, "optimised")):
            self.assertEqual(mine["gradient descent"], summary["gradient_descent_iterations"][its])
            self.assertEqual(mine["iterated least squares"], summary["iterated_least_squares_iterations"][its])
        lab = summary["laboratory"]
        for mine, its in ((found.laboratory.truth, "actual"), (found.laboratory.start, "initial_estimate"),
                          (found.laboratory.estimate_before, "estimate_initial"),
                          (found.laboratory.estimate_after, "estimate_optimised"),
                          (found.laboratory.median_error_before, "median_error_initial"),
                          (found.laboratory.median_error_after, "median_error_optimised")):
            self.same(mine, lab[its])
        # the bound is that of the experiment, at the values of the search
        np.testing.assert_allclose(np.linalg.inv(found.bound_before), found.information_before, rtol=1e-9)

    def test_information(self):
        summary, _ = self.run_program("robot", "double-pendulum", "--as-is", "--trials", 6, "--period", 2)
        found = fh.robot_information("double-pendulum", period=2, trials=6, seed=3)
        stub.check(found, "RobotInformationResult")
        for mine, its in ((found.information, "information"), (found.bound, "cramer_rao_bound"),
                          (found.trials.covariance, "trials_covariance")):
            self.assertEqual([mine[0, 0], mine[0, 1], mine[1, 1]], [summary[its][pair] for pair in ("m1_m1", "m1_c", "c_c")])
        self.assertEqual(found.trials.converged, summary["trials_converged"])
        self.assertEqual(found.sentences, summary["findings"])
        self.assertEqual(found.eigenvalues[0], summary["least_eigenvalue"])
        summary, _ = self.run_program("robot", "double-pendulum", "--bound-only", "--unknown", "m1,m2", "--undamped", status=1)
        none = fh.robot_information("double-pendulum", unknown=["m1", "m2"], undamped=True, trials=3)
        stub.check(none, "RobotInformationResult")
        self.assertEqual(none.determined_directions, summary["determined_directions"])
        self.assertEqual("; ".join(none.undetermined_directions), summary["undetermined_direction"])
        self.assertEqual(none.determined, ["m1/m2"])
        self.assertIsNone(none.bound)
        self.assertIsNone(none.trials)

    def test_convergence(self):
        summary, _ = self.run_program("robot", "suspended-mass", "--convergence")
        found = fh.compare_robot_estimators(seed=3)
        stub.check(found, "EstimatorComparisonResult")
        for motion in ("quiet", "lively"):
            for one in getattr(found, motion):
                its = summary[f"{motion}_" + one.method.replace(" ", "_").replace("-", "_")]
                self.assertEqual((one.iterations, one.converged, one.error[-1]),
                                 (its["iterations"], its["converged"], its["final_error"]))
                self.assertEqual(one.mean_ratio, its["mean_ratio"])
                self.assertEqual(len(one.cost), one.iterations + 1)

    def test_wrong_questions_are_one_line(self):
        optimise = lambda robot="double-pendulum", **given: fh.optimise_robot_motion(robot, **({"iterations": 0, "trials": 1} | given))
        for call, words in (
            (lambda: optimise("baxter"), "robot 'baxter', must be"),
            (lambda: optimise("suspended-mass", discrete=True), "a discrete motion: must be of the double pendulum"),
            (lambda: optimise(measure_every=2), "must be of a discrete motion"),
            (lambda: optimise(objective={"t": 1}), "criterion 't', must be e, a, d or condition"),
            (lambda: optimise(objective={"e": -1}), "weight"),
            (lambda: optimise(robust="best"), "robust 'best', must be worst or average"),
            (lambda: optimise(candidates=[(1, 1)]), "candidates: must be of a robust search"),
            (lambda: optimise(period=0), "period: 0 s, must be > 0"),
            (lambda: optimise(amplitude=math.nan), "amplitude: nan m, must be"),
            (lambda: optimise(amplitude=0), "perturb=0.05 adds"),
            (lambda: optimise(trials=0), "trials: 0, must be"),
            (lambda: optimise(warm_start=[1, 2]), "warm start: 2 inputs, must be 601"),
            (lambda: optimise(limits=(1, 0)), "limit"),
            (lambda: optimise(lab={"wind": 1}), "lab: 'wind', must be"),
            (lambda: optimise(lab={"control_lag": -1}), "control lag: -1 s, must be"),
            (lambda: optimise(lab=True, discrete=True), "laboratory: must not be with a discrete motion"),
            (lambda: fh.robot_information("suspended-mass", unknown=["m1", "m2"]), "must be with 'double-pendulum'"),
            (lambda: fh.robot_information("double-pendulum", unknown=["m2"]), "unknown: must be"),
            (lambda: fh.robot_information("double-pendulum", undamped=True), "undamped: must not be"),
            (lambda: fh.robot_information("double-pendulum", amplitude=0), "must be > 0"),
            (lambda: fh.robot_information("double-pendulum", trials=-1), "trials = -1"),
            (lambda: fh.compare_robot_estimators(period=-1), "must be > 0"),
        ):
            self.one_line(call, words)

    def test_ctrl_c_ends_the_work(self):
        self.ends_soon_after_ctrl_c(lambda: fh.optimise_robot_motion("double-pendulum", trials=1000000))
        self.ends_soon_after_ctrl_c(lambda: fh.robot_information("double-pendulum", trials=1000000))


class StringLength(RobotsBesideProgram):
    def test_as_the_program(self):
        summary, out = self.run_program("robot", "baxter", "--duration", 1.5, "--initial-length", 0.42, "--estimate-mass",
                                        "--window", 1, "--noise", 0.08)
        found = fh.estimate_string_length([0.42], duration=1.5, estimate_mass=True, window=1, noise=0.08, seed=3)
        stub.check(found, "StringLengthResult")
        trial, its = found.trials[0], summary["trials"][0]
        for mine, name in ((trial.initial_length, "initial_m"), (trial.length, "estimate_m"), (trial.length_sd, "deviation_m"),
                           (trial.mass, "mass_kg"), (trial.swing_without.success, "success_without_estimation"),
                           (trial.swing_with.success, "success_with_estimation")):
            self.assertEqual(mine, its[name], name)
        for mine, name in ((found.mean, "mean_m"), (found.sd, "standard_deviation_m"), (found.largest_error, "largest_error_m"),
                           (found.successes_without, "successes_without_estimation"),
                           (found.successes_with, "successes_with_estimation"), (trial.clipped_samples, "clipped_samples")):
            self.assertEqual(mine, summary[name], name)
        estimates, samples = self.columns(out / "estimates.csv"), self.columns(out / "samples.csv")
        for mine, name in ((trial.estimates.time, "time"), (trial.estimates.length, "length_m"),
                           (trial.estimates.length_sd, "length_deviation_m"), (trial.estimates.mass, "mass_kg")):
            np.testing.assert_allclose(mine, estimates[name], rtol=1e-5)
        for mine, name in ((trial.samples.position, "position_m"), (trial.samples.force, "force_N"),
                           (trial.samples.predicted_force, "predicted_force_N"), (trial.samples.information, "information_per_m2")):
            np.testing.assert_allclose(mine, samples[name], rtol=1e-7)
        swings = self.columns(out / "swing.csv")
        for swing, estimated in ((trial.swing_without, 0), (trial.swing_with, 1)):
            rows = swings["estimated"] == estimated
            np.testing.assert_allclose(swing.ball_x[::4], swings["ball_x_m"][rows], rtol=1e-7)

    def test_wrong_questions_are_one_line(self):
        for given, words in (({"tracking_weight": 0}, "tracking_weight = 0: nothing would move"),
                             ({"noise": 0}, "noise: 0 N, must be > 0"), ({"duration": -1}, "duration: -1 s, must be > 0"),
                             ({"window": 0.05}, "window: 0.05 s, must be"), ({"initial_lengths": [2]}, "initial length: 2 m, must be"),
                             ({"disturbance": math.inf}, "disturbance: inf m/s², must be")):
            self.one_line(lambda: fh.estimate_string_length(**given), words)

    def test_ctrl_c_ends_a_trial(self):
        self.ends_soon_after_ctrl_c(lambda: fh.estimate_string_length([0.42], duration=60, real_time=True))


del BesideProgram, RobotsBesideProgram  # have no tests of their own

if __name__ == "__main__":
    unittest.main()
