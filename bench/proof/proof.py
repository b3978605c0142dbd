#!/usr/bin/env python3
"""The table of proof: time to a stated error, FisherHill's integrators beside OpenSim's, one thread.

    bench/proof/proof.py PROGRAM [--beside PROGRAM] [--rounds N] [--shared DIR] [--out DIR] [--bench sensitivity_bench] [--ranks]
        [--mujoco MYO_SIM]

PROGRAM is `build/program/apps/fisherhill`. Every motion is simulated by `fisherhill compare`, which measures error and
time of each integrator and step against a converged reference; a time is the median of the rounds; one between two steps of `vi`
or `rk4` lies on the line between them, of `vi-adaptive` the longest of the steps counts from which on no shorter one has a
larger error. `--beside` measures
another build of the program in alternation with it. OpenSim's times are those of opensim.csv: OpenSim 4.6, measured on
2026-11-27 on a machine of this class, beside FisherHill's commit 501a1df, which is what to build for `--beside`. Written are proof.csv (all runs),
proof.md (the tables) and, with matplotlib, proof.svg. `--bench` adds derivatives beside differences (built with FISHERHILL_BENCH), `--ranks` ensembles over
MPI ranks, `--mujoco` MuJoCo's times for arm26's elbow as MyoSim has converted it (github.com/MyoHub/myo_sim; Debian package libmujoco-dev). Motions of models that lie in `--shared` (default ../shared) are
left out where it is missing.
"""

import argparse
import csv
import datetime
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

from further import derivatives, mujoco_runs, scaling

here = pathlib.Path(__file__).resolve().parent
top = here.parents[1]
STEPS = {"vi": [0.001, 0.0025, 0.005, 0.01, 0.02],
         "vi-adaptive": [0.0025, 0.005, 0.0075, 0.01, 0.0125, 0.015, 0.02, 0.03, 0.04, 0.05], "rk4": [0.0001, 0.0002, 0.0004], "cvode": [0.01]}
NOT_STATED = 0.01  # is what OpenSim's errors that nobody stated are taken to be [deg]
DEFAULT = ("vi", 0.01)  # the program's integrator and step [s]


class Motion:
    def __init__(self, name, words, model, trial, start):
        self.name, self.words, self.model, self.trial, self.start = name, words, model, trial, start

    def exists(self):
        return self.model.exists() and self.trial.exists()


def starts(table):
    """{coordinate: value} of the first row of a motion that OpenSim computed, without kneecaps, which follow the knee."""
    with open(table, encoding="utf-8") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        first = next(rows)
    return {name[: -len("_value")]: float(first[name]) for name in first if name.endswith("_value") and "_pat_" not in name}


def motions(shared):
    models, reference = shared / "data/models/opensim", shared / "reference/opensim"

    def of(name, words, model, motion):
        file = reference / f"forward_{motion}.csv"
        number = motion.split("_")
        excitations = {"elbow8": f"excitations_elbow8_{number[-1]}.sto"}.get(number[0], f"excitations_{motion}.sto")
        return Motion(name, words, models / model, reference / excitations, starts(file) if file.exists() else {})

    return [
        Motion("elbow", "elbow, 8 muscles (Schutte), 4.5 s", top / "models/elbow8.osim", top / "emg_data/curl_slow.sto", {}),
        of("elbow_millard", "elbow, 8 muscles (Millard)", "elbow8_Millard.osim", "elbow8_Millard_201"),
        of("arm26_elbow", "arm26, elbow, 6 muscles (Thelen), 2 s", "arm26.osim", "arm26_elbow_301"),
        of("arm26", "arm26, shoulder and elbow, 1.5 s", "arm26.osim", "arm26_311"),
        of("leg6", "leg6dof9musc, hip, knee, ankle, 0.8 s", "leg6dof9musc.osim", "leg6_341"),
        of("gait10", "gait10dof18musc, hip, knee, ankle, 0.8 s", "gait10dof18musc.osim", "gait10_351"),
    ]


