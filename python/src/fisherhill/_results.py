"""Classes of results: their tables, and drawings where one is obvious. Members are those of the type stub."""

import math

import numpy as np

from ._tables import Plotted, PlottedRows, Rows, Table, new_axes, several_axes

__all__ = ["Rows"]


def _labelled(axes, x, y, legend=True):
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    if legend and axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize="small")


def _bars(axes, names, values, label):
    axes.barh(range(len(names)), values)
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.set_xlabel(label)


def _with_sd(value, sd, unit):
    known = "" if math.isnan(sd) else f" ± {sd:.2g}"
    return f"{value:.4g}{known}{' ' + unit if unit else ''}"


class ReplayResult(Plotted):
    def _columns(self):
        columns = {"time": self.time}
        for i, name in enumerate(self.coordinates):
            columns[name] = self.q[:, i]
            columns[name + ".speed"] = self.q_dot[:, i]
        for i, name in enumerate(self.muscles):
            columns[name + ".activation"] = self.activation[:, i]
            columns[name + ".fiber_length"] = self.fibre_length[:, i]
            columns[name + ".tendon_force"] = self.tendon_force[:, i]
        for name, values in self.reaction.items():
            columns[name + ".reaction"] = values
        return columns

    def _sentence(self):
        errors = [f"RMS error of {name} {value:.3g}" for name, value in {**self.rms_error, **self.channel_rms_error}.items()]
        return "; ".join([f"{self.outcome}, {self.steps} steps of {self.step:.3g} s"] + errors + [self.why] * bool(self.why))

    def plot(self, axes=None):
        above, below = axes = several_axes(axes, 2)
        for i, name in enumerate(self.coordinates):
            above.plot(self.time, self.q[:, i], label=name)
        for i, name in enumerate(self.muscles):
            below.plot(self.time, self.tendon_force[:, i], label=name)
        _labelled(above, "", "Coordinates [rad] or [m]")
        _labelled(below, "Time [s]", "Tendon forces [N]")
        return axes


class MomentArmsResult(Table):
    _indexed = False

    def _columns(self):
        columns = {f"{name}.length": self.length[:, i] for i, name in enumerate(self.muscles)}
        for coordinate, arms in self.moment_arm.items():
            for i, name in enumerate(self.muscles):
                columns[f"{name}.moment_arm.{coordinate}"] = arms[:, i]
        return columns


class EmgResult(Plotted):
    def _columns(self):
        return dict(self.columns)

    def plot(self, axes=None):
        axes = new_axes(axes)
        for name in self.muscles:
            axes.plot(self.columns["time"], self.columns[name], label=name)
        _labelled(axes, "Time [s]", "Excitation")
        return axes


class SensitivityResult(Plotted):
    def _columns(self):
        return {
            "name": self.names,
            "unit": self.units,
            "value": self.values,
            "prior_sd": self.prior_sd,
            "normalised_sensitivity": self.normalised_sensitivity,
            "bound_alone": self.bound_alone,
            "bound_joint": self.bound_joint,
            "identifiable": self.identifiable,
        }

    def _sentence(self):
        return " ".join(self.sentences)

    def plot(self, axes=None):
        axes = new_axes(axes)
        order = np.argsort(-np.abs(self.normalised_sensitivity))
        _bars(axes, [self.names[i] for i in order], np.abs(self.normalised_sensitivity)[order], "Normalised sensitivity")
        return axes


class ParameterSweepResult(Plotted):
    def _columns(self):
        columns = {"time": self.time, "nominal": self.nominal}
        for value, motion in zip(self.values, self.motions):
            # a motion that ends early has no values behind
            columns[f"{value:.6g}"] = np.concatenate([motion, np.full(len(self.time) - len(motion), np.nan)])
        return columns

    def _sentence(self):
        return f"{self.parameter}{f' [{self.unit}]' if self.unit else ''}, {self.model_value:.4g} in the model"

    def plot(self, axes=None):
        axes = new_axes(axes)
        for name, values in self._columns().items():
            if name != "time":
                axes.plot(self.time, values, label=name)
        _labelled(axes, "Time [s]", "Coordinate [rad] or [m]")
        axes.set_title(self._sentence(), fontsize="medium")
        return axes


class ProfileLikelihoodResult(Plotted):
    def _columns(self):
        return {self.parameter: self.values, "cost": self.costs, "converged": self.converged}

    def plot(self, axes=None):
        axes = new_axes(axes)
        axes.plot(self.values, self.costs, marker="o")
        axes.axhline(self.threshold, linestyle="--", color="grey")
        _labelled(axes, f"{self.parameter}{f' [{self.unit}]' if self.unit else ''}", "Cost [nats]")
        return axes


