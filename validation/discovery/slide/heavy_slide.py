#!/usr/bin/env python3
"""Are all forces that a heavy slide's model lacks named, in open and in closed loop?

    python3 validation/discovery/slide/heavy_slide.py [--build build/program] [--only open|closed] [--seconds 6] [--seed 1] [--sets 3] FOLDER

A slide of 95 kg with 200 N s/m, 20 N of Coulomb friction and a force of 3 N, simulated here by RK4; its model has none of the three. In open loop it is moved by three waves of force; in closed loop a
continuous PD controller makes it follow three waves of position, and the force it commands is what is recorded. Of three trials, 50 rows a second, noise 1 mm, the last is held out. Printed are the verdict,
its effects and the three estimates with their deviations. Exit status 1 where the effects found are not these three, or are not named, or where
intervals of 1.96 deviations miss the truth more often than by chance (a one-sided 5 % test).
"""
import argparse
import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mechanisms  # pylint: disable=wrong-import-position

TOP = pathlib.Path(__file__).resolve().parents[3]
STEP, EVERY = 0.001, 20
NOISE = 0.001  # [m]
MASS, TRUTH = 95.0, {"visc.viscosity": 200.0, "coulomb.force": 20.0, "const.force": 3.0}
SHARPNESS = 0.002  # speed over which dry friction grows [m/s]
STIFFNESS, DAMPING = 20000.0, 2000.0  # of the controller [N/m], [N s/m]
RISE = 0.3  # time over which its reference begins [s]


def waves(amplitude, chance):
    """A sum of three sines, with its slope."""
    parts = [(amplitude * chance.uniform(0.3, 0.8), 2 * math.pi * chance.uniform(0.2, 0.8), chance.uniform(0, 2 * math.pi)) for _ in range(3)]
    return lambda t: (sum(a * math.sin(w * t + p) for a, w, p in parts), sum(a * w * math.cos(w * t + p) for a, w, p in parts))


def trial(loop, seconds, chance):
    """A recording of time, position and force; the slide and its reference start at rest."""
    wave = waves({"open": 150.0, "closed": 0.15}[loop], chance)
    begin = wave(0)[0]

    def command(t, place, speed):
        target, slope = wave(t)
        if loop == "open":
            return target
        begun, begins = 1 - math.exp(-((t / RISE) ** 2)), 2 * t / RISE**2 * math.exp(-((t / RISE) ** 2))
        return STIFFNESS * (begun * (target - begin) - place) + DAMPING * (begun * slope + begins * (target - begin) - speed)

    def slope(t, state):
        resistance = TRUTH["visc.viscosity"] * state[1] + TRUTH["coulomb.force"] * math.tanh(state[1] / SHARPNESS) - TRUTH["const.force"]
        return [state[1], (command(t, *state) - resistance) / MASS]

    text, y = "time,x,x.force\n", [0.0, 0.0]
    for i in range(round(seconds / STEP) + 1):
        if i % EVERY == 0:
            text += f"{i * STEP:.3f},{y[0] + chance.gauss(0, NOISE):.9g},{command(i * STEP, *y):.9g}\n"
        y = mechanisms.rk4(slope, i * STEP, y, STEP)
    return text


def searched(program, folder, loop, seconds, seed):
    chance = random.Random(f"heavy slide {loop} {seed}")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "model.osim").write_text(mechanisms.osim("heavy_slide", [mechanisms.Link("x", "carriage", MASS, 0)], slides=True, limit=3))
    for k in range(3):
        (folder / f"t{k}.csv").write_text(trial(loop, seconds, chance))
    return mechanisms.verdict(program, folder)


def at_most(misses, tries, share=0.05):
    """Probability of so many misses or more by chance."""
    return sum(math.comb(tries, k) * share**k * (1 - share) ** (tries - k) for k in range(misses, tries + 1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--build", default="build/program")
    parser.add_argument("--only", choices=("open", "closed"))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=6)
    parser.add_argument("--sets", type=int, default=3)
    asked = parser.parse_args()
    program = (TOP / asked.build / "apps/fisherhill").resolve()
    sets = named = alone = numbers = covering = 0
    print("| loop, seed | verdict | found | class | covered |\n|---|---|---|---|---|")
    for loop in ("open", "closed"):
        for seed in range(asked.seed, asked.seed + asked.sets) if asked.only in (None, loop) else ():
            verdict = searched(program, asked.folder / f"{loop}_{seed}", loop, asked.seconds, seed)
            found = {name: each for effect in verdict["effects"] for name, each in effect["parameters"].items()}
            right = verdict["verdict"] in ("named", "ambiguous") and {effect["id"] for effect in verdict["effects"]} == {"visc", "coulomb", "const"}
            cover = [abs(found[name]["value"] - value) <= 1.96 * found[name]["sd"] for name, value in TRUTH.items() if name in found]
            alone += right and verdict["verdict"] == "named"
            sets, named, numbers, covering = sets + 1, named + right, numbers + len(cover), covering + sum(cover)
            estimates = ", ".join(f"{name} {each['value']:.4g} ± {each['sd']:.2g} {each['unit']}".strip() for name, each in found.items())
            print(f"| {loop} {seed} | {verdict['verdict']} | {estimates or '–'} | {', '.join(verdict['class'])} | {', '.join('yes' if each else 'no' for each in cover) or '–'} |", flush=True)
    print(f"\nOf {sets} slides {named} have all three forces named, {alone} without an alternative; {covering} of {numbers} intervals cover.")
    sys.exit(1 if named < sets or at_most(numbers - covering, numbers) < 0.05 else 0)


if __name__ == "__main__":
    main()
