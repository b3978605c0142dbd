#!/usr/bin/env python3
"""Are hidden forces found in chains that a user describes as often as in the built-in robots?

    python3 validation/discovery/chains/hidden_chains.py [--build build/program] [--links 2] [--seed 1] [--sets 50] FOLDER

Each set has a chain of its own: hinges with parallel axes, masses, lengths, mass centres and inertias drawn, moved by a torque on every joint and by gravity, written in turn as .osim and as URDF, and simulated
here by RK4 in absolute angles. One joint has a force that the model lacks, in turn of the catalogue or of the user's file of two effects (that of own_effects.py), of 5 to 40 % of what moves that joint;
every eighth set has none. Of three trials of 2 s the last is held out. Printed are what was hidden, what was found, and how often the hidden effect came first or in the class. Exit status 1 if it is in the class less
often, by more than chance, than in the built-in robots (36 of 37 sets, validation/discovery/README.md), or if something is named with a probability above 0.9 that is not the hidden effect.
"""
import argparse
import collections
import math
import pathlib
import random
import sys

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1] / each) for each in ("", "twins", "own")]
import mechanisms  # pylint: disable=wrong-import-position
import own_effects as own  # pylint: disable=wrong-import-position
import scaled_twins as twins  # pylint: disable=wrong-import-position

EFFECTS = ("visc", "brake", "coulomb", "stiffness", "detent", "drag", "const", "")
STEP, EVERY, SAMPLES = 0.001, 20, 101
NOISE = 0.01  # [rad], that of the built-in robots
SHARPNESS = 0.01  # [rad/s]
ROBOTS = (36, 37)  # sets of the built-in robots with the hidden effect in the class, and all


def solved(a, b):
    """x of a x = b, by elimination; a is symmetric and positive."""
    n = len(b)
    a, b = [row[:] for row in a], b[:]
    for i in range(n):
        for k in range(i + 1, n):
            share = a[k][i] / a[i][i]
            b[k] -= share * b[i]
            for j in range(i, n):
                a[k][j] -= share * a[i][j]
    for i in reversed(range(n)):
        b[i] = (b[i] - sum(a[i][j] * b[j] for j in range(i + 1, n))) / a[i][i]
    return b


class Chain:
    def __init__(self, links, chance):
        self.links = []
        for name in "abc"[:links]:
            length, mass = chance.uniform(0.25, 0.6), math.exp(chance.uniform(math.log(0.3), math.log(3)))
            self.links.append(mechanisms.Link(name, f"link_{name}", mass, chance.uniform(0.4, 0.7) * length, chance.uniform(0.03, 0.1) * mass * length**2, length))
        n, self.effect, self.value, self.joint = links, "", 0, 0
        reach = [[self.links[i].length if i < k else self.links[i].centre if i == k else 0 for i in range(n)] for k in range(n)]
        self.moments = [sum(link.mass * reach[k][i] for k, link in enumerate(self.links)) for i in range(n)]
        self.coupling = [[sum(link.mass * reach[k][i] * reach[k][j] for k, link in enumerate(self.links)) for j in range(n)] for i in range(n)]
        self.strength = [0.4 * mechanisms.GRAVITY * sum(self.moments[i:]) for i in range(n)]  # of what moves a joint [N m]

    def resistance(self, q, w):
        if self.effect == "coulomb":
            return -self.value * math.tanh(w / SHARPNESS)
        return twins.RESISTANCES[self.effect](self.value, q, w) if self.effect else 0.0

    def slope(self, torques):
        n = len(self.links)

        def at(t, y):
            phi, omega = y[:n], y[n:]
            torque = torques(t)
            torque[self.joint] += self.resistance(phi[self.joint] - (phi[self.joint - 1] if self.joint else 0), omega[self.joint] - (omega[self.joint - 1] if self.joint else 0))
            inertia, force = [], []
            for i in range(n):
                inertia.append([self.coupling[i][j] * math.cos(phi[i] - phi[j]) + (self.links[i].inertia if i == j else 0) for j in range(n)])
                force.append(torque[i] - (torque[i + 1] if i + 1 < n else 0) - mechanisms.GRAVITY * self.moments[i] * math.sin(phi[i])
                             - sum(self.coupling[i][j] * math.sin(phi[i] - phi[j]) * omega[j] ** 2 for j in range(n)))
            return omega + solved(inertia, force)

        return at

    def rows(self, chance):
        """Time, joint angles and torques; from rest, hanging askew."""
        n = len(self.links)
        waves = [[(0.4 * s * chance.uniform(0.3, 1), 2 * math.pi * chance.uniform(0.3, 1.2), chance.uniform(0, 2 * math.pi)) for _ in range(3)] for s in self.strength]
        y, rows = [chance.uniform(-0.5, 0.5) for _ in range(n)] + n * [0.0], []

        def torques(t):
            return [sum(a * math.sin(w * t + p) for a, w, p in wave) for wave in waves]

        slope = self.slope(torques)
        for i in range((SAMPLES - 1) * EVERY + 1):
            if i % EVERY == 0:
                rows.append((i * STEP, [y[k] - (y[k - 1] if k else 0) for k in range(n)], torques(i * STEP)))
            y = mechanisms.rk4(slope, i * STEP, y, STEP)
        return rows

    def table(self, rows, chance):
        names = [link.coordinate for link in self.links]
        text = ",".join(["time"] + names + [f"{name}.torque" for name in names]) + "\n"
        for t, q, torque in rows:
            text += ",".join([f"{t:.3f}"] + [f"{each + chance.gauss(0, NOISE):.7f}" for each in q] + [f"{each:.9g}" for each in torque]) + "\n"
        return text

    def urdf(self):
        text, parent, offset = '<robot name="chain"><link name="base"/>\n', "base", 0
        for link in self.links:
            text += (f'<link name="{link.body}"><inertial><origin xyz="0 0 {-link.centre!r}"/><mass value="{link.mass!r}"/>'
                     f'<inertia ixx="{link.inertia!r}" iyy="{link.inertia!r}" izz="{link.inertia!r}" ixy="0" ixz="0" iyz="0"/></inertial></link>\n'
                     f'<joint name="{link.coordinate}" type="continuous"><parent link="{parent}"/><child link="{link.body}"/><origin xyz="0 0 {-offset!r}"/><axis xyz="0 1 0"/></joint>\n')
            parent, offset = link.body, link.length
        return text + "</robot>\n"


