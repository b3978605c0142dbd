"""Simulations as functions of PyTorch that are differentiated by one sweep back in time.

    misfit = fisherhill.torch.cost(model, trials, ["hand.mass", "TRI.radius"])
    values = torch.tensor(misfit.start, requires_grad=True)
    misfit(values).backward()

Without PyTorch importing this module raises ImportError (apt-get install python3-torch).
"""

try:
    import torch
except ImportError as error:
    raise ImportError("fisherhill.torch needs PyTorch: apt-get install python3-torch, or pip install torch") from error

from . import _differentiable

__all__ = ["cost", "outputs"]


def _array(tensor):
    return tensor.detach().cpu().numpy().copy()  # an optimiser may change the tensor before it pulls back


class _Simulation(torch.autograd.Function):
    @staticmethod
    def forward(ctx, function, values, *excitations):
        at, given = _array(values), [_array(one) for one in excitations]
        found, slopes = function.forward(at, given)
        ctx.pull_back = lambda weight: function.pull_back(weight, at, given, slopes)
        ctx.like = (values, *excitations)
        return values.new_tensor(found)

    @staticmethod
    @torch.autograd.function.once_differentiable
    def backward(ctx, weight):
        slopes = ctx.pull_back(_array(weight))
        return (None, *(like.new_tensor(one) for like, one in zip(ctx.like, slopes)))


class _Callable:
    """What cost and outputs return."""

    def __init__(self, function):
        self._function = function
        self.names, self.start = function.names, function.start

    def __call__(self, values, *excitations):
        return _Simulation.apply(self._function, values, *excitations)


def cost(model, trials, parameters, **options):
    """The misfit of cost_gradient as a function of tensors.

    Parameters
    ----------
    model, trials, parameters
        As in cost_gradient.
    options
        noise, priors, own_start, threads, coordinate, lock, integrator, step of cost_gradient.

    Returns
    -------
    callable
        f(values, *excitations) of a tensor of the parameters and, if they shall be differentiated, one
        tensor of excitations (rows x muscles, 0 to 1) for each trial, as Trial.excitations has them;
        returns a tensor of one number in the type of values. names and start: the parameters, and their
        values in the model.

    Raises
    ------
    ValueError
        As cost_gradient; for excitations that Trial.with_excitations refuses or beside parameters
        emg.….
    """
    return _Callable(_differentiable.Cost(model, trials, parameters, **options))


def outputs(model, trials, parameters, **options):
    """The simulated outputs of predict as a function of tensors.

    Parameters
    ----------
    model, trials, parameters
        As in predict.
    options
        observe, threads, initial, coordinate, lock, integrator, step of predict.

    Returns
    -------
    callable
        As of cost; returns a tensor of the outputs of all trials, one after the other.

    Raises
    ------
    ValueError
        As predict, and as cost for excitations.
    """
    return _Callable(_differentiable.Outputs(model, trials, parameters, **options))
