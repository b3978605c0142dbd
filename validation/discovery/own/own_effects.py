#!/usr/bin/env python3
"""Are effects of the user's own (discover --effect) found as often as those of the catalogue?

    python3 validation/discovery/own/own_effects.py [--build build/program] [--only SYSTEM:EFFECT] [--seed 1] [--sets 50] FOLDER

Three systems without muscles (those of scaled_twins.py: a driven slide, a free and a driven pendulum), simulated here by RK4. Every set hides one force of random size, of the catalogue (viscous damping, quadratic
drag, stiffness, constant force) or of a TOML file (an eddy-current brake, whose force falls again at high speed, and a detent with so many notches), or nothing, in turn. All are searched with the same
file of two effects. With --only all sets hide this one effect, which may also be `gain`, an angle that is read too large. Printed is what was found in each, and how often the hidden effect came first. Exit status 1 if effects of the file are first less often than
those of the catalogue, by more than chance (a one-sided 5 % test).
"""
import argparse
import collections
import math
import pathlib
import random
import sys

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1] / each) for each in ("", "twins")]
import mechanisms  # pylint: disable=wrong-import-position
import scaled_twins as twins  # pylint: disable=wrong-import-position

CATALOGUE, OWN = ("visc", "drag", "stiffness", "const"), ("brake", "detent")
SIZES = {  # of each system: force, speed, distance from the mean (root mean squares where it moves without the effect)
    "slide": (1.0, 0.33, 0.12),
    "pendulum": (2.0, 2.8, 0.69),
    "driven_pendulum": (0.6, 0.5, 0.14),
}
twins.RESISTANCES["gain"] = lambda value, q, w: 0.0
twins.RESISTANCES["brake"] = lambda value, q, w: -value[0] * w / (1 + (w / value[1]) ** 2)
twins.RESISTANCES["detent"] = lambda value, q, w: -value[0] * math.sin(value[1] * q)


def value_of(effect, system, chance):
    """A size of the effect: between 5 and 40 % of the system's force."""
    force, speed, distance = SIZES[system]
    share = force * math.exp(chance.uniform(math.log(0.05), math.log(0.4)))
    turn = speed * chance.uniform(0.4, 1)
    return {"visc": share / speed, "drag": share / speed**2, "stiffness": share / distance, "const": share, "brake": (2 * share / turn, turn), "detent": (share, notches(system)), "gain": chance.uniform(0.02, 0.15), "": 0}[effect]


def notches(system):
    """Per radian or metre, times 2 pi: known to the user."""
    return round(2 * math.pi / SIZES[system][2], 1)


def file_of_effects(system, slides):
    force, speed, _ = SIZES[system]
    of_force, at, per = ("N", "m", "m/s") if slides else ("N m", "rad", "rad/s")
    return f"""[[effect]]
id = "brake"
name = "eddy-current brake"
sentence = "A magnet brakes the joint, most at one speed."
expression = "-c*qdot/(1+(qdot/v)^2)"

  [[effect.parameter]]
  name = "c"
  unit = "{of_force} s/{at}"
  lower = 0
  upper = {4 * force / speed}
  sd = {0.5 * force / speed}

  [[effect.parameter]]
  name = "v"
  unit = "{per}"
  nominal = {0.7 * speed}
  lower = {0.1 * speed}
  upper = {3 * speed}
  sd = {0.3 * speed}

[[effect]]
id = "detent"
name = "detent"
sentence = "The joint is drawn into notches."
expression = "-k*sin({notches(system)}*q)"

  [[effect.parameter]]
  name = "k"
  unit = "{of_force}"
  lower = 0
  upper = {3 * force}
  sd = {0.3 * force}
"""


def within_range(system, motion, seed):
    """A motion that does not go round; drawn again as often as it does."""
    for attempt in range(100):
        rows = system.motion(motion, seed + attempt * " again")
        if all(abs(each) < 6.2 for _, _, q in rows for each in q):
            return rows
    raise RuntimeError(f"{system.name} {seed}: goes round whatever drives it")


def right_by_chance(right, of, other_right, other_of):
    """Probability of so few right ones if both kinds are right equally often (Fisher's exact test)."""
    total, all_right = of + other_of, right + other_right
    ways = [math.comb(all_right, k) * math.comb(total - all_right, of - k) for k in range(right + 1) if of - k <= total - all_right]
    return sum(ways) / math.comb(total, of)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--build", default="build/program")
    parser.add_argument("--only")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sets", type=int, default=50)
    asked = parser.parse_args()
    program = (twins.TOP / asked.build / "apps/fisherhill").resolve()
    systems = [system for system in twins.SYSTEMS if system.name in SIZES]
    count = collections.Counter()
    print("| system | hidden | verdict | first | probability |\n|---|---|---|---|---|")
    kinds = (("own", OWN), ("catalogue", CATALOGUE), ("nothing", ("",)))
    if asked.only:
        name, _, only = asked.only.partition(":")
        systems, kinds = [system for system in systems if system.name == name], (("own" if only in OWN else "catalogue", (only,)),)
    for k in range(asked.sets):
        for kind, effects in kinds:
            if kind == "nothing" and k % 3:
                continue
            system = systems[k % len(systems)]
            seed = f"{asked.seed} {kind} {k}"
            chance = random.Random(seed)
            effect = effects[(k // len(systems)) % len(effects)]
            value = value_of(effect, system.name, chance)
            motion = system.equations(effect or "const", value)
            motions = [within_range(system, motion, f"{seed} {trial}") for trial in range(3)]
            if effect == "gain":
                motions = [[(t, force, [(1 + value) * each for each in q]) for t, force, q in rows] for rows in motions]
            folder = twins.written(asked.folder / f"{kind}_{k}", system, motions, twins.ONE, seed)
            (folder / "effects.toml").write_text(file_of_effects(system.name, system.slides))
            verdict = mechanisms.verdict(program, folder, "--effect", "effects.toml")
            found = [each["id"] for each in verdict["effects"]]
            named = verdict["verdict"] in ("named", "ambiguous")
            first = found[0] if found else ""
            count[kind] += 1
            count[kind, "first"] += first == effect
            count[kind, "in the class"] += first == effect or effect in verdict["class"]
            count[kind, "confidently wrong"] += named and bool(found) and effect not in verdict["class"] and (verdict["effects"][0]["probability"] or 0) > 0.9
            size = ", ".join(f"{x:.3g}" for x in value) if isinstance(value, tuple) else f"{value:.3g}"
            sure = verdict["effects"][0]["probability"] if found else None
            print(f"| {system.name} | {effect or 'nothing'} {size if effect else ''} | {verdict['verdict']} | {first or '–'} | {'–' if sure is None else f'{sure:.3f}'} |", flush=True)
    print()
    for kind, _ in kinds:
        print(f"{kind}: {count[kind, 'first']} of {count[kind]} first, {count[kind, 'in the class']} in the class, {count[kind, 'confidently wrong']} confidently wrong")
    if asked.only:
        return
    chance = right_by_chance(count["own", "first"], count["own"], count["catalogue", "first"], count["catalogue"])
    print(f"Probability that as few effects of the file are first by chance: {chance:.2f}")
    sys.exit(1 if chance < 0.05 else 0)


if __name__ == "__main__":
    main()
