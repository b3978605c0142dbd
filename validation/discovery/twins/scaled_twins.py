#!/usr/bin/env python3
"""Does the verdict depend on how large a system is? It must not.

    python3 validation/discovery/twins/scaled_twins.py [--build build/program] [--only SYSTEM:EFFECT] [--seed 1] FOLDER

Four systems without muscles, each with one effect in turn, simulated here by RK4: a slide that is driven, a pendulum that swings freely, one that is driven, and a
double pendulum that swings freely. The twin of each has 50 times the mass and 4 times the length, in a gravity 4 times as strong, so that its times are the same. Both are searched. The verdicts must
be the same, and the formula of an unknown force, and every number found the twin's, scaled, within 0.3 of its deviation: each fit ends where a further step would gain less than 0.02 nats, 0.2 deviations. Whether the hidden
effect is in the class is printed beside. The slide's `nameless` is dry friction where the catalogue has neither that nor sub-linear damping. --only may be repeated. Exit status 1 where twins differ.
"""
import argparse
import dataclasses
import math
import pathlib
import random
import re
import sys
import typing

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mechanisms  # pylint: disable=wrong-import-position

TOP = pathlib.Path(__file__).resolve().parents[3]
STEP, EVERY, SAMPLES = 0.001, 20, 151
NOISE = 0.002
GRAVITY = mechanisms.GRAVITY
SHARPNESS = 0.005  # speed over which dry friction grows, in rad/s or m/s


@dataclasses.dataclass
class Units:
    """Of one of two twins; both have the same second."""
    mass: float
    length: float

    def of(self, unit):
        """The factor of a number in a unit such as "N m s/rad"."""
        by_name = {"N": self.mass * self.length, "m": self.length, "kg": self.mass}
        factor = 1
        for part, sign in zip(unit.split("/"), (1, -1)):
            for name, power in re.findall(r"([A-Za-z]+)(?:\^(\d))?", part):
                factor *= by_name.get(name, 1) ** (sign * int(power or 1))
        return factor


ONE, TWIN = Units(1, 1), Units(50, 4)

RESISTANCES = {  # of a coordinate, by its position and speed
    "visc": lambda value, q, w: -value * w,
    "coulomb": lambda value, q, w: -value * math.tanh(w / SHARPNESS),
    "drag": lambda value, q, w: -value * w * abs(w),
    "stiffness": lambda value, q, w: -value * q,
    "const": lambda value, q, w: value,
    "mass": lambda value, q, w: 0.0,
}
RESISTANCES["nameless"] = RESISTANCES["coulomb"]
WITHOUT = {"nameless": ("--without", "coulomb,stribeck,powerdamp")}
OF_FORMULAS = {"": "N", "q": "N/m", "q²": "N/m^2", "q³": "N/m^3", "q̇": "N/m", "q̇|q̇|": "N/m^2", "q̇³": "N/m^3", "tanh": "N", "q·q̇": "N/m^2"}  # on a slide; twins have the same second


def slide(effect, value):
    mass = 1 + (value if effect == "mass" else 0)
    return lambda y, force: [y[1], (force + RESISTANCES[effect](value, *y)) / mass]


def pendulum(effect, value):
    mass, rod = 1 + (value if effect == "mass" else 0), 0.5
    return lambda y, force: [y[1], (force - mass * GRAVITY * rod * math.sin(y[0]) + RESISTANCES[effect](value, *y)) / (mass * rod**2)]


def double_pendulum(effect, value):
    """Its second angle is that from the first rod."""
    where, what = effect.split(".")
    m1, m2, a, b = 1, 0.6, 0.5, 0.4

    def slope(y, force):
        q1, q2, w1, w2 = y
        c, s = math.cos(q2), math.sin(q2)
        m11, m12, m22 = m1 * a * a + m2 * (a * a + b * b + 2 * a * b * c), m2 * (b * b + a * b * c), m2 * b * b
        h = m2 * a * b * s
        r1 = h * w2 * (2 * w1 + w2) - (m1 + m2) * GRAVITY * a * math.sin(q1) - m2 * GRAVITY * b * math.sin(q1 + q2)
        r2 = -h * w1 * w1 - m2 * GRAVITY * b * math.sin(q1 + q2)
        if where == "upper":
            r1 += RESISTANCES[what](value, q1, w1)
        else:
            r2 += RESISTANCES[what](value, q2, w2)
        d = m11 * m22 - m12 * m12
        return [w1, w2, (m22 * r1 - m12 * r2) / d, (m11 * r2 - m12 * r1) / d]

    return slope


