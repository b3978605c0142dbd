#!/usr/bin/env python3
"""discover on sets that OpenSim made, verdict beside truth, as a table.

    python3 validation/discovery/opensim_sets.py [--build build/program] [--only NAME ...] [--limit 600] [--spoil KIND ...] SETS MODELS FOLDER

SETS: folders a … h, arm26_a … f, leg_a … d, millard_a, b and dyn_a … e of trials trial_0 …; the last trial is held out. MODELS: folder with
reference/elbow8_reference.osim and data/models/opensim. Results go to FOLDER/NAME. "right": what is hidden, or a class that holds it, and nothing else;
"part": one of two hidden effects; "unnamed": no name, though something is hidden; "wrong": another name. --limit: seconds for one set. The agreement of
inputs is the correlation of the muscles' moments with those that the motion requires.

--spoil: the sets with recordings that contradict themselves: "sign" of the first angle reversed, "signs" of all angles and moments, "unit" of the first angle
taken for degrees though it is in radians, "supplement" 180° less the first angle, "shift" of the motion by 0.8 s, and the motion of another "trial".
"contradiction": said so; "named": an effect, with a probability; "unnamed": neither.
Exit status 1: a wrong name, or a name for what is spoiled.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
ELBOW = "reference/elbow8_reference.osim"
MODELS = "data/models/opensim/"
WORLDS = {
    "arm26": (MODELS + "arm26.osim", ["--coordinate", "r_shoulder_elev", "--coordinate", "r_elbow_flex"]),
    "leg": (MODELS + "gait10dof18musc.osim", ["--coordinate", "knee_angle_r", "--coordinate", "ankle_angle_r", "--lock", "hip_flexion_r=1.1"]),
    "millard": (MODELS + "elbow8_Millard.osim", []),
    "dyn": (ELBOW, ["--prescribe", "elbow_flexion"]),
    "": (ELBOW, []),
}
# what is hidden; for each effect the ids that say it
HIDDEN = {
    "a": ("damping 0.3 N m s/rad and 0.5 kg in the hand", [{"visc"}, {"payload", "mass"}]),
    "b": ("exponential joint limits", [{"limit_exp", "limit"}]),
    "c": ("excitations 80 ms late", [{"delay", "clock"}]),
    "d": ("Coulomb friction 0.4 N m and gravity tilted by 12°", [{"coulomb"}, {"tilt", "handforce"}]),
    "e": ("radius of the triceps' cylinder 22 for 16 mm", [{"wrap_TRI"}]),
    "f": ("radius of the triceps' cylinder 21 for 16 mm", [{"wrap_TRI"}]),
    "g": ("records of BRA and BRD exchanged", [{"swap_BRA_BRD"}]),
    "h": ("angle's clock 2 % fast", [{"clock_rate"}]),
    "arm26_a": ("nothing", []),
    "arm26_b": ("damping 0.4 N m s/rad at the elbow", [{"r_elbow_flex.visc"}]),
    "arm26_c": ("0.25 kg in the hand", [{"payload", "mass"}]),
    "arm26_d": ("shoulder angle read 7° too large", [{"r_shoulder_elev.bias"}]),
    "arm26_e": ("BIClong 1.7 times as strong", [{"Fmax_BIClong", "gain_BIClong", "Fmax_BIC", "gain_BIC"}]),
    "arm26_f": ("Coulomb friction 1.5 N m at the shoulder", [{"r_shoulder_elev.coulomb"}]),
    "leg_a": ("nothing", []),
    "leg_b": ("damping 1 N m s/rad at the knee", [{"knee_angle_r.visc"}]),
    "leg_c": ("1 kg on the foot", [{"payload", "mass"}]),
    "leg_d": ("knee angle read 6° too large", [{"knee_angle_r.bias"}]),
    "millard_a": ("nothing", []),
    "millard_b": ("Coulomb friction 0.4 N m", [{"coulomb"}]),
    "dyn_a": ("nothing", []),
    "dyn_b": ("BRA 1.6 times as strong", [{"Fmax_BRA", "gain_BRA"}]),
    "dyn_c": ("moment read 1.2 N m too small", [{"bias", "const"}]),
    "dyn_d": ("damping 0.5 N m s/rad", [{"visc"}]),
    "dyn_e": ("tendon slack length of the triceps 4 % too long", [{"lslack_TRI", "lslack_TRIlong", "lslack_TRIlat", "lslack_TRImed"}]),
}


def judged(hidden, verdict):
    named = [effect["id"] for effect in verdict["effects"]] if verdict["verdict"] != "unknown" else []  # else the closest match
    if not hidden:
        return "wrong" if named else "right"
    if not named:
        return "unnamed"
    for name in named:
        if not any(name in effect or (len(hidden) == 1 and set(verdict["class"]) & effect) for effect in hidden):
            return "wrong"
    return "right" if len(named) >= len(hidden) else "part"


def table(path):
    """Column names, and rows of numbers."""
    lines = path.read_text().splitlines()
    begin = lines.index("endheader") + 1 if path.suffix == ".sto" else 0
    split = (lambda line: line.split("\t")) if path.suffix == ".sto" else (lambda line: line.split(","))
    return split(lines[begin]), [[float(x) for x in split(line)] for line in lines[begin + 1:] if line.strip()]


def spoilt(kind, names, rows, others):
    """Rows of a trial that contradict themselves; others: those of another trial. None if there is one measured column where all are asked for."""
    angles = [k for k, name in enumerate(names) if name.endswith("_deg")]
    measured = angles + [k for k, name in enumerate(names) if name.endswith(".moment")]
    if kind == "signs" and len(measured) == 1:
        return None
    if kind == "shift":
        return [[late[k] if k in measured else x for k, x in enumerate(row)] for row, late in zip(rows, rows[80:])]
    if kind == "trial":
        return [[other[k] if k in measured else x for k, x in enumerate(row)] for row, other in zip(rows, others)]
    change = {"sign": lambda x: -x, "signs": lambda x: -x, "unit": math.radians, "supplement": lambda x: 180 - x}[kind]
    return [[change(x) if k in (measured if kind == "signs" else angles[:1]) else x for k, x in enumerate(row)] for row in rows]


def spoilt_trials(kind, trials, folder):
    """The trials with this kind of contradiction, written to a folder; none where the kind does not apply."""
    tables = [table(path) for path in trials]
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for i, (names, rows) in enumerate(tables):
        changed = spoilt(kind, names, rows, tables[(i + 1) % len(tables)][1])
        if changed is None:
            return []
        written.append(folder / f"trial_{i}.csv")
        written[-1].write_text(",".join(names) + "\n" + "".join(",".join(f"{x:.8g}" for x in row) + "\n" for row in changed))
    return written


def trials_of(folder):
    return sorted(path for path in folder.iterdir() if path.stem.startswith("trial_"))


def looked_at(program, model, options, trials, folder, limit):
    ran = subprocess.run([program, "discover", model, *trials[:-1], "--hold-out", trials[-1], *options, "--time-limit", str(limit),
                          "--out", folder, "--force"], capture_output=True, text=True, check=False)
    if not (folder / "verdict.json").exists():
        sys.exit(f"{folder.name}: {ran.stderr}")
    return json.loads((folder / "verdict.json").read_text())


def shown_error(verdict):
    """The error of the held-out trial, over the noise."""
    held_out = verdict["gap"].get("held_out") or {}
    after, floor = ([x for key, x in held_out.items() if key.startswith(begin)] for begin in ("rmse_after_", "noise_floor_"))
    return f"{after[0] / floor[0]:.1f}" if after and after[0] is not None else "–"


def row(name, truth, verdict, outcome):
    agreement = verdict["input_agreement"]["correlation"]
    sentence = verdict["sentence"].split(". ")[0].rstrip(".")
    return (f"| {name} | {truth} | {sentence} | {outcome} | {'–' if agreement is None else f'{agreement:.2f}'} | {shown_error(verdict)} | "
            f"{verdict['processor_s']:.0f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sets", type=pathlib.Path)
    parser.add_argument("models", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--build", default="build/program")
    parser.add_argument("--only", nargs="+", choices=list(HIDDEN), default=list(HIDDEN))
    parser.add_argument("--limit", type=float, default=600)
    parser.add_argument("--spoil", nargs="+", choices=("sign", "signs", "unit", "supplement", "shift", "trial"), default=[])
    asked = parser.parse_args()
    program = (TOP / asked.build / "apps/fisherhill").resolve()
    asked.folder.mkdir(parents=True, exist_ok=True)
    counts = {}

    def tell(name, truth, verdict, outcome):
        counts[outcome] = counts.get(outcome, 0) + 1
        print(row(name, truth, verdict, outcome), flush=True)

    print("| set | hidden | verdict | outcome | agreement of inputs | held-out error / noise | processor [s] |\n|---|---|---|---|---|---|---|", flush=True)
    for name in asked.only:
        model, options = WORLDS[name.rpartition("_")[0]]
        trials = trials_of(asked.sets / name)
        truth, hidden = HIDDEN[name]
        for kind in asked.spoil:
            if changed := spoilt_trials(kind, trials, asked.folder / f"{name}-{kind}-trials"):
                verdict = looked_at(program, asked.models / model, options, changed, asked.folder / f"{name}-{kind}", asked.limit)
                named = verdict["verdict"] != "unknown" and verdict["effects"] and not verdict["probability_vetoed"]
                tell(name, f"{truth}; {kind}", verdict, "contradiction" if verdict["input_agreement"]["remedies"] else "named" if named else "unnamed")
        if not asked.spoil:
            verdict = looked_at(program, asked.models / model, options, trials, asked.folder / name, asked.limit)
            tell(name, truth, verdict, judged(hidden, verdict))
    print(", ".join(f"{count} {outcome}" for outcome, count in sorted(counts.items())))
    sys.exit(1 if counts.get("wrong") or counts.get("named") else 0)


if __name__ == "__main__":
    main()
