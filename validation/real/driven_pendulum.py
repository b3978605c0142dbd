#!/usr/bin/env python3
"""A real pendulum that a motor drives: what does the model of its drawing lack?

    python3 validation/real/driven_pendulum.py [--build build/program] [--step 0.005] [--seconds 3] [--fit swingup_05kg ilqr] [--hold-out ddp] [--without drive_gain] RECORDINGS FOLDER

RECORDINGS: swingup_05kg.csv, … of the torque-limited simple pendulum of DFKI (github.com/dfki-ric-underactuated-lab/torque_limited_simple_pendulum, BSD-3-Clause), columns time,
angle_deg from hanging down, velocity and torque_Nm, from the motor's current. The model has the drawing's bob of 0.546 kg at 0.5 m and its rod of 0.13 kg, and no friction. Used are the first SECONDS,
a row every 10 ms at most. --without may be repeated. Exit status: that of discover.
"""
import argparse
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "discovery"))
import mechanisms  # pylint: disable=wrong-import-position

TOP = pathlib.Path(__file__).resolve().parents[2]
BOB, ROD, LENGTH = 0.546, 0.13, 0.5  # [kg], [kg], [m]
LEAST = 0.01  # [s] between rows


def model():
    mass = BOB + ROD
    centre = (BOB + ROD / 2) * LENGTH / mass
    inertia = BOB * (LENGTH - centre) ** 2 + ROD * (LENGTH**2 / 12 + (LENGTH / 2 - centre) ** 2)
    return mechanisms.osim("pendulum", [mechanisms.Link("swing", "arm", mass, centre, inertia)], limit=12.6)


def convert(recorded, path, seconds):
    lines, last = ["time,swing_deg,swing.torque"], -LEAST
    for row in recorded.read_text().split()[1:]:
        time, angle, _, torque = (float(cell) for cell in row.split(","))
        if time > seconds:
            break
        if time >= last + LEAST - 1e-6:
            lines.append(f"{time:.4f},{angle},{torque}")
            last = time
    path.write_text("\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--build", default="build/program")
    parser.add_argument("--step", default="0.005")
    parser.add_argument("--seconds", type=float, default=3)
    parser.add_argument("--fit", nargs="+", default=["swingup_05kg", "ilqr"])
    parser.add_argument("--hold-out", default="ddp")
    parser.add_argument("--without", action="append", default=[])
    asked = parser.parse_args()
    asked.folder.mkdir(parents=True, exist_ok=True)
    (asked.folder / "pendulum.osim").write_text(model())
    for name in (*asked.fit, asked.hold_out):
        convert(asked.recordings / f"{name}.csv", asked.folder / f"{name}.csv", asked.seconds)
    program = (TOP / asked.build / "apps/fisherhill").resolve()
    trials = [f"{name}.csv" for name in asked.fit]
    without = [word for each in asked.without for word in ("--without", each)]
    sys.exit(subprocess.run([program, "discover", "pendulum.osim", *trials, "--hold-out", f"{asked.hold_out}.csv", *without, "--step", asked.step, "--out", "discover", "--force"],
                            cwd=asked.folder, check=False).returncode)


if __name__ == "__main__":
    main()