class GlobalSensitivityResult(Plotted):
    def _columns(self):
        columns = {"name": self.names}
        if self.morris is not None:
            columns |= {"morris.mean_absolute": self.morris.mean_absolute, "morris.sd": self.morris.sd}
        if self.sobol is not None:
            for name in ("first", "first_sd", "total", "total_sd"):
                columns["sobol." + name] = getattr(self.sobol, name)
        return columns

    def plot(self, axes=None):
        axes = new_axes(axes)
        if self.sobol is not None:
            _bars(axes, self.names, self.sobol.total, "Total index")
        else:
            _bars(axes, self.names, self.morris.mean_absolute, "Mean absolute elementary effect")
        return axes


class CostGradientResult(Table):
    def _columns(self):
        return {"name": self.names, "unit": self.units, "value": self.values, "gradient": self.gradient}

    def _sentence(self):
        return f"cost {self.cost:.6g}"


class PredictionResult(Table):
    _indexed = False

    def _columns(self):
        columns = {
            "trial": np.repeat(np.arange(len(self.times)), [len(one) for one in self.times]),
            "time": np.concatenate(self.times),
        }
        by_channel = [np.split(one, len(self.observed)) for one in self.outputs]
        for i, name in enumerate(self.observed):
            columns[name] = np.concatenate([one[i] for one in by_channel])
        return columns


class EnsembleResult(Plotted):
    _indexed = False

    def _columns(self):
        columns = {law.name: self.parameters[:, i] for i, law in enumerate(self.laws)}
        columns |= {"outcome": self.outcome, "failed_at": self.failed_at}
        for channel in self.channels:
            for name, values in channel.outputs.items():
                columns[f"{channel.name}.{name}"] = values
        return columns

    def _sentence(self):
        return f"{len(self.outcome)} draws of {len(self.laws)} parameters, {self.outcome.count('ok')} simulated to the end"

    def plot(self, axes=None):
        axes = several_axes(axes, len(self.channels))
        for panel, channel in zip(axes, self.channels):
            panel.fill_between(self.time, channel.band.p5, channel.band.p95, alpha=0.3, label="5 to 95 %")
            panel.plot(self.time, channel.band.p50, label="median")
            panel.plot(self.time, channel.band.nominal, linestyle="--", label="model")
            _labelled(panel, "Time [s]", f"{channel.name}{f' [{channel.unit}]' if channel.unit else ''}")
        return axes


class CompareResult(Plotted):
    _indexed = False

    def _columns(self):
        names = ("integrator", "step", "outcome", "rms_error", "max_error", "wall", "newton_per_step", "energy_error", "why")
        return {name: [getattr(run, name) for run in self.runs] for name in names}

    def _sentence(self):
        return f"reference {self.reference.status}"

    def plot(self, axes=None):
        axes = new_axes(axes)
        for name in dict.fromkeys(run.integrator for run in self.runs):
            runs = [run for run in self.runs if run.integrator == name and run.rms_error > 0]
            axes.loglog([run.step for run in runs], [run.rms_error for run in runs], marker="o", label=name)
        _labelled(axes, "Step [s]", "RMS error [rad]")
        return axes


class CalibrationResult(Plotted):
    def _columns(self):
        names = ("value", "unit", "sd", "lower", "upper", "model", "identifiable", "at_bound", "why")
        columns = {"name": list(self.estimates)}
        return columns | {name: [getattr(one, name) for one in self.estimates.values()] for name in names}

    def _sentence(self):
        words = [] if self.converged else ["not converged: " + self.why]
        if not math.isnan(self.rmse_before):
            words.append(f"RMS error {self.rmse_before:.3g} → {self.rmse_after:.3g} rad")
        if not math.isnan(self.rmse_held_out):
            words.append(f"held out {self.rmse_held_out_before:.3g} → {self.rmse_held_out:.3g} rad")
        return "; ".join(words)

    def plot(self, axes=None):
        axes = new_axes(axes)
        for i, one in enumerate(self.estimates.values()):
            if not (one.identifiable and 0 < one.sd < math.inf):
                continue
            change, ends = one.value - one.model, [[one.value - one.lower], [one.upper - one.value]]
            axes.errorbar([change / one.sd], [i], xerr=np.abs(ends) / one.sd, marker="o", color="C0", capsize=3)
        axes.set_yticks(range(len(self.estimates)), self.estimates)
        axes.set_ylim(len(self.estimates) - 0.5, -0.5)
        axes.axvline(0, linestyle="--", color="grey")
        axes.set_xlabel("Change from the model [standard deviations of the estimate]")
        return axes


