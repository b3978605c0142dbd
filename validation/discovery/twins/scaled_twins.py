#!/usr/bin/env python3
"""Does the verdict depend on how large a system is? It must not.

    python3 validation/discovery/twins/scaled_twins.py --build build/program [--only SYSTEM:EFFECT …] [--seed 1] FOLDER

Four systems without muscles, each with one effect in turn, simulated here by RK4: a slide that is driven, a pendulum that swings freely, one that is driven, and a
double pendulum that swings freely. The twin of each has 50 times the mass and 4 times the length, in a gravity 4 times as strong, so that the time stays: the same
motion in other units. Both are searched. The verdicts must be the same, and every number found the twin's, scaled, within 0.3 of its deviation. Whether the hidden effect is the one
that is named is printed beside. Exit status 1 where twins differ.
"""
import argparse
import json
import math
import pathlib
import random
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parents[3]
STEP, EVERY, SAMPLES = 0.001, 20, 151
ACCELERATION = 9.81
HEAVIER, LONGER = 50, 4


class Twin:
    """Units of one of the two: a mass, a length."""

    def __init__(self, mass, length):
        self.mass, self.length = mass, length

    def factor(self, kind):
        """By which a number grows: of a joint's force (N or N m), of a body's mass."""
        return {"force": self.mass * self.length, "moment": self.mass * self.length**2, "mass": self.mass, "none": 1}[kind]


def body(name, mass, length):
    """A point mass at the end of a rod."""
    return (f'<Body name="{name}"><mass>{mass!r}</mass><mass_center>0 {-length!r} 0</mass_center><inertia>0 0 0 0 0 0</inertia></Body>')


def joint(kind, name, parent, offset, child, coordinate, limit):
    frames = f'<socket_parent_frame>/{parent}</socket_parent_frame><socket_child_frame>/bodyset/{child}</socket_child_frame>'
    if offset:
        frames = (f'<frames><PhysicalOffsetFrame name="end"><socket_parent>/{parent}</socket_parent><translation>0 {-offset!r} 0</translation></PhysicalOffsetFrame></frames>'
                  f'<socket_parent_frame>end</socket_parent_frame><socket_child_frame>/bodyset/{child}</socket_child_frame>')
    return (f'<{kind} name="{name}">{frames}<coordinates><Coordinate name="{coordinate}"><default_value>0</default_value>'
            f'<range>{-limit!r} {limit!r}</range></Coordinate></coordinates></{kind}>')


def osim(name, gravity, bodies, joints):
    return (f'<?xml version="1.0"?><OpenSimDocument Version="40000"><Model name="{name}"><gravity>0 {-gravity!r} 0</gravity><BodySet><objects>{"".join(bodies)}</objects></BodySet>'
            f'<JointSet><objects>{"".join(joints)}</objects></JointSet><ForceSet><objects/></ForceSet></Model></OpenSimDocument>')


class System:
    """Equations of motion in units of its own: mass 1 kg and length 0.5 m, or as said."""

    def __init__(self, name, coordinates, driven, effects):
        self.name, self.coordinates, self.driven, self.effects = name, coordinates, driven, effects

    def drive(self, seed):
        chance = random.Random(f"{self.name} {seed}")
        waves = [(chance.uniform(0.3, 1.3), chance.uniform(0, 2 * math.pi), chance.uniform(0.3, 0.8)) for _ in range(3)]
        return lambda t: self.driven * sum(a * math.sin(2 * math.pi * f * t + p) for f, p, a in waves)

    def start(self, seed):
        chance = random.Random(f"start {seed}")
        if self.driven:
            return [0.0] * 2
        return [chance.uniform(0.7, 1.3) * chance.choice((-1, 1)) for _ in self.coordinates] + [0.0] * len(self.coordinates)


def resisting(effect, value, q, w):
    """The force of an effect on its coordinate."""
    return {"visc": lambda: -value * w, "coulomb": lambda: -value * math.tanh(w / 0.005), "drag": lambda: -value * w * abs(w),
            "stiffness": lambda: -value * q, "const": lambda: value, "mass": lambda: 0.0}[effect]()


def slide(effect, value):
    mass = 1 + (value if effect == "mass" else 0)
    return lambda t, y, force: [y[1], (force + resisting(effect, value, y[0], y[1])) / mass]


