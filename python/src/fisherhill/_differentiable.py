"""Cost and outputs as functions of parameters and excitations with their pull-backs, for torch.py and jax.py: NumPy only."""

import numpy as np

from . import _fisherhill as fh


class _Function:
    """A function of values (parameters) and, if given, one array of excitations (rows x muscles) for each trial."""

    def __init__(self, model, trials, parameters, options):
        self.model, self.trials, self.parameters, self.options = model, list(trials), list(parameters), dict(options)

    def _trials(self, excitations):
        if not excitations:
            return self.trials
        if any(name.startswith("emg.") for name in self.names):
            raise ValueError("excitations and parameters of the EMG (emg.…) act on each other: only one of them can be given")
        if len(excitations) != len(self.trials):
            raise ValueError(f"excitations: {len(excitations)} arrays, must be {len(self.trials)}, one for each trial")
        return [trial.with_excitations(np.asarray(own, dtype=float)) for trial, own in zip(self.trials, excitations)]

    def _of_all_muscles(self, found):
        """Gradients of simulated muscles in the columns of the trials; those that move nothing have none."""
        gradients = []
        for trial, simulated in zip(self.trials, found.excitation_gradient):
            gradient = np.zeros(trial.excitations.shape)
            for column, name in enumerate(found.muscles):
                gradient[:, trial.muscles.index(name)] = simulated[:, column]
            gradients.append(gradient)
        return gradients


class Cost(_Function):
    """The misfit of cost_gradient; a value comes with its slopes, so that pulling back is a product."""

    def __init__(self, model, trials, parameters, **options):
        super().__init__(model, trials, parameters, options)
        at = fh.cost_gradient(model, self.trials, self.parameters, **self.options)
        self.names, self.start = at.names, at.values
        self.shape = ()

    def forward(self, values, excitations):
        """(value, what pull_back needs)"""
        found = fh.cost_gradient(self.model, self._trials(excitations), self.parameters, np.asarray(values, dtype=float), **self.options)
        return np.float64(found.cost), (found.gradient, *(self._of_all_muscles(found) if excitations else ()))

    def pull_back(self, weight, values, excitations, slopes):
        """Slopes in the values, and in each of the excitations."""
        return tuple(float(weight) * one for one in slopes)


class Outputs(_Function):
    """The outputs of predict, of all trials one after the other; pulling back is one sweep back in time."""

    def __init__(self, model, trials, parameters, **options):
        super().__init__(model, trials, parameters, options)
        at = fh.predict(model, self.trials, self.parameters, **self.options)
        self.names, self.start = at.names, at.values
        self.observed, self.times = at.observed, at.times
        self.ends = np.cumsum([len(one) for one in at.outputs])
        self.shape = (int(self.ends[-1]),)

    def forward(self, values, excitations):
        found = fh.predict(self.model, self._trials(excitations), self.parameters, np.asarray(values, dtype=float), **self.options)
        return np.concatenate(found.outputs), ()

    def pull_back(self, weight, values, excitations, slopes):
        weights = np.split(np.asarray(weight, dtype=float), self.ends[:-1])
        trials = self._trials(excitations)
        found = fh.predict(self.model, trials, self.parameters, np.asarray(values, dtype=float), weights=weights, **self.options)
        return (found.gradient, *(self._of_all_muscles(found) if excitations else ()))
