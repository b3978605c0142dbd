"""Simulations as functions of JAX that are differentiated by one sweep back in time.

    misfit = fisherhill.jax.cost(model, trials, ["hand.mass", "TRI.radius"])
    slopes = jax.grad(misfit)(misfit.start)

They run on the host (jax.pure_callback), also within jax.jit, in the precision of JAX: double after
jax.config.update("jax_enable_x64", True). Without JAX importing this module raises ImportError (pip install jax).
"""

try:
    import jax
except ImportError as error:
    raise ImportError("fisherhill.jax needs JAX: pip install jax (Debian 12 has no package of it)") from error

import numpy as np

from . import _differentiable

__all__ = ["cost", "outputs"]


def _shape_of(array):
    return jax.ShapeDtypeStruct(array.shape, array.dtype)


class _Callable:
    """What cost and outputs return."""

    def __init__(self, function):
        self._function = function
        self.names, self.start = function.names, function.start
        self._simulation = jax.custom_vjp(self._value)
        self._simulation.defvjp(self._forward, self._pull_back)

    def __call__(self, values, *excitations):
        return self._simulation(jax.numpy.asarray(values), *map(jax.numpy.asarray, excitations))

    def _value(self, values, *excitations):
        def simulated(values, *excitations):
            return np.asarray(self._function.forward(values, excitations)[0], dtype=values.dtype)

        like = jax.ShapeDtypeStruct(self._function.shape, values.dtype)
        return jax.pure_callback(simulated, like, values, *excitations)

    def _forward(self, values, *excitations):
        """The value with its slopes where they come along, else with what they are computed from."""
        if not isinstance(self._function, _differentiable.Cost):
            return self._value(values, *excitations), (values, excitations, ())

        def simulated(values, *excitations):
            found, slopes = self._function.forward(values, excitations)
            of = (values, *excitations)
            return np.asarray(found, dtype=values.dtype), tuple(np.asarray(one, dtype=like.dtype) for one, like in zip(slopes, of))

        given = (values, *excitations)
        like = (jax.ShapeDtypeStruct((), values.dtype), tuple(map(_shape_of, given)))
        found, slopes = jax.pure_callback(simulated, like, *given)
        return found, (values, excitations, slopes)

    def _pull_back(self, kept, weight):
        values, excitations, slopes = kept
        if slopes:
            return tuple(weight * one for one in slopes)

        def pulled(weight, values, *excitations):
            found = self._function.pull_back(weight, values, excitations, ())
            return tuple(np.asarray(one, dtype=like.dtype) for one, like in zip(found, (values, *excitations)))

        given = (values, *excitations)
        return jax.pure_callback(pulled, tuple(map(_shape_of, given)), weight, *given)


def cost(model, trials, parameters, **options):
    """The misfit of cost_gradient as a function of arrays of JAX.

    Parameters
    ----------
    model, trials, parameters
        As in cost_gradient.
    options
        noise, priors, own_start, threads, coordinate, lock, integrator, step of cost_gradient.

    Returns
    -------
    callable
        f(values, *excitations) of the parameters and, if they shall be differentiated, one array of
        excitations (rows x muscles, 0 to 1) for each trial, as Trial.excitations has them; returns one
        number. names and start: the parameters, and their values in the model.

    Raises
    ------
    ValueError
        As cost_gradient, when it is made; later errors come out of the callback as JAX reports them.
    """
    return _Callable(_differentiable.Cost(model, trials, parameters, **options))


def outputs(model, trials, parameters, **options):
    """The simulated outputs of predict as a function of arrays of JAX.

    Parameters
    ----------
    model, trials, parameters
        As in predict.
    options
        observe, threads, initial, coordinate, lock, integrator, step of predict.

    Returns
    -------
    callable
        As of cost; returns an array of the outputs of all trials, one after the other.

    Raises
    ------
    ValueError
        As of cost.
    """
    return _Callable(_differentiable.Outputs(model, trials, parameters, **options))
