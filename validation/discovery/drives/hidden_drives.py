#!/usr/bin/env python3
"""Are errors of a drive found, and are they found where there are none?

    python3 validation/discovery/drives/hidden_drives.py [--build build/program] [--only SYSTEM:EFFECT] [--seed 1] [--sets 3] FOLDER

A slide and a pendulum whose damper the model has, each moved by a drive, simulated here by RK4. In each set one error of the drive is hidden, of a size that is drawn: the gain of its torque, a delay, a
first-order lag, a saturation; or none. In sets of odd seeds the command went on before the first row, which the program, for which it was as there, does not know; a delay or lag then carries some of it over. Of three trials the last is held out. Printed are what was hidden, the verdict with its class, the estimates with their deviations and whether 1.96 of these cover
the truth. --only may be repeated. Sets of one effect have seeds SEED, SEED + 1, … Exit status 1 where something is named though nothing is hidden, or the hidden effect is not in the class.
"""
import argparse
import dataclasses
import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mechanisms  # pylint: disable=wrong-import-position

TOP = pathlib.Path(__file__).resolve().parents[3]
STEP, EVERY, SAMPLES = 0.001, 20, 151
NOISE = 0.002
MASS, ROD = 1.0, 0.5


@dataclasses.dataclass
class System:
    name: str
    slides: bool
    drive: float  # amplitude [N] or [N m]
    viscosity: float  # of the model, and true

    def slope(self, force):
        """y' = f(t, y) of position and speed, moved by the force of a time."""
        def at(t, y):
            q, w = y
            total = force(t) - self.viscosity * w
            return [w, total / MASS if self.slides else (total - MASS * mechanisms.GRAVITY * ROD * math.sin(q)) / (MASS * ROD**2)]

        return at

    def osim(self):
        link = mechanisms.Link("q", "arm", MASS, 0 if self.slides else ROD, damper="bearing", viscosity=self.viscosity)
        return mechanisms.osim(self.name, [link], self.slides, 3 if self.slides else 6.3)


SYSTEMS = {"slide": System("slide", True, 2.0, 0.8), "pendulum": System("pendulum", False, 1.5, 0.1)}
EFFECTS = ("none", "gain", "delay", "lag", "saturation")


class Drive:
    """Three waves as a command, and the force that is made of them."""

    def __init__(self, system, chance, ran_before):
        self.ran_before = ran_before
        self.waves = [(system.drive * chance.uniform(0.3, 0.8), 2 * math.pi * chance.uniform(0.3, 1.3), chance.uniform(0, 2 * math.pi)) for _ in range(3)]
        self.gain, self.delay, self.lag, self.limit = 1, 0, 0, math.inf

    def command(self, t):
        return sum(a * math.sin(w * t + p) for a, w, p in self.waves)

    def lagging(self, t):
        """The steady course behind the lag, and what is left of a beginning before which the command was constant."""
        if not self.lag:
            return self.command(t)

        def steady(s):
            return sum(a / math.hypot(1, w * self.lag) * math.sin(w * s + p - math.atan(w * self.lag)) for a, w, p in self.waves)

        return steady(t) + (0 if self.ran_before else (self.command(0) - steady(0)) * math.exp(-t / self.lag))

    def force(self, t):
        since = t - self.delay
        return self.gain * min(max(self.lagging(since if self.ran_before else max(0, since)), -self.limit), self.limit)


def size_of(effect, chance):
    """Drawn: sizes that a drive may well have."""
    return {"none": lambda: 0, "gain": lambda: chance.choice((chance.uniform(0.7, 0.9), chance.uniform(1.1, 1.35))), "delay": lambda: chance.uniform(0.012, 0.06),
            "lag": lambda: chance.uniform(0.02, 0.1), "saturation": lambda: chance.uniform(0.5, 0.8)}[effect]()


def trial(system, drive, chance):
    column = "q.force" if system.slides else "q.torque"
    text, y = f"time,q,{column}\n", [0.0, 0.0]
    for i in range((SAMPLES - 1) * EVERY + 1):
        t = i * STEP
        if i % EVERY == 0:
            text += f"{t:.3f},{y[0] + chance.gauss(0, NOISE):.9g},{drive.command(t):.9g}\n"
        y = mechanisms.rk4(system.slope(drive.force), t, y, STEP)
    return text


def searched(program, folder, system, effect, seed):
    """The verdict, and the true values of the effect's parameters."""
    chance = random.Random(f"drive {system.name} {effect} {seed}")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "model.osim").write_text(system.osim())
    drives = [Drive(system, chance, seed % 2 == 1) for _ in range(3)]
    value = size_of(effect, chance)
    if effect == "saturation":  # of the largest command of all
        value *= max(abs(drive.command(STEP * i)) for drive in drives for i in range(0, SAMPLES * EVERY, EVERY))
    for k, drive in enumerate(drives):
        if effect == "saturation":
            drive.limit = value
        elif effect != "none":
            setattr(drive, effect, value)
        (folder / f"t{k}.csv").write_text(trial(system, drive, chance))
    word = "force" if system.slides else "torque"
    truth = {"gain": {"drive_gain.factor": value}, "delay": {"drive_delay.time": value}, "lag": {"drive_lag.time": value},
             "saturation": {"drive_saturation.share": 1, f"drive_saturation.{word}": value}, "none": {}}[effect]
    return mechanisms.verdict(program, folder), truth


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--build", default="build/program")
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sets", type=int, default=3)
    asked = parser.parse_args()
    program = (TOP / asked.build / "apps/fisherhill").resolve()
    hidden = in_class = alone = empty = false_alarms = numbers = covering = 0
    print("| system, seed | hidden | verdict | found | covered |\n|---|---|---|---|---|")
    for system in SYSTEMS.values():
        for effect in EFFECTS:
            if asked.only and f"{system.name}:{effect}" not in asked.only:
                continue
            for seed in range(asked.seed, asked.seed + asked.sets):
                verdict, truth = searched(program, asked.folder / f"{system.name}_{effect}_{seed}", system, effect, seed)
                found = {name: each for one in verdict["effects"] for name, each in one["parameters"].items()}
                right = f"drive_{effect}" in verdict["class"]
                named = verdict["verdict"] in ("named", "ambiguous", "parameter") and bool(verdict["class"])
                cover = [abs(found[name]["value"] - value) <= 1.96 * found[name]["sd"] for name, value in truth.items() if name in found]
                if effect == "none":
                    empty, false_alarms = empty + 1, false_alarms + named
                else:
                    hidden, in_class, alone = hidden + 1, in_class + right, alone + (verdict["class"] == [f"drive_{effect}"])
                    numbers, covering = numbers + len(cover), covering + sum(cover)
                estimates = ", ".join(f"{name} {each['value']:.4g} ± {each['sd']:.2g} {each['unit']}".strip() for name, each in found.items())
                others = [each for each in verdict["class"] if not any(name.startswith(each + ".") for name in found)]
                print(f"| {system.name} {seed} | {effect} {', '.join(f'{value:.4g}' for value in truth.values())} | {verdict['verdict']} | "
                      f"{estimates or '–'}{' or ' + ', '.join(others) if others else ''} | {', '.join('yes' if each else 'no' for each in cover) or '–'} |", flush=True)
    print(f"\nOf {hidden} hidden effects {in_class} are in the class and {alone} are alone in it; {covering} of {numbers} intervals cover; of {empty} sets with nothing hidden {false_alarms} have a name.")
    sys.exit(1 if false_alarms or in_class < hidden else 0)


if __name__ == "__main__":
    main()