def pendulum(effect, value):
    mass, rod = 1 + (value if effect == "mass" else 0), 0.5
    return lambda t, y, force: [y[1], (force - mass * ACCELERATION * rod * math.sin(y[0]) + resisting(effect, value, y[0], y[1])) / (mass * rod**2)]


def double_pendulum(effect, value):
    """Point masses of 1 and 0.6 kg on rods of 0.5 and 0.4 m; the second angle from the first rod."""
    where, what = effect.split(".")
    m1, m2, a, b = 1, 0.6, 0.5, 0.4

    def slope(t, y, force):
        q1, q2, w1, w2 = y
        c, s = math.cos(q2), math.sin(q2)
        m11, m12, m22 = m1 * a * a + m2 * (a * a + b * b + 2 * a * b * c), m2 * (b * b + a * b * c), m2 * b * b
        h = m2 * a * b * s
        r1 = h * w2 * (2 * w1 + w2) - (m1 + m2) * ACCELERATION * a * math.sin(q1) - m2 * ACCELERATION * b * math.sin(q1 + q2)
        r2 = -h * w1 * w1 - m2 * ACCELERATION * b * math.sin(q1 + q2)
        if where == "upper":
            r1 += resisting(what, value, q1, w1)
        else:
            r2 += resisting(what, value, q2, w2)
        d = m11 * m22 - m12 * m12
        return [w1, w2, (m22 * r1 - m12 * r2) / d, (m11 * r2 - m12 * r1) / d]

    return slope


SYSTEMS = {
    "slide": (System("slide", ["x"], 2.0, {"visc": 0.8, "coulomb": 0.3, "drag": 0.8, "stiffness": 2.0, "const": 0.2, "mass": 0.3}), slide, "force"),
    "pendulum": (System("pendulum", ["swing"], 0, {"visc": 0.05, "coulomb": 0.1, "drag": 0.03}), pendulum, "moment"),
    "driven_pendulum": (System("driven_pendulum", ["swing"], 1.2, {"visc": 0.1, "coulomb": 0.2, "drag": 0.1, "stiffness": 0.8, "const": 0.3, "mass": 0.2}), pendulum, "moment"),
    "double_pendulum": (System("double_pendulum", ["upper", "lower"], 0, {"upper.visc": 0.1, "upper.coulomb": 0.15, "lower.visc": 0.05, "lower.coulomb": 0.08}),
                        double_pendulum, "moment"),
}


def model(name, twin):
    gravity = ACCELERATION * twin.length
    if name == "slide":
        far = 3.0 * twin.length
        return osim(name, gravity, [f'<Body name="carriage"><mass>{float(twin.mass)!r}</mass><mass_center>0 0 0</mass_center><inertia>0 0 0 0 0 0</inertia></Body>'],
                    [joint("SliderJoint", "rail", "ground", 0, "carriage", "x", far)])
    if name != "double_pendulum":
        return osim(name, gravity, [body("arm", float(twin.mass), 0.5 * twin.length)], [joint("PinJoint", "pivot", "ground", 0, "arm", "swing", 6.3)])
    return osim(name, gravity, [body("rod1", float(twin.mass), 0.5 * twin.length), body("rod2", 0.6 * twin.mass, 0.4 * twin.length)],
                [joint("PinJoint", "pivot", "ground", 0, "rod1", "upper", 6.3), joint("PinJoint", "hinge", "bodyset/rod1", 0.5 * twin.length, "rod2", "lower", 6.3)])


def motion(system, slope, seed):
    """Rows of time, drive and coordinates."""
    force = system.drive(seed) if system.driven else lambda t: 0.0
    y, rows = system.start(seed), []
    for i in range(SAMPLES * EVERY):
        t = i * STEP
        if i % EVERY == 0:
            rows.append((t, force(t), y[:len(system.coordinates)]))
        k1 = slope(t, y, force(t))
        k2 = slope(t, [a + STEP / 2 * b for a, b in zip(y, k1)], force(t + STEP / 2))
        k3 = slope(t, [a + STEP / 2 * b for a, b in zip(y, k2)], force(t + STEP / 2))
        k4 = slope(t, [a + STEP * b for a, b in zip(y, k3)], force(t + STEP))
        y = [a + STEP / 6 * (b + 2 * c + 2 * d + e) for a, b, c, d, e in zip(y, k1, k2, k3, k4)]
    return rows


