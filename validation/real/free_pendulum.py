#!/usr/bin/env python3
"""A real pendulum that swings freely: what does the authors' model lack?

    python3 validation/real/free_pendulum.py [--build build/program] [--step 0.001] [--heavier 1] [--fit id_1 id_3] [--hold-out val_1] RECORDINGS FOLDER

RECORDINGS: single_id_1.csv … of the MultiArm-Pendulum of the University of Washington (github.com/dynamicslab/MultiArm-Pendulum, MIT licence), columns time and
phi1_rad with 0 upwards. The model is the authors' without its friction: mass 0.1478 kg, its centre 0.1476 m from the pivot, inertia 1.09e-4 kg m^2 about it. Every fifth row is used. Fitted are
id_1 and id_3 and held out is val_1 unless told. The authors' viscosity is 2.24e-4 N m s/rad. --heavier: the model's mass and inertia times this, which its free swing cannot
show. Exit status: that of discover.
"""
import argparse
import math
import pathlib
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
EVERY = 5
MODEL = """<?xml version="1.0" encoding="UTF-8"?>
<OpenSimDocument Version="40000">
  <Model name="pendulum">
    <gravity>0 -9.81 0</gravity>
    <BodySet><objects>
      <Body name="arm"><mass>{mass!r}</mass><mass_center>0 -0.1476 0</mass_center><inertia>{inertia!r} {inertia!r} {inertia!r} 0 0 0</inertia></Body>
    </objects></BodySet>
    <JointSet><objects>
      <PinJoint name="pivot">
        <socket_parent_frame>/ground</socket_parent_frame>
        <socket_child_frame>/bodyset/arm</socket_child_frame>
        <coordinates><Coordinate name="swing"><default_value>0</default_value><range>-6.3 6.3</range></Coordinate></coordinates>
      </PinJoint>
    </objects></JointSet>
    <ForceSet><objects/></ForceSet>
  </Model>
</OpenSimDocument>
"""


def convert(recorded, path):
    """Degrees from hanging down, every fifth row."""
    rows = [line.split(",") for line in recorded.read_text().split()[1:]]
    path.write_text("time,swing_deg\n" + "".join(f"{t},{math.degrees(float(phi) - math.pi):.5f}\n" for t, phi, *_ in rows[::EVERY]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--build", default="build/program")
    parser.add_argument("--step", default="0.001")
    parser.add_argument("--heavier", type=float, default=1)
    parser.add_argument("--fit", nargs="+", default=["id_1", "id_3"])
    parser.add_argument("--hold-out", default="val_1")
    asked = parser.parse_args()
    asked.folder.mkdir(parents=True, exist_ok=True)
    (asked.folder / "pendulum.osim").write_text(MODEL.format(mass=0.1478 * asked.heavier, inertia=1.09e-4 * asked.heavier))
    for name in (*asked.fit, asked.hold_out):
        convert(asked.recordings / f"single_{name}.csv", asked.folder / f"{name}.csv")
    program = (TOP / asked.build / "apps/fisherhill").resolve()
    sys.exit(subprocess.run([program, "discover", "pendulum.osim", *(f"{name}.csv" for name in asked.fit), "--hold-out", f"{asked.hold_out}.csv", "--step", asked.step, "--out", "discover", "--force"],
                            cwd=asked.folder, check=False).returncode)


if __name__ == "__main__":
    main()