@dataclasses.dataclass
class System:
    """Point masses, each at the end of a rod from the one before; or one that slides."""
    name: str
    links: list  # (coordinate, mass [kg], rod [m])
    drive: float  # amplitude [N] or [N m]; 0: it swings freely
    equations: typing.Callable  # of an effect and its value: y' = f(y, drive)
    effects: dict

    @property
    def slides(self):
        return self.links[0][2] == 0

    def driving(self, seed):
        chance = random.Random(f"{self.name} {seed}")
        waves = [(chance.uniform(0.3, 1.3), chance.uniform(0, 2 * math.pi), chance.uniform(0.3, 0.8)) for _ in range(3)]
        return lambda t: self.drive * sum(a * math.sin(2 * math.pi * f * t + p) for f, p, a in waves)

    def start(self, seed):
        chance = random.Random(f"start {seed}")
        rest = [0.0] * len(self.links)
        if self.drive:
            return 2 * rest
        return [chance.uniform(0.7, 1.3) * chance.choice((-1, 1)) for _ in self.links] + rest

    def motion(self, slope, seed):
        """Rows of time, drive and coordinates."""
        force, y, rows = self.driving(seed), self.start(seed), []
        for i in range(SAMPLES * EVERY):
            t = i * STEP
            if i % EVERY == 0:
                rows.append((t, force(t), y[:len(self.links)]))
            y = mechanisms.rk4(lambda at, state: slope(state, force(at)), t, y, STEP)
        return rows

    def osim(self, units):
        links = [mechanisms.Link(coordinate, f"{coordinate}_link", units.mass * mass, units.length * rod, length=units.length * rod) for coordinate, mass, rod in self.links]
        return mechanisms.osim(self.name, links, self.slides, 3.0 * units.length if self.slides else 6.3, GRAVITY * units.length)

    def table(self, rows, units, chance):
        first = self.links[0][0]
        column, unit = (f",{first}.force", "N") if self.slides else (f",{first}.torque", "N m")
        shift = units.length if self.slides else 1
        text = "time," + ",".join(name for name, _, _ in self.links) + (column if self.drive else "") + "\n"
        for t, force, q in rows:
            text += f"{t:.3f}," + ",".join(f"{shift * (each + chance.gauss(0, NOISE)):.9g}" for each in q)
            text += f",{units.of(unit) * force:.9g}\n" if self.drive else "\n"
        return text


SYSTEMS = [
    System("slide", [("x", 1, 0)], 2.0, slide, {"visc": 0.8, "coulomb": 0.3, "drag": 0.8, "stiffness": 2.0, "const": 0.2, "mass": 0.3, "nameless": 0.3}),
    System("pendulum", [("swing", 1, 0.5)], 0, pendulum, {"visc": 0.05, "coulomb": 0.1, "drag": 0.03}),
    System("driven_pendulum", [("swing", 1, 0.5)], 1.2, pendulum, {"visc": 0.1, "coulomb": 0.2, "drag": 0.1, "stiffness": 0.8, "const": 0.3, "mass": 0.2}),
    System("double_pendulum", [("upper", 1, 0.5), ("lower", 0.6, 0.4)], 0, double_pendulum,
           {"upper.visc": 0.1, "upper.coulomb": 0.15, "lower.visc": 0.05, "lower.coulomb": 0.08}),
]


def written(folder, system, motions, units, seed):
    """model.osim and t0.csv, t1.csv, …"""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "model.osim").write_text(system.osim(units))
    for k, rows in enumerate(motions):
        (folder / f"t{k}.csv").write_text(system.table(rows, units, random.Random(f"noise {seed} {k}")))
    return folder


def numbers(verdict):
    return {name: (each["value"], each["sd"], each["unit"]) for effect in verdict["effects"] for name, each in effect["parameters"].items()}


def formula(verdict):
    """Terms of the formula of an unknown force, {} if there is none, and the speed in its tanh."""
    text = verdict.get("unknown", {}).get("formula", "")
    speed = re.search(r"tanh\(q̇/([^)]*)\)", text)
    parts = [part.partition("·") for part in re.sub(r"tanh\([^)]*\)", "tanh", text).split(" + ") if part]
    return {name: float(number) for number, _, name in parts}, float(speed[1]) if speed else 0


def difference(system, verdict, twins):
    """What differs; empty if nothing does."""
    if verdict["verdict"] != twins["verdict"]:
        return f"verdicts {verdict['verdict']} and {twins['verdict']}"
    if verdict["class"] != twins["class"]:
        return f"{verdict['class']} and {twins['class']}"
    for name, (value, sd, unit) in numbers(verdict).items():
        scaled = numbers(twins)[name][0] / TWIN.of(unit)
        if abs(scaled - value) > 0.3 * sd:
            return f"{name} = {value:.4g} ± {sd:.2g} {unit} and, scaled, {scaled:.4g}"
    (terms, speed), (scaled_terms, scaled_speed) = formula(verdict), formula(twins)
    alike = terms.keys() == scaled_terms.keys() and all(
        math.isclose(scaled_terms[name] / TWIN.of(OF_FORMULAS[name] if system.slides else "N m"), value, rel_tol=0.03) for name, value in terms.items())
    if not alike or not math.isclose(scaled_speed, (TWIN.length if system.slides else 1) * speed, rel_tol=0.01):
        return f"formulas {verdict['unknown']['formula']} and {twins['unknown']['formula']}"
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
    for system in SYSTEMS:
        for effect, value in system.effects.items():
            if asked.only and f"{system.name}:{effect}" not in asked.only:
                continue
            motions = [system.motion(system.equations(effect, value), 10 * asked.seed + k) for k in range(3)]
            verdict, twins = (
                mechanisms.verdict(program, written(asked.folder / f"{system.name}_{effect}_{units.mass}", system, motions, units, asked.seed), *WITHOUT.get(effect, ())) for units in (ONE, TWIN))
            unlikeness = difference(system, verdict, twins)
            found = ", ".join(f"{key} {number:.4g} ± {sd:.2g} {unit}" for key, (number, sd, unit) in numbers(verdict).items())
            found = found + "".join(f" [{number:.3g}·{name}]" for name, number in formula(verdict)[0].items())
            pairs, unlike, right = pairs + 1, unlike + bool(unlikeness), right + (effect in verdict["class"])
            print(f"| {system.name} | {effect} {value} | {verdict['verdict']} | {found or '–'} | {unlikeness or 'the same'} |", flush=True)
    print(f"\n{pairs - unlike} of {pairs} pairs have the same verdict; the hidden effect is in the class of {right}.")
    sys.exit(1 if unlike else 0)


if __name__ == "__main__":
    main()