def write_trials(folder, name, system, motions, twin, noise_seed):
    shift = twin.length if name == "slide" else 1
    kind = "force" if name == "slide" else "moment"
    column = ",x.force" if name == "slide" else ",swing.torque" if system.driven else ""
    files = []
    for k, rows in enumerate(motions):
        chance = random.Random(f"noise {noise_seed} {k}")
        path = folder / f"t{k + 1}.csv"
        with path.open("w") as out:
            out.write("time," + ",".join(system.coordinates) + column + "\n")
            for t, force, q in rows:
                shown = ",".join(f"{shift * (each + chance.gauss(0, 0.002)):.9g}" for each in q)
                out.write(f"{t:.3f},{shown}" + (f",{twin.factor(kind) * force:.9g}" if column else "") + "\n")
        files.append(path.name)
    return files


def searched(program, folder, files):
    command = [program, "discover", "model.osim", *files[:-1], "--hold-out", files[-1], "--step", "0.005", "--threads", "1", "--out", "out", "--force"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{folder}: {done.stderr.strip()}")
    return json.loads((folder / "out/verdict.json").read_text())


def numbers(verdict):
    return {name: (each["value"], each["sd"], each["unit"]) for effect in verdict["effects"] for name, each in effect["parameters"].items()}


def scale_of(unit, name, twin):
    """The factor of a number of this unit."""
    powers = {"N": "force", "N m": "moment", "kg": "mass"}
    if unit in powers:
        return twin.factor(powers[unit])
    for head, kind in (("N m", "moment"), ("N s/m", "force"), ("N s", "force"), ("N/m", "force"), ("N", "force")):
        if unit.startswith(head):
            length = unit.count("/m") * (2 if "m^2" in unit or "m²" in unit else 1) if kind == "force" else 0
            return twin.factor(kind) / twin.length**length
    return twin.length if unit == "m" else twin.length**unit.startswith("m/")


def compare(one, two, twin):
    """What differs; empty if nothing does."""
    if one["verdict"] != two["verdict"]:
        return f"verdicts {one['verdict']} and {two['verdict']}"
    if one["class"] != two["class"]:
        return f"{one['class']} and {two['class']}"
    here, there = numbers(one), numbers(two)
    for name, (value, sd, unit) in here.items():
        factor = scale_of(unit, name, twin)
        other = there[name][0] / factor
        if abs(other - value) > 0.3 * sd:
            return f"{name} = {value:.4g} ± {sd:.2g} {unit} and, scaled, {other:.4g}"
    return ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--build", default="build/program")
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    program = (TOP / asked.build / "apps/fisherhill").resolve()
    unlike = right = pairs = 0
    print("| system | hidden | verdict | found | twins |\n|---|---|---|---|---|")
    for name, (system, equations, _) in SYSTEMS.items():
        for effect, value in system.effects.items():
            if asked.only and f"{name}:{effect}" not in asked.only:
                continue
            motions = [motion(system, equations(effect, value), 10 * asked.seed + k) for k in range(3)]
            verdicts = []
            for twin in (Twin(1, 1), Twin(HEAVIER, LONGER)):
                folder = asked.folder / f"{name}_{effect}_{twin.mass}"
                folder.mkdir(parents=True, exist_ok=True)
                (folder / "model.osim").write_text(model(name, twin))
                verdicts.append(searched(program, folder, write_trials(folder, name, system, motions, twin, asked.seed)))
            difference = compare(*verdicts, Twin(HEAVIER, LONGER))
            found = ", ".join(f"{key} {value:.4g} ± {sd:.2g} {unit}" for key, (value, sd, unit) in numbers(verdicts[0]).items())
            pairs, unlike, right = pairs + 1, unlike + bool(difference), right + (effect in verdicts[0]["class"])
            print(f"| {name} | {effect} {value} | {verdicts[0]['verdict']} | {found or '–'} | {difference or 'the same'} |", flush=True)
    print(f"\n{pairs - unlike} of {pairs} pairs have the same verdict; the hidden effect is in the class of {right}.")
    sys.exit(1 if unlike else 0)


if __name__ == "__main__":
    main()
