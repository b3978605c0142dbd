# %% [markdown]
# # FisherHill from Python
#
# Run it: `PYTHONPATH=build/python/python python3 python/tour.py`, or, once the package is installed, without the
# `PYTHONPATH`. Editors that know cells (`# %%`) show it as a notebook. Everything is in SI units and radians; arrays have one row per time.

# %%
import pathlib

import numpy as np

import fisherhill as fh

# the source tree; cells are run in it
tree = pathlib.Path(globals().get("__file__", "python/tour.py")).resolve().parents[1]
degrees = 180 / np.pi

# %% [markdown]
# ## A muscle model plays a trial

# %%
model = fh.load_model(tree / "models/elbow8.osim")
trial = fh.load_trial(tree / "emg_data/curl_slow.sto", model)
motion = fh.replay(model, trial)
print(model, trial)
print(f"{motion.steps} steps, final angle {motion.q[-1, 0] * degrees:.1f} deg,",
      f"{motion.rms_error['elbow_flexion'] * degrees:.1f} deg RMS from what was measured")
strongest = motion.muscles[np.argmax(motion.tendon_force.max(axis=0))]
print(f"strongest pull: {strongest}, {motion.tendon_force.max():.0f} N")
assert motion.outcome == "ok"

# %% [markdown]
# ## What would the measured angle tell about parameters?

# %%
names = ["TRI.radius", "hand.mass", "BRA.max_isometric_force"]
told = fh.sensitivity(model, [trial], names, noise=1 / degrees)
for name, value, unit, bound, known in zip(told.names, told.values, told.units, told.bound_joint, told.identifiable):
    print(f"{name:26} {value:9.4g} {unit:3} ± {bound:.2g}  {'identifiable' if known else 'not identifiable'}")
assert told.fisher.shape == (3, 3)
more = fh.sensitivity(model, [trial], names, noise=1 / degrees, further_channels=True).further_channels[0]
print(f"measured beside the angle, {more.channel} (± {more.noise} {more.unit}) would tell most:",
      f"{more.parameter} to ± {more.bound_after:.2g} instead of ± {more.bound_before:.2g}")

# %% [markdown]
# ## What should a dynamometer do to tell more?

# %%
plan = fh.design_on_dynamometer(model, "elbow_flexion", ["BRA.max_isometric_force"], experiments=2, threads=2)
for one in plan.experiments:
    print(f"{one.kind}, then ± {one.bounds[0]:.2g} N: {one.instruction}")
assert plan.bound_after[0] < plan.bound_before[0]

# %% [markdown]
# ## Let the data say what they are, and test on another trial

# %%
fast = fh.load_trial(tree / "emg_data/curl_fast.sto", model)
fit = fh.calibrate(model, [trial], ["TRI.radius", "hand.mass"], hold_out=[fast])
for name, fitted in fit.estimates.items():
    print(f"{name:12} {fitted.model:.4g} -> {fitted.value:.4g} ± {fitted.sd:.2g} {fitted.unit}")
print(f"fitted trial {fit.rmse_before * degrees:.1f} -> {fit.rmse_after * degrees:.1f} deg,",
      f"held out {fit.rmse_held_out_before * degrees:.1f} -> {fit.rmse_held_out * degrees:.1f} deg")
assert fit.rmse_after < fit.rmse_before

# %% [markdown]
# ## Or is it not the parameters: what does the model lack?

# %%
hidden = fh.load_trial(tree / "emg_data/hidden_a/train_1.sto", model)
found = fh.discover(model, [hidden], noise=0.5 / degrees, max_effects=1)
print(found.sentence)
for effect in found.effects:
    for name, value in effect.parameters.items():
        print(f"  {effect.name}: {name} = {value.value:.3g} ± {value.sd:.2g} {value.unit}")
assert found.verdict == "named" and found.effects[0].id == "visc"

# %% [markdown]
# ## A system of your own
#
# A mass on a spring that hardens, x″ = −k x − h x³ − c x′, let go at 0.5 m; its position is measured. Nothing here
# knows of muscles.

# %%
times = np.linspace(0, 4, 81)
spring = fh.System(
    f=lambda x, u, theta, t: [x[1], -theta[0] * x[0] - theta[1] * x[0] ** 3 - theta[2] * x[1]],
    x0=[0.5, 0.0], times=times,
    g=lambda x, u, theta: x[:1],
    f_x=lambda x, u, theta, t: [[0, 1], [-theta[0] - 3 * theta[1] * x[0] ** 2, -theta[2]]],
    f_theta=lambda x, u, theta, t: [[0, 0, 0], [-x[0], -x[0] ** 3, -x[1]]],
    g_x=lambda x, u, theta: [[1, 0]], g_theta=lambda x, u, theta: [[0, 0, 0]],
    substeps=2)
truth, noise = np.array([10.0, 20.0, 0.4]), 0.01

# %% [markdown]
# The Cramér–Rao bound says, before anything is measured, how well the best estimator can do.

# %%
information = fh.fisher_information(spring.sensitivities(truth), noise)
bound = np.sqrt(np.diag(fh.cramer_rao_bound(information, ["k", "h", "c"])))
print("best possible deviations of k, h, c:", np.round(bound, 3))
print(fh.identifiability(information, truth, ["k", "h", "c"]).sentences[0])

# %% [markdown]
# And a measurement, with an estimate from it that is as good as that.

# %%
random = np.random.default_rng(7)
measured = spring(truth) + noise * random.standard_normal((81, 1))
estimate = fh.estimate(spring, measured, noise, [8.0, 15.0, 0.5], names=["k", "h", "c"], bounds={"c": (0, 10)})
for name, value, (low, high) in zip(estimate.names, estimate.parameters, estimate.intervals):
    print(f"{name} = {value:.3f}, 95 % between {low:.3f} and {high:.3f}")
assert estimate.converged and np.all(np.abs(estimate.parameters - truth) < 4 * bound)