def rms(values):
    return math.sqrt(sum(each**2 for each in values) / len(values))


def hide(chain, effect, chance):
    """Sizes from a motion without the effect, as the user knows them; returns the file of effects."""
    rows = chain.rows(chance)
    chain.joint = chance.randrange(len(chain.links))
    angle = [q[chain.joint] for _, q, _ in rows]
    speed, force = rms([(b - a) / (STEP * EVERY) for a, b in zip(angle, angle[1:])]), chain.strength[chain.joint]
    own.SIZES["chain"] = (force, speed, rms(angle))
    chain.effect, chain.value = effect, force * math.exp(chance.uniform(math.log(0.05), math.log(0.4))) if effect == "coulomb" else own.value_of(effect, "chain", chance)
    return own.file_of_effects("chain", False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--build", default="build/program")
    parser.add_argument("--links", type=int, choices=(2, 3), default=2)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sets", type=int, default=50)
    asked = parser.parse_args()
    program = (twins.TOP / asked.build / "apps/fisherhill").resolve()
    count = collections.Counter()
    print("| set | model | hidden | verdict | class | probability |\n|---|---|---|---|---|---|")
    for k in range(asked.sets):
        chance = random.Random(f"chain {asked.links} {asked.seed} {k}")
        chain, effect = Chain(asked.links, chance), EFFECTS[k % len(EFFECTS)]
        folder = asked.folder / f"chain_{asked.seed}_{k}"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "effects.toml").write_text(hide(chain, effect, chance))
        kind = ("osim", "urdf")[(k // len(EFFECTS) + k) % 2]
        (folder / f"model.{kind}").write_text(chain.urdf() if kind == "urdf" else mechanisms.osim("chain", chain.links))
        for trial in range(3):
            (folder / f"t{trial}.csv").write_text(chain.table(chain.rows(chance), chance))
        verdict = mechanisms.verdict(program, folder, "--effect", "effects.toml", model=f"model.{kind}")
        hidden = f"{chain.links[chain.joint].coordinate}.{effect}" if effect else ""
        found = verdict["effects"][0] if verdict["effects"] else None
        sure = (found["probability"] or 0) if found and verdict["verdict"] in ("named", "ambiguous", "parameter") else 0
        count["nothing" if not effect else "hidden"] += 1
        if effect:
            count["first"] += found is not None and found["id"] == hidden
            count["class"] += hidden in verdict["class"]
            count["named"] += hidden in verdict["class"] and verdict["verdict"] in ("named", "ambiguous")
        else:
            count["empty"] += verdict["verdict"] == "none"
        count["wrong"] += sure > 0.9 and hidden not in verdict["class"]
        size = ", ".join(f"{x:.3g}" for x in chain.value) if isinstance(chain.value, tuple) else f"{chain.value:.3g}"
        print(f"| {k} | {kind} | {hidden or 'nothing'} {size if effect else ''} | {verdict['verdict']} | {', '.join(verdict['class']) or '–'} | {sure:.3f} |", flush=True)
    chance = own.right_by_chance(count["class"], count["hidden"], *ROBOTS)
    print(f"\nOf {count['hidden']} hidden effects {count['class']} are in the class ({count['named']} of them named), {count['first']} first; of {count['nothing']} sets with nothing hidden {count['empty']} are empty; "
          f"{count['wrong']} confidently wrong. Probability that as few are in the class by chance: {chance:.2f}")
    sys.exit(1 if chance < 0.05 or count["wrong"] else 0)


if __name__ == "__main__":
    main()
