#!/usr/bin/env python3
"""Real pendulums of one, two or three arms that swing freely: what does the authors' model lack?

    python3 validation/real/free_pendulum.py [--arms 1] [--build build/program] [--step 0.001] [--seconds S] [--heavier 1] [--fit id_1 id_3] [--hold-out val_1] [--noise-deg D] [--baseline] RECORDINGS FOLDER

RECORDINGS: single_id_1.csv, double_id_1.csv … of the MultiArm-Pendulum of the University of Washington (github.com/dynamicslab/MultiArm-Pendulum, MIT licence), columns time and
phi1_rad, … with 0 upwards, each from the vertical. The model is the authors' without its friction: masses, their centres, inertias and lengths that they estimated. Used are 100 rows per second of one
arm and 200 of two and three. Each later angle is that from the arm before. --heavier: the model's masses and inertias times this, which its free swing cannot show. --baseline: estimate mass,
its centre, inertia and viscosity of each arm of the authors' model by least squares on the same trials instead. Exit status: that of the program.
"""
import argparse
import math
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "discovery"))
import mechanisms  # pylint: disable=wrong-import-position

TOP = pathlib.Path(__file__).resolve().parents[2]
ARMS = {  # (mass [kg], its centre [m] from the joint, inertia about that [kg m^2], length [m], viscosity [N m s/rad]), as the authors estimated
    1: [(0.1478, 0.1476, 1.09e-4, 0, 2.24e-4)],
    2: [(0.0938, 0.1086, 4.4e-4, 0.1727, 2.4e-4), (0.1376, 0.1168, 1.27e-3, 0, 1e-5)],
    3: [(0.2582, 0.1600, 1e-4, 0.1728, 1.5e-3), (0.2794, 0.2029, 3e-4, 0.2287, 3e-4), (0.1186, 0.1837, 2e-4, 0, 1e-5)],
}
PREFIX = {1: "single", 2: "double", 3: "triple"}
EVERY = 5
NAMES = {1: ["swing"], 2: ["upper", "lower"], 3: ["upper", "middle", "lower"]}


def model(arms, heavier, has_friction):
    links = [mechanisms.Link(name, f"{name}_arm", mass * heavier, centre, inertia * heavier, length, f"{name}_friction" if has_friction else "", viscosity * heavier)
             for name, (mass, centre, inertia, length, viscosity) in zip(NAMES[len(arms)], arms)]
    return mechanisms.osim("pendulum", links, limit=12.6)


def convert(recorded, path, arms, seconds):
    """Degrees, of the first from hanging down and of each other from the one before."""
    rows = [[float(cell) for cell in line.split(",")] for line in recorded.read_text().split()[1:]]
    lines = ["time," + ",".join(f"{name}_deg" for name in NAMES[arms])]
    for row in rows[::EVERY]:
        if seconds and row[0] > seconds:
            break
        turns = [math.pi, *row[1:arms + 1]]
        lines.append(f"{row[0]:.3f}," + ",".join(f"{math.degrees(b - a):.5f}" for a, b in zip(turns, turns[1:])))
    path.write_text("\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--arms", type=int, choices=ARMS, default=1)
    parser.add_argument("--build", default="build/program")
    parser.add_argument("--step", default="0.001")
    parser.add_argument("--seconds", type=float, default=0)
    parser.add_argument("--heavier", type=float, default=1)
    parser.add_argument("--fit", nargs="+", default=["id_1", "id_3"])
    parser.add_argument("--hold-out", default="val_1")
    parser.add_argument("--noise-deg", default="")
    parser.add_argument("--baseline", action="store_true")
    asked = parser.parse_args()
    asked.folder.mkdir(parents=True, exist_ok=True)
    (asked.folder / "pendulum.osim").write_text(model(ARMS[asked.arms], asked.heavier, asked.baseline))
    for name in (*asked.fit, asked.hold_out):
        convert(asked.recordings / f"{PREFIX[asked.arms]}_{name}.csv", asked.folder / f"{name}.csv", asked.arms, asked.seconds)
    program = (TOP / asked.build / "apps/fisherhill").resolve()
    command = "calibrate" if asked.baseline else "discover"
    estimated = [f"{name}_{what}" for name in NAMES[asked.arms] for what in ("arm.mass", "arm.mass_center.y", "arm.inertia.zz", "friction.viscosity")]
    further = ["--own-start", "--parameters", ",".join(estimated)] if asked.baseline else []
    further += ["--noise-deg", asked.noise_deg] if asked.noise_deg else []
    trials = [f"{name}.csv" for name in asked.fit]
    sys.exit(subprocess.run([program, command, "pendulum.osim", *trials, "--hold-out", f"{asked.hold_out}.csv", "--step", asked.step, *further, "--out", command, "--force"],
                            cwd=asked.folder, check=False).returncode)


if __name__ == "__main__":
    main()
