#!/usr/bin/env python3
"""Simulates every model of a folder for 1 s, as a table in Markdown.

    every_model.py FISHERHILL MODELS

FISHERHILL is the program, MODELS a folder of .osim files, searched with its subfolders. All muscles
have an excitation of 0.05; coordinates of the pelvis, of a body against the ground and of the
thorax are locked at 0, all others are free and start at rest at the model's defaults. Of the
MoBL-ARMS models seven coordinates are free, the elbow starts at 70 degrees, and the motions at
0.01 s and 0.0025 s are compared with CVODE's.
"""
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

MUSCLES = ("Schutte1993Muscle_Deprecated", "Thelen2003Muscle", "Millard2012EquilibriumMuscle",
           "DeGrooteFregly2016Muscle", "RigidTendonMuscle")
LOCKED = re.compile(r"pelvis_|ground_|[rt]_[xyz]$")
SEVEN = ["elv_angle", "shoulder_elv", "shoulder_rot", "elbow_flexion", "pro_sup", "deviation",
         "flexion"]


def names(text, classes):
    found = re.findall(r'<(?:%s) name="([^"]+)"' % "|".join(classes), text)
    return [name for name in dict.fromkeys(found) if name != "default"]


def replay(program, model, trial, out, options):
    """Status, or why there is none, what is said of it, and the wall time [s]."""
    done = subprocess.run([program, "replay", model, trial, "--out", out, "--force", "--json"] + options,
                          capture_output=True, text=True, check=False)
    try:
        summary = json.loads(done.stdout)
    except json.JSONDecodeError:
        return "refused", done.stderr.strip().splitlines()[-1].split(": ", 2)[-1], None
    return summary["status"], summary.get("left_range", ""), summary["wall_s"]


def coordinates(folder):
    lines = (pathlib.Path(folder) / "states.sto").read_text(encoding="utf-8").splitlines()
    head = lines.index("endheader")
    columns = lines[head + 1].split("\t")
    rows = {}
    for line in lines[head + 2:]:
        cells = [float(x) for x in line.split("\t")]
        rows[round(cells[0], 6)] = [c for name, c in zip(columns, cells) if name.endswith("/value")]
    return rows


def furthest(one, other):
    """Largest difference of a coordinate at common times [deg]."""
    return max(57.29577951308232 * abs(a - b) for t in one.keys() & other.keys()
               for a, b in zip(one[t], other[t]))


def main():
    program, folder = sys.argv[1:]
    print("| model | status | |\n|---|---|---|")
    for model in sorted(pathlib.Path(folder).rglob("*.osim")):
        text = model.read_text(encoding="utf-8", errors="ignore")
        muscles = names(text, MUSCLES)
        if not muscles:
            print(f"| {model.stem} | no muscles | |")
            continue
        with tempfile.TemporaryDirectory() as scratch:
            trial = f"{scratch}/trial.csv"
            with open(trial, "w", newline="", encoding="utf-8") as file:
                rows = csv.writer(file)
                rows.writerow(["time"] + muscles)
                rows.writerows([k / 100] + [0.05] * len(muscles) for k in range(101))
            locks = [word for name in names(text, ["Coordinate"]) if LOCKED.match(name)
                     for word in ("--lock", f"{name}=0")]
            status, why, _ = replay(program, model, trial, f"{scratch}/out", locks)
            print(f"| {model.stem} | {status} | {why} |", flush=True)
            if not model.stem.startswith("MoBL"):
                continue
            free = [word for name in SEVEN for word in ("--coordinate", name)]
            free += ["--initial", "elbow_flexion=70deg"]
            replay(program, model, trial, f"{scratch}/cvode", free + ["--integrator", "cvode"])
            for step in ("0.01", "0.0025"):
                status, _, wall = replay(program, model, trial, f"{scratch}/{step}", free + ["--step", step])
                off = furthest(coordinates(f"{scratch}/{step}"), coordinates(f"{scratch}/cvode"))
                print(f"| {model.stem}, seven coordinates, {step} s | {status} | {off:.2g}° from CVODE,"
                      f" {wall:.2g} s |", flush=True)


if __name__ == "__main__":
    main()