class _Verdict(Plotted):
    def _columns(self):
        effects = self.effects
        words = [
            ", ".join(f"{name} = {_with_sd(one.value, one.sd, one.unit)}" for name, one in effect.parameters.items())
            for effect in effects
        ]
        columns = {name: [getattr(one, name) for one in effects] for name in ("id", "name", "kind")}
        return columns | {
            "parameters": words,
            "log_bayes_factor": [one.log_bayes_factor for one in effects],
            "probability": [one.probability for one in effects],
            "cannot_be_told_from": [", ".join(one.cannot_be_told_from) for one in effects],
        }

    def _sentence(self):
        return self.sentence

    def plot(self, axes=None):
        axes = new_axes(axes)
        gaps = {"training": self.gap} | ({"held out": self.gap_held_out} if self.gap_held_out is not None else {})
        steps = ("nominal", "calibrated", "after", "noise_floor")
        for k, (name, gap) in enumerate(gaps.items()):
            places = np.arange(len(steps)) + (k - (len(gaps) - 1) / 2) * 0.35
            axes.bar(places, [getattr(gap, step) for step in steps], width=0.35, label=name)
        axes.set_xticks(range(len(steps)), ["as given", "calibrated", "with the effect", "noise"])
        _labelled(axes, "", "RMS error")
        axes.set_title(self.sentence, fontsize="small", wrap=True)
        return axes


class DiscoveryResult(_Verdict):
    pass


class RobotDiscoveryResult(_Verdict):
    pass


class EffectList(Table):
    def _columns(self):
        columns = {name: [getattr(one, name) for one in self.effects] for name in ("id", "long_id", "name", "kind", "meaning")}
        columns["parameters"] = [
            ", ".join(f"{name} [{unit or '1'}]" for name, unit in one.parameters.items()) for one in self.effects
        ]
        return columns


class DesignResult(Plotted):
    def _columns(self):
        return {
            "name": self.names,
            "unit": self.units,
            "value": self.values,
            "of_interest": self.of_interest,
            "prior_sd": self.prior_sd,
            "bound_before": self.bound_before,
            "bound_after": self.bound_after,
        }

    def plot(self, axes=None):
        axes = new_axes(axes)
        for i, name in enumerate(self.observed):
            axes.plot(self.times, np.atleast_2d(self.predicted.T)[i], color=f"C{i}", label=name)
            axes.plot(self.times, np.atleast_2d(self.predicted_before.T)[i], color=f"C{i}", linestyle="--", label=name + ", before")
        _labelled(axes, "Time [s]", "What is observed")
        return axes


class DynamometerDesignResult(Table):
    _indexed = False

    def _columns(self):
        names = ("kind", "start", "end", "speed", "muscles", "effort", "load", "torque", "instruction", "information")
        return {name: [getattr(one, name) for one in self.experiments] for name in names}


class IdentifiabilityResult(Plotted):
    def _columns(self):
        return {"name": self.names, "value": self.values, "sd": self.sd, "identifiable": np.isfinite(self.sd)}

    def _sentence(self):
        return " ".join(self.sentences)

    def plot(self, axes=None):
        axes = new_axes(axes)
        image = axes.imshow(self.correlation, vmin=-1, vmax=1, cmap="RdBu_r")
        axes.set_xticks(range(len(self.names)), self.names, rotation=90)
        axes.set_yticks(range(len(self.names)), self.names)
        axes.figure.colorbar(image, ax=axes, label="Correlation")
        return axes


class EstimateResult(Table):
    def _columns(self):
        return {
            "name": self.names,
            "value": self.parameters,
            "sd": self.sd,
            "lower": self.intervals[:, 0],
            "upper": self.intervals[:, 1],
            "at_bound": self.at_bound,
        }

    def _sentence(self):
        return f"{'converged' if self.converged else 'not converged'}: {self.why}"


class MuscleStatesResult(Table):
    _indexed = False

    def _columns(self):
        return dict(vars(self))


class StudyRows(PlottedRows):
    def plot(self, axes=None):
        axes = new_axes(axes)
        names = ("rmse_before", "rmse_after", "rmse_held_out_before", "rmse_held_out")
        words = ("as given", "calibrated", "held out, as given", "held out, calibrated")
        for k, (name, word) in enumerate(zip(names, words)):
            axes.bar(np.arange(len(self)) + (k - 1.5) * 0.2, [getattr(row, name) for row in self], width=0.2, label=word)
        axes.set_xticks(range(len(self)), [row.subject for row in self])
        _labelled(axes, "", "RMS error [rad]")
        return axes