def measured(program, motion, integrators=STEPS):
    """Rows of compare: (integrator, step) -> (RMS error [deg], time [ms])."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for integrator in integrators:
            steps = STEPS[integrator]
            out = pathlib.Path(folder) / integrator
            words = [program, "compare", motion.model, motion.trial, "--integrators", integrator, "--steps", ",".join(map(str, steps)),
                     "--ignore-extra", "--threads", "1", "--out", out]
            for coordinate, value in motion.start.items():
                words += ["--coordinate", coordinate, "--initial", f"{coordinate}={value!r}"]
            run = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False)
            if run.returncode not in (0, 1):
                raise RuntimeError(f"{motion.name}: {run.stderr.strip()}")
            if not (out / "compare.csv").exists():
                continue
            with open(out / "compare.csv", encoding="utf-8") as file:
                for row in csv.DictReader(file):
                    if row["status"] == "ok":
                        found[integrator, float(row["step_s"])] = (float(row["rms_deg"]), float(row["wall_ms"]))
    return found


def to_error(runs, integrator, error):
    """Least time of an integrator whose error is no larger, along the line between its runs; None: it has no such run."""
    own = sorted(((e, t) for (name, _), (e, t) in runs.items() if name == integrator and t > 0), reverse=True)
    inside = [t for e, t in own if e <= error]
    for (e1, t1), (e2, t2) in zip(own, own[1:]):
        if e1 > error >= e2 > 0:
            share = math.log(e1 / error) / math.log(e1 / e2)
            inside.append(t1 * (t2 / t1) ** share)
    return min(inside) if inside else None


def by_longest_step(runs, integrator, error):
    """Time of the longest step that has no larger error, and no shorter one has; None: there is none. For an integrator
    whose error does not fall evenly with the step, so that nothing can be said between its runs."""
    time = None
    for (name, _), (e, t) in sorted(runs.items(), key=lambda run: run[0][1]):
        if name != integrator:
            continue
        if e > error:
            break
        time = t
    return time


def median_runs(rounds):
    return {key: tuple(statistics.median(one[key][i] for one in rounds if key in one) for i in (0, 1)) for key in rounds[0]}


def cell(number):
    return "–" if number is None else f"{number:.3g}"


def times_as_fast(low, high, time):
    if time is None:
        return "–"
    return f"{low / time:.0f}" if low == high else f"{low / time:.0f}–{high / time:.0f}"


def table(results, opensim):
    text = ("| motion | OpenSim | its time [ms] | at an error of [deg] | vi [ms] | times as fast | vi-adaptive [ms] | times as fast | rk4 [ms] | cvode [ms] |\n"
            "|---|---|---|---|---|---|---|---|---|---|\n")
    for motion, runs, _ in results:
        for row in (row for row in opensim if row["motion"] == motion.name):
            error = float(row["error_deg"] or NOT_STATED)
            low, high = float(row["least_ms"]), float(row["most_ms"])
            vi, adaptive = to_error(runs, "vi", error), by_longest_step(runs, "vi-adaptive", error)
            text += (f"| {motion.words} | {row['integrator']} {row['accuracy']} | {low:g}{'' if low == high else f'–{high:g}'} | "
                     f"{error:g}{'' if row['error_deg'] else ' (not stated)'} | {cell(vi)} | {times_as_fast(low, high, vi)} | {cell(adaptive)} | {times_as_fast(low, high, adaptive)} | "
                     f"{cell(to_error(runs, 'rk4', error))} | "
                     f"{cell(to_error(runs, 'cvode', error))} |\n")
    return text


def beside_table(results):
    if not any(before for _, _, before in results):
        return ""
    text = "\nThe same program and the one beside it, in alternation, vi at 0.01 s:\n\n| motion | time [ms] | beside [ms] | ratio |\n|---|---|---|---|\n"
    for motion, runs, before in results:
        if before and DEFAULT in before and DEFAULT in runs:
            text += f"| {motion.words} | {runs[DEFAULT][1]:.3g} | {before[DEFAULT][1]:.3g} | {runs[DEFAULT][1] / before[DEFAULT][1]:.2f} |\n"
    return text


def mujoco_table(results, myo_sim):
    """arm26's elbow: times to errors from each program's own converged motion."""
    motion, own, _ = next(result for result in results if result[0].name == "arm26_elbow")
    runs, head = mujoco_runs(myo_sim, motion)
    errors = [0.05, 0.01, 0.005]
    text = (f"\n{motion.words}, beside {head.split(',')[0]} and MyoSim's conversion of the model, whose tendons are rigid and whose joint has an armature of 0.01 kg m² and a damping of 0.5 N m s: "
            "errors from each program's own converged motion.\n\n"
            f"| integrator | {' | '.join(f'to {error:g}° [ms]' for error in errors)} |\n|---|{'---|' * len(errors)}\n")
    for words, of, names in (("FisherHill", own, ("vi", "vi-adaptive")), ("MuJoCo", runs, ("Euler", "implicit", "RK4"))):
        for name in names:
            find = by_longest_step if name == "vi-adaptive" else to_error
            text += f"| {words} {name} | {' | '.join(cell(find(of, name, error)) for error in errors)} |\n"
    return text


def plot(results, opensim, path):
    try:
        import matplotlib
        matplotlib.use("svg")
        import matplotlib.pyplot as plt
    except ImportError:
        return False
    figure, axes = plt.subplots(2, 3, figsize=(11, 6.5), sharey=True)
    marks = {"vi": ("o-", "#0072b2"), "vi-adaptive": ("v-", "#e69f00"), "rk4": ("s-", "#009e73"), "cvode": ("^", "#56b4e9")}
    for axis, (motion, runs, _) in zip(axes.flat, results):
        for integrator, (mark, colour) in marks.items():
            own = sorted((e, t) for (name, _), (e, t) in runs.items() if name == integrator and e > 0)
            if own:
                axis.loglog([e for e, _ in own], [t for _, t in own], mark, color=colour, label=f"FisherHill {integrator}")
        for integrator, colour in (("CPodes", "#d55e00"), ("RungeKuttaMerson", "#cc79a7")):
            own = [row for row in opensim if row["motion"] == motion.name and row["integrator"] == integrator and row["error_deg"]]
            if own:
                axis.loglog([float(row["error_deg"]) for row in own], [float(row["least_ms"]) for row in own], "D", color=colour, label=f"OpenSim {integrator}")
        axis.set_title(motion.words, fontsize=9)
        axis.grid(True, alpha=0.3)
        axis.set_xlabel("RMS error [deg]")
    for axis in axes[:, 0]:
        axis.set_ylabel("time [ms]")
    labels = {}
    for axis in axes.flat:
        labels.update(dict(zip(*axis.get_legend_handles_labels()[::-1])))
    figure.legend(labels.values(), labels.keys(), loc="lower center", ncol=5, fontsize=9)
    figure.tight_layout(rect=(0, 0.06, 1, 1))
    figure.savefig(path)
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--beside", help="another build, measured in alternation")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--shared", type=pathlib.Path, default=top / "../shared")
    parser.add_argument("--only", help="name of one motion")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/proof"))
    parser.add_argument("--bench", type=pathlib.Path, help="the program sensitivity_bench")
    parser.add_argument("--ranks", action="store_true", help="ensembles over MPI ranks")
    parser.add_argument("--mujoco", type=pathlib.Path, help="folder of MyoSim")
    words = parser.parse_args()
    with open(here / "opensim.csv", encoding="utf-8") as file:
        opensim = list(csv.DictReader(file))
    results = []
    for motion in motions(words.shared.resolve()):
        if words.only not in (None, motion.name):
            continue
        if not motion.exists():
            print(f"left out, no file {motion.model}", file=sys.stderr)
            continue
        now, before = [], []
        for _ in range(words.rounds):
            now.append(measured(words.program, motion))
            if words.beside:
                before.append(measured(words.beside, motion, ["vi"]))
        results.append((motion, median_runs(now), median_runs(before) if before else None))
        print(f"{motion.name}: {results[-1][1].get(DEFAULT)}", file=sys.stderr)
    if not results:
        print("proof.py: no motion to measure", file=sys.stderr)
        return 1
    words.out.mkdir(parents=True, exist_ok=True)
    with open(words.out / "proof.csv", "w", encoding="utf-8") as file:
        file.write("motion,integrator,step_s,rms_deg,wall_ms\n")
        for motion, runs, _ in results:
            for (integrator, step), (error, time) in sorted(runs.items()):
                file.write(f"{motion.name},{integrator},{step:g},{error:.6g},{time:.6g}\n")
    load = os.getloadavg()[0]
    head = f"{datetime.date.today()}, {os.cpu_count()} cores, load {load:.2f}, medians of {words.rounds} rounds, one thread.\n\n"
    text = head + table(results, opensim) + beside_table(results)
    if words.mujoco:
        text += mujoco_table(results, words.mujoco.resolve())
    if words.bench:
        text += derivatives(words.bench.resolve())
    if words.ranks:
        text += scaling(pathlib.Path(words.program).resolve())
    (words.out / "proof.md").write_text(text, encoding="utf-8")
    print(text)
    if not plot(results, opensim, words.out / "proof.svg"):
        print("no plot: apt-get install python3-matplotlib", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
