"""Predictions, their gradients, and what torch and jax make of them, against differences; stand-ins where they are missing.

fisherhill.torch is run with PyTorch where it is installed; without, and for JAX likewise, a stand-in holds the module to
the calls that it may make: shapes, types, and one slope for every argument.
"""

import contextlib
import importlib
import importlib.util
import sys
import types
import unittest
from unittest import mock

import numpy as np

import fisherhill as fh
from fisherhill import _differentiable

import stub

NAMES = ["hand.mass", "TRI.radius", "BRA.max_isometric_force"]
there = {name: importlib.util.find_spec(name) is not None for name in ("torch", "jax")}


class Elbow(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = fh.load_model("models/elbow8.osim")
        cls.trials = [fh.load_trial(f"emg_data/{name}.sto", cls.model) for name in ("curl_slow", "curl_fast")]
        cls.random = np.random.default_rng(3)

    def excitations(self, trial):
        return np.clip(trial.excitations + 0.01, 0.02, 0.98)

    def differences(self, function, values, steps):
        """Central differences of a number in each of the values."""
        found = []
        for i, h in enumerate(steps):
            move = np.zeros(len(values))
            move[i] = h
            found.append((function(values + move) - function(values - move)) / (2 * h))
        return np.array(found)


class Predictions(Elbow):
    def test_outputs_are_those_of_sensitivity_and_the_gradient_is_that_of_its_jacobian(self):
        told = fh.sensitivity(self.model, self.trials, NAMES)
        weights = [self.random.standard_normal(len(one)) for one in told.outputs]
        found = fh.predict(self.model, self.trials, NAMES, weights=weights)
        stub.check(found, "PredictionResult")
        self.assertEqual((found.names, found.observed), (NAMES, ["elbow_flexion"]))
        np.testing.assert_array_equal(found.values, told.values)
        for one, other in zip(found.outputs, told.outputs):
            np.testing.assert_allclose(one, other, atol=1e-12)
        expected = sum(gamma.T @ w for gamma, w in zip(told.gamma, weights))
        np.testing.assert_allclose(found.gradient, expected, rtol=1e-7)
        without = fh.predict(self.model, self.trials, NAMES)
        stub.check(without, "PredictionResult")
        self.assertIsNone(without.gradient)
        self.assertIsNone(without.excitation_gradient)

    def test_channels_come_one_after_the_other_in_the_order_asked_for(self):
        found = fh.predict(self.model, self.trials[:1], NAMES, observe=["elbow_flexion.speed", "elbow_flexion"])
        self.assertEqual(found.observed, ["elbow_flexion.speed", "elbow_flexion"])
        rows = len(found.times[0])
        alone = fh.predict(self.model, self.trials[:1], NAMES)
        np.testing.assert_array_equal(found.outputs[0][rows:], alone.outputs[0])
        speed = np.gradient(alone.outputs[0], found.times[0])
        self.assertLess(np.abs(speed - found.outputs[0][:rows]).max(), 0.2 * np.abs(speed).max())
        columns = found._columns()
        np.testing.assert_array_equal(columns["elbow_flexion"], alone.outputs[0])
        self.assertEqual(list(columns), ["trial", "time", "elbow_flexion.speed", "elbow_flexion"])

    def test_excitations_are_differentiated(self):
        trial = self.trials[0]
        end = np.zeros(451)
        end[-1] = 1
        base = self.excitations(trial)
        found = fh.predict(self.model, [trial.with_excitations(base)], NAMES, weights=[end])
        for name, row in (("BRA", 200), ("TRIlong", 100)):
            column, h = trial.muscles.index(name), 1e-5
            ends = []
            for d in (-h, h):
                moved = base.copy()
                moved[row, column] += d
                ends.append(fh.predict(self.model, [trial.with_excitations(moved)], NAMES).outputs[0][-1])
            slope = found.excitation_gradient[0][row, found.muscles.index(name)]
            self.assertNotEqual(slope, 0)
            self.assertAlmostEqual((ends[1] - ends[0]) / (2 * h), slope, delta=1e-4 * abs(slope) + 1e-9)

    def test_what_does_not_fit_is_refused(self):
        for wrong, why in (
            ({"values": [1.0]}, "1 values for 3 parameters"),
            ({"weights": [np.zeros(451), np.zeros(451)]}, "weights: 2 arrays, must be 1"),
            ({"weights": [np.zeros(3)]}, "3 weights for 451 outputs"),
            ({"weights": [np.full(451, np.nan)]}, "not finite"),
            ({"observe": ["BRA.tendon_force"], "weights": [np.zeros(451)]}, "BRA.tendon_force"),
            ({"observe": ["ghost"]}, "ghost"),
            ({"integrator": "cvode"}, "must be vi-adaptive, vi or vi-left"),
        ):
            with self.subTest(why), self.assertRaisesRegex(ValueError, why):
                fh.predict(self.model, self.trials[:1], NAMES, **wrong)
        with self.assertRaisesRegex(ValueError, "trials: empty"):
            fh.predict(self.model, [], NAMES)


class Functions(Elbow):
    """What the modules for torch and jax have in common."""

    def test_a_cost_comes_with_its_slopes(self):
        cost = _differentiable.Cost(self.model, self.trials, NAMES, priors=True)
        value, slopes = cost.forward(cost.start * 1.01, ())
        known = fh.cost_gradient(self.model, self.trials, NAMES, cost.start * 1.01, priors=True)
        self.assertEqual(value, known.cost)
        np.testing.assert_array_equal(cost.pull_back(2.0, None, (), slopes)[0], 2 * known.gradient)

    def test_slopes_of_excitations_have_the_columns_of_the_trial(self):
        trial = self.trials[0]
        base = self.excitations(trial)
        for function, weight in (
            (_differentiable.Cost(self.model, [trial], NAMES), 1.0),
            (_differentiable.Outputs(self.model, [trial], NAMES), self.random.standard_normal(451)),
        ):
            _, slopes = function.forward(function.start, [base])
            of_values, of_excitations = function.pull_back(weight, function.start, [base], slopes)
            self.assertEqual(of_values.shape, (3,))
            self.assertEqual(of_excitations.shape, trial.excitations.shape)
            row, column, h = 150, trial.muscles.index("BIClong"), 1e-5

            def summed(d):
                moved = base.copy()
                moved[row, column] += d
                return np.sum(weight * function.forward(function.start, [moved])[0])

            slope = of_excitations[row, column]
            self.assertAlmostEqual((summed(h) - summed(-h)) / (2 * h), slope, delta=1e-4 * abs(slope) + 1e-9)

    def test_excitations_that_cannot_be_differentiated_are_refused(self):
        trial = self.trials[0]
        both = _differentiable.Cost(self.model, [trial], ["hand.mass", "emg.delay"])
        with self.assertRaisesRegex(ValueError, "only one of them"):
            both.forward(both.start, [self.excitations(trial)])
        cost = _differentiable.Cost(self.model, [trial], NAMES)
        with self.assertRaisesRegex(ValueError, "2 arrays, must be 1"):
            cost.forward(cost.start, [self.excitations(trial)] * 2)
        with self.assertRaisesRegex(ValueError, "must be 901 x 8"):
            cost.forward(cost.start, [np.zeros((3, 8))])

    def test_what_to_install_is_said(self):
        for name, command in (("torch", "apt-get install python3-torch"), ("jax", "pip install jax")):
            with mock.patch.dict(sys.modules, {name: None}):
                sys.modules.pop(f"fisherhill.{name}", None)
                with self.assertRaisesRegex(ImportError, command):
                    importlib.import_module(f"fisherhill.{name}")


@unittest.skipUnless(there["torch"], "PyTorch is not installed (apt-get install python3-torch)")
class Torch(Elbow):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        import torch

        import fisherhill.torch

        cls.torch, cls.layer = torch, fisherhill.torch

    def test_a_cost_is_differentiated_in_a_graph(self):
        misfit = self.layer.cost(self.model, self.trials, NAMES)
        logarithms = self.torch.zeros(3, dtype=self.torch.float64, requires_grad=True)
        start = self.torch.tensor(misfit.start)
        (misfit(start * self.torch.exp(logarithms)) * 3).backward()
        known = fh.cost_gradient(self.model, self.trials, NAMES)
        np.testing.assert_allclose(logarithms.grad.numpy(), 3 * known.gradient * known.values, rtol=1e-12)

    def test_outputs_are_differentiated_by_their_cotangents(self):
        simulated = self.layer.outputs(self.model, self.trials[:1], NAMES)
        values = self.torch.tensor(simulated.start, requires_grad=True)
        excitations = self.torch.tensor(self.excitations(self.trials[0]), requires_grad=True)

        def loss(values, excitations):
            return (self.torch.sin(simulated(values, excitations)) ** 2).sum()

        found = loss(values, excitations)
        found.backward()
        plain = excitations.detach()
        steps = 1e-5 * simulated.start
        expected = self.differences(lambda v: float(loss(self.torch.tensor(v), plain)), simulated.start, steps)
        np.testing.assert_allclose(values.grad.numpy(), expected, rtol=1e-4)
        self.assertEqual(excitations.grad.shape, excitations.shape)
        moved = plain.clone()
        moved[150, 4] += 1e-5
        slope = float(excitations.grad[150, 4])
        self.assertAlmostEqual(float(loss(values.detach(), moved) - found.detach()) / 1e-5, slope, delta=1e-3 * abs(slope))

    def test_single_precision_stays_single(self):
        misfit = self.layer.cost(self.model, self.trials[:1], NAMES)
        values = self.torch.tensor(misfit.start, dtype=self.torch.float32, requires_grad=True)
        found = misfit(values)
        found.backward()
        self.assertEqual((found.dtype, values.grad.dtype), (self.torch.float32, self.torch.float32))

    def test_an_optimiser_of_torch_comes_down(self):
        misfit = self.layer.cost(self.model, self.trials[:1], NAMES[:1])
        scaled = self.torch.ones(1, dtype=self.torch.float64, requires_grad=True)
        optimiser = self.torch.optim.Adam([scaled], lr=0.05)
        costs = []
        for _ in range(8):
            optimiser.zero_grad()
            cost = misfit(scaled * self.torch.tensor(misfit.start))
            cost.backward()
            optimiser.step()
            costs.append(float(cost.detach()))
        self.assertLess(costs[-1], 0.9 * costs[0])

    def test_bad_excitations_are_one_line(self):
        misfit = self.layer.cost(self.model, self.trials[:1], NAMES)
        with self.assertRaisesRegex(ValueError, "TRIlong at .* must be 0 to 1"):
            misfit(self.torch.tensor(misfit.start), self.torch.full((901, 8), 1.5))


class StandInForTorch(Elbow):
    """A torch of tensors with what the module uses, and a Function whose backward is called with its context."""

    @staticmethod
    def torch():
        class Tensor:
            def __init__(self, values):
                self.values = np.asarray(values)

            def detach(self):
                return self

            cpu = detach

            def numpy(self):
                return self.values

            def new_tensor(self, values):
                return Tensor(np.asarray(values, dtype=self.values.dtype))

        class Function:
            @classmethod
            def apply(cls, *arguments):
                context = types.SimpleNamespace()
                result = cls.forward(context, *arguments)
                result.backward = lambda weight: cls.backward(context, weight)
                return result

        function = types.SimpleNamespace(once_differentiable=lambda method: method)
        module = types.ModuleType("torch")
        module.Tensor, module.autograd = Tensor, types.SimpleNamespace(Function=Function, function=function)
        return module

    def test_one_slope_for_every_argument_in_its_type(self):
        torch = self.torch()
        with loaded("torch", torch) as layer:
            for make in (layer.cost, layer.outputs):
                simulated = make(self.model, self.trials[:1], NAMES)
                values = torch.Tensor(simulated.start.astype(np.float32))
                excitations = torch.Tensor(self.excitations(self.trials[0]))
                result = simulated(values, excitations)
                weight = torch.Tensor(np.ones(result.values.shape))
                none, of_values, of_excitations = result.backward(weight)
                self.assertIsNone(none)
                self.assertEqual((of_values.values.shape, of_values.values.dtype), ((3,), np.float32))
                self.assertEqual(of_excitations.values.shape, (901, 8))
                self.assertGreater(np.abs(of_values.values).min(), 0)


class StandInForJax(Elbow):
    """A jax of pure_callback that holds results to the shapes and types that were announced, and custom_vjp."""

    @staticmethod
    def jax():
        def held(result, like):
            if isinstance(like, tuple):
                assert isinstance(result, tuple) and len(result) == len(like), (result, like)
                return tuple(held(one, of) for one, of in zip(result, like))
            assert isinstance(result, np.ndarray), type(result)
            assert (result.shape, result.dtype) == (like.shape, like.dtype), (result, like)
            return result

        class CustomVjp:
            def __init__(self, function):
                self.function = function

            def defvjp(self, forward, backward):
                self.forward, self.backward = forward, backward

            def __call__(self, *arguments):
                return self.function(*arguments)

        module = types.ModuleType("jax")
        module.ShapeDtypeStruct = lambda shape, dtype: types.SimpleNamespace(shape=shape, dtype=np.dtype(dtype))
        module.pure_callback = lambda function, like, *arguments: held(function(*arguments), like)
        module.custom_vjp = CustomVjp
        module.numpy = types.SimpleNamespace(asarray=np.asarray)
        return module

    def test_results_are_as_announced_and_slopes_are_right(self):
        with loaded("jax", self.jax()) as layer:
            for make in (layer.cost, layer.outputs):
                simulated = make(self.model, self.trials[:1], NAMES)
                excitations = self.excitations(self.trials[0])
                value = simulated(simulated.start, excitations)
                self.assertEqual(simulated(simulated.start.astype(np.float32)).dtype, np.float32)
                again, kept = simulated._simulation.forward(simulated.start, excitations)
                np.testing.assert_array_equal(again, value)
                weight = np.ones(np.shape(value))
                slopes = simulated._simulation.backward(kept, weight)
                self.assertEqual([one.shape for one in slopes], [(3,), (901, 8)])
                expected = self.differences(
                    lambda v: float(np.sum(simulated(v, excitations))), simulated.start, 1e-5 * simulated.start
                )
                np.testing.assert_allclose(slopes[0], expected, rtol=1e-4)


@unittest.skipUnless(there["jax"], "JAX is not installed (pip install jax; Debian 12 has no package of it)")
class Jax(Elbow):
    def test_gradients_are_those_of_differences_also_when_compiled(self):
        import jax

        import fisherhill.jax

        jax.config.update("jax_enable_x64", True)
        misfit = fisherhill.jax.cost(self.model, self.trials, NAMES)
        known = fh.cost_gradient(self.model, self.trials, NAMES)
        np.testing.assert_allclose(jax.grad(misfit)(misfit.start), known.gradient, rtol=1e-12)
        np.testing.assert_allclose(jax.jit(jax.grad(misfit))(misfit.start), known.gradient, rtol=1e-12)
        simulated = fisherhill.jax.outputs(self.model, self.trials[:1], NAMES)
        slopes = jax.grad(lambda v: (simulated(v) ** 2).sum())(simulated.start)
        expected = self.differences(lambda v: float((simulated(v) ** 2).sum()), simulated.start, 1e-5 * simulated.start)
        np.testing.assert_allclose(slopes, expected, rtol=1e-4)


@contextlib.contextmanager
def loaded(name, instead):
    """The module of fisherhill with a stand-in for what it imports."""
    before = sys.modules.pop(f"fisherhill.{name}", None)
    with mock.patch.dict(sys.modules, {name: instead}):
        sys.modules.pop(f"fisherhill.{name}", None)
        try:
            yield importlib.import_module(f"fisherhill.{name}")
        finally:
            sys.modules.pop(f"fisherhill.{name}", None)
    if before is not None:
        sys.modules[f"fisherhill.{name}"] = before


if __name__ == "__main__":
    unittest.main()
