#!/usr/bin/env python3
"""discover on sets that OpenSim made, verdict beside truth, as a table.

    python3 validation/discovery/opensim_sets.py [--build build/program] [--only NAME ...] [--limit 600] SETS MODELS FOLDER

SETS: folders a … h, arm26_a … f, leg_a … d, millard_a, b and dyn_a … e of trials trial_0 …; the last trial is held out. MODELS: folder with
reference/elbow8_reference.osim and data/models/opensim. Results go to FOLDER/NAME. "right": what is hidden, or a class that holds it, and nothing else;
"part": one of two hidden effects; "unnamed": no name, though something is hidden; "wrong": another name. --limit: seconds for one set. The agreement of
inputs is the correlation of the muscles' moments with those that the motion requires.
Exit status 1: a wrong name.
"""
import argparse
import json
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


def looked_at(program, sets, models, folder, name, limit):
    model, options = WORLDS[name.rpartition("_")[0]]
    trials = sorted(path for path in (sets / name).iterdir() if path.stem.startswith("trial_"))
    ran = subprocess.run([program, "discover", models / model, *trials[:-1], "--hold-out", trials[-1], *options, "--time-limit", str(limit),
                          "--out", folder / name, "--force"], capture_output=True, text=True, check=False)
    if not (folder / name / "verdict.json").exists():
        sys.exit(f"{name}: {ran.stderr}")
    return json.loads((folder / name / "verdict.json").read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sets", type=pathlib.Path)
    parser.add_argument("models", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--build", default="build/program")
    parser.add_argument("--only", nargs="+", choices=list(HIDDEN), default=list(HIDDEN))
    parser.add_argument("--limit", type=float, default=600)
    asked = parser.parse_args()
    program = (TOP / asked.build / "apps/fisherhill").resolve()
    asked.folder.mkdir(parents=True, exist_ok=True)
    counts = {}
    print("| set | hidden | verdict | | agreement of inputs | processor s |\n|---|---|---|---|---|---|", flush=True)
    for name in asked.only:
        verdict = looked_at(program, asked.sets, asked.models, asked.folder, name, asked.limit)
        truth, hidden = HIDDEN[name]
        outcome = judged(hidden, verdict)
        counts[outcome] = counts.get(outcome, 0) + 1
        print(f"| {name} | {truth} | {verdict['sentence'].split('. ')[0]} | {outcome} | {verdict['input_agreement']['correlation'] or float('nan'):.2f} | "
              f"{verdict['processor_s']:.0f} |", flush=True)
    print(", ".join(f"{count} {outcome}" for outcome, count in sorted(counts.items())))
    sys.exit(1 if counts.get("wrong") else 0)


if __name__ == "__main__":
    main()
