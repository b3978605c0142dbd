#!/usr/bin/env python3
"""Blind sets for discover in several families of models: makes them, runs discover on them, and has them scored.

    python3 validation/discovery/families/make_sets.py [--build build/program] [--models ../shared/data/models/opensim] [--family NAME ...] [--seed 10000] [--sets 12]
        [--seconds S] [--jobs 2] FOLDER

Families: shoulder and torque (the shipped elbow with its shoulder free; on a dynamometer), and of the models in --models arm26, leg, millard and degroote. Set S of a family
is always the same; what is already there is not made or searched again. Of each twelve sets in turn three hide nothing, six one effect, one two effects, one something outside
the catalogue, and one an effect that discover is told to leave out. Subjects and what is hidden: subject.py. Excitations are random pulses played in open loop, the limb starts
at rest but not in balance; on a dynamometer there are an isometric, an isokinetic and a passive trial, and an isokinetic one held out. 0.5° of noise in angles, 0.3 N m in
moments. A trial is drawn again, up to 12 times, until the nominal model is within 40° RMS (20 N m) of it; then the nearest is taken. One that cannot be simulated or leaves
its limits is drawn again up to 100 times; then the set is left out, and a line says so.

FOLDER/FAMILY holds data, sealed (labels), verdicts and score.json; FOLDER/together the same sets of all families, whose line ends the table that is printed. Seeds below 10000 are for development. Exit status as that of score_discovery: 1 if a target is missed.
"""
import argparse
import concurrent.futures
import json
import math
import pathlib
import random
import subprocess
import sys

import subject

TOP = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(TOP / "validation/discovery"))
from opensim_sets import table
ROW = 0.01  # [s]
DRAWS, MOST_DRAWS = 12, 100  # of a trial; the second while none can be simulated within the limits
ELBOW = {"TRIlong": "e", "TRIlat": "e", "TRImed": "e", "ANC": "e", "BIClong": "f", "BICshort": "f", "BRA": "f", "BRD": "f"}
HEADS = {"TRI": ["TRIlong", "TRIlat", "TRImed"], "BIC": ["BIClong", "BICshort"], "BRA": ["BRA"]}


class Family:
    """coordinates: where they start [deg]; limits: beyond which a trial is drawn again; muscles: the group of each; levels of excitation of a group."""

    def __init__(self, model, coordinates, limits, muscles, levels, tip, swaps, seconds, size, heavy=1.0, strong=None, kinds=(), options=(), torque=False):
        self.model, self.coordinates, self.limits, self.muscles, self.levels = model, coordinates, limits, muscles, levels
        self.tip, self.swaps, self.seconds, self.size, self.heavy, self.strong = tip, swaps, seconds, size, heavy, strong or HEADS
        self.torque, self.options, self.farthest = torque, list(options), 20 if torque else 40
        joint = ["visc", "coulomb", "stiffness", "bias"]
        self.kinds = list(kinds) or ["payload", "delay", "tilt", "swap", "strength"] + [f"{q}.{kind}" for q in coordinates for kind in joint]

    def chosen(self):
        return ["--prescribe", *self.coordinates] if self.torque else [word for q in self.coordinates for word in ("--coordinate", q)] + self.options


def elbow(model, **more):
    return Family(model, {"elbow_flexion": (20, 110)}, {"elbow_flexion": (-5, 135)}, ELBOW, {"e": (0.01, 0.05), "f": (0.045, 0.11)}, "hand",
                  [("BRA", "TRIlong"), ("BIClong", "TRIlat"), ("BRD", "TRImed")], 4.5, {"elbow_flexion": 1}, **more)


LEG = ["hamstrings_r", "bifemsh_r", "glut_max_r", "iliopsoas_r", "rect_fem_r", "vasti_r", "gastroc_r", "soleus_r", "tib_ant_r"]
FAMILIES = {
    "shoulder": Family("elbow8.osim", {"elbow_flexion": (20, 100), "shoulder_elv": (0, 25)}, {"elbow_flexion": (-5, 135), "shoulder_elv": (-60, 120)}, ELBOW,
                       {"e": (0.01, 0.05), "f": (0.045, 0.11)}, "hand", [("BRA", "TRIlong"), ("BIClong", "TRIlat")], 3.0, {"elbow_flexion": 1, "shoulder_elv": 1.5}),
    "arm26": Family("arm26.osim", {"r_shoulder_elev": (-20, 50), "r_elbow_flex": (20, 90)}, {"r_shoulder_elev": (-80, 120), "r_elbow_flex": (2, 128)},
                    {"TRIlong": "m", "TRIlat": "m", "TRImed": "m", "BIClong": "m", "BICshort": "m", "BRA": "m"}, {"m": (0.03, 0.13)}, "r_ulna_radius_hand",
                    [("BRA", "TRIlong"), ("BIClong", "TRIlat")], 2.0, {"r_shoulder_elev": 2, "r_elbow_flex": 1}, strong={m: [m] for m in ("TRIlong", "BIClong", "BRA")}),
    "millard": elbow("elbow8_Millard.osim"),
    "degroote": elbow("elbow8_DeGrooteFregly.osim"),
    "leg": Family("gait10dof18musc.osim", {"knee_angle_r": (-90, -50), "ankle_angle_r": (-20, 10)}, {"knee_angle_r": (-118, -8), "ankle_angle_r": (-48, 34)},
                  {m: "c" if m in ("gastroc_r", "soleus_r") else "m" for m in LEG}, {"m": (0.02, 0.16), "c": (0.005, 0.04)}, "toes_r",
                  [("hamstrings_r", "vasti_r"), ("tib_ant_r", "rect_fem_r")], 1.5, {"knee_angle_r": 2.5, "ankle_angle_r": 1.5}, heavy=2.0,
                  strong={m: [m] for m in ("hamstrings_r", "vasti_r", "tib_ant_r")}, options=["--lock", "hip_flexion_r=1.1"]),
    "torque": Family("elbow8.osim", {"elbow_flexion": (40, 100)}, {}, ELBOW, {"e": (0.25, 0.45), "f": (0.25, 0.45)}, "hand", [], 4.0, {"elbow_flexion": 1},
                     kinds=["visc", "payload", "strength", *subject.OF_MOMENT, "delay"], torque=True),
}


def interpolated(times, from_times, values):
    """Linear between rows, and as the first or last row outside."""
    found, k = [], 0
    for t in times:
        while k < len(from_times) - 2 and from_times[k + 1] < t:
            k += 1
        share = min(max((t - from_times[k]) / (from_times[k + 1] - from_times[k]), 0), 1)
        found.append((1 - share) * values[k] + share * values[k + 1])
    return found


def write(path, names, columns):
    path.write_text(",".join(names) + "\n" + "".join(",".join(f"{x:.7g}" for x in row) + "\n" for row in zip(*columns)))


def simulate(program, model, trial, out, family, start, step="0.001"):
    initial = [word for q, value in start.items() for word in ("--initial", f"{q}={value:.6g}deg")]
    ran = subprocess.run([program, "replay", model, trial, "--out", out, "--force", "--step", step, "--threads", "1", *family.chosen(), *initial],
                         capture_output=True, text=True, check=False)
    return ran.returncode == 0


def pulses(draw, seconds, low, high):
    """Base level, and raised cosines of half to one and a half seconds; peak somewhere up to the highest level."""
    base, width = low * draw.uniform(1, 1.6), draw.uniform(0.25, 0.75)
    bumps = [(draw.uniform(0, seconds), width * draw.uniform(0.7, 1.3), (high - base) * draw.uniform(0.3, 1)) for _ in range(max(1, round(seconds / 1.2)))]
    return [base + max(h * (0.5 + 0.5 * math.cos(math.pi * (t - at) / w)) if abs(t - at) < w else 0 for at, w, h in bumps)
            for t in (ROW * k for k in range(round(seconds / ROW) + 1))]


def raised(t, begin, rise):
    """From 0 to 1, smooth to the second derivative."""
    s = min(max((t - begin) / rise, 0), 1)
    return s * s * s * (10 - 15 * s + 6 * s * s)


def excitations(draw, family):
    seconds = family.seconds
    of_group = {group: pulses(draw, seconds, *levels) for group, levels in family.levels.items()}
    found = []
    for muscle, group in family.muscles.items():
        own = pulses(draw, seconds, *family.levels[group])
        share, factor = (0.75, draw.uniform(0.85, 1.15)) if len(family.levels) > 1 and group != "m" else (0, 1)
        found.append([factor * (share * u + (1 - share) * v) for u, v in zip(of_group[group], own)])
    return found


def contraction(draw, family, passive, isometric):
    """Excitations and angle [deg] on a dynamometer."""
    time = [ROW * k for k in range(round(family.seconds / ROW) + 1)]
    active, peak, quick = draw.choice("ef"), draw.uniform(*family.levels["f"]), family.seconds / 4
    found = []
    for group in family.muscles.values():
        top = 0 if passive else peak * draw.uniform(0.8, 1.1) * (1 if group == active else 0.13)
        found.append([0.012 + top * (raised(t, 0.1 * quick, 0.5 * quick) - raised(t, 3.1 * quick, 0.5 * quick)) for t in time])
    begin, end = draw.uniform(40, 105), draw.uniform(40, 105)
    while abs(end - begin) < 20:
        end = draw.uniform(40, 105)
    at, rise = draw.uniform(0.9, 1.5) * quick, draw.uniform(0.3, 0.8) * quick
    return found, [begin if isometric else begin + (end - begin) * raised(t, at, rise) for t in time]


def bend_of(angle):
    inner = [math.radians(a - 2 * b + c) / ROW ** 2 for a, b, c in zip(angle, angle[1:], angle[2:])]
    return inner[:1] + inner + inner[-1:]


def distance(one, other):
    return math.sqrt(sum((a - b) ** 2 for x, y in zip(one, other) for a, b in zip(x, y)) / sum(map(len, one)))


class Trial:
    """One draw of a trial; shown: measured columns without noise, None where it cannot be used; far: how far the nominal model is from it."""

    def __init__(self, program, folder, family, nominal, hidden, draw, place):
        self.time = [ROW * k for k in range(round(family.seconds / ROW) + 1)]
        self.shown, self.far, self.angle = None, math.inf, None
        if family.torque:
            self.given, self.angle = contraction(draw, family, place == 2, place == 0)
            self.names, start = [f"{q}.moment" for q in family.coordinates], {}
        else:
            self.given, start = excitations(draw, family), {q: draw.uniform(*where) for q, where in family.coordinates.items()}
            self.names = [f"{q}_deg" for q in family.coordinates]
        delay = sum(h.delay for h in hidden)
        driven = [interpolated([t - delay for t in self.time], self.time, u) for u in self.given]
        motions = []
        for model, inputs in ((folder / "hidden.osim", driven), (nominal, self.given)):
            angle = [(f"{next(iter(family.coordinates))}_deg", self.angle)] if family.torque else []
            write(folder / "driven.csv", ["time", *family.muscles, *(n for n, _ in angle)], [self.time, *inputs, *(a for _, a in angle)])
            if not simulate(program, model, folder / "driven.csv", folder / "replay", family, start):
                return
            columns, rows = table(folder / "replay" / ("forces.sto" if family.torque else "states.sto"))
            values = list(zip(*rows))
            places = [next(k for k, c in enumerate(columns) if c.endswith(f"{q}.reaction" if family.torque else f"/{q}/value")) for q in family.coordinates]
            turned = (lambda x: -x) if family.torque else math.degrees
            motions.append([[turned(x) for x in interpolated(self.time, values[0], values[k])] for k in places])
        for (low, high), shown in zip(family.limits.values(), motions[0]):
            if min(shown) < low or max(shown) > high:
                return
        self.shown, self.far = motions[0], distance(*motions)
        for h in hidden:
            for q, change in h.recorded.items():
                k = list(family.coordinates).index(q)
                if family.torque:
                    self.shown[k] = change(self.shown[k], self.angle, bend_of(self.angle))
                else:
                    self.shown[k] = [change(x) for x in self.shown[k]]

    def write(self, path, family, hidden, draw):
        given = dict(zip(family.muscles, self.given))
        for h in hidden:
            if h.swapped:
                one, other = h.swapped
                given[one], given[other] = given[other], given[one]
        shown = [[draw.gauss(x, 0.3 if family.torque else 0.5) for x in column] for column in self.shown]
        angle = [(f"{next(iter(family.coordinates))}_deg", self.angle)] if family.torque else []
        write(path, ["time", *given, *(n for n, _ in angle), *self.names], [self.time, *given.values(), *(a for _, a in angle), *shown])


def one_hidden(family, kind, draw):
    if kind in subject.OF_MOMENT:
        return subject.of_moment(next(iter(family.coordinates)), kind, draw)
    if kind == "visc":
        kind = f"{next(iter(family.coordinates))}.visc"
    if "." in kind:
        return subject.of_coordinate(family, *kind.split("."), draw)
    return subject.of_model(family, kind, draw)


def plan(family, seed, draw):
    """Suite, what is hidden, and the ids that discover is to leave out."""
    place, kinds = seed % 12, family.kinds
    in_turn = kinds[(seed // 12 * 6 + place - 3) % len(kinds)]
    if place < 3:
        return "null", [], []
    if place < 9:
        return "single", [one_hidden(family, in_turn, draw)], []
    if place == 9:
        one, other = draw.sample([k for k in kinds if k not in ("tilt", "swap")], 2)
        return "two", [one_hidden(family, one, draw), one_hidden(family, other, draw)], []
    if place == 10:
        return "out", [subject.out_of_catalogue(family, draw)], []
    hidden = one_hidden(family, draw.choice([k for k in kinds if k not in ("tilt", "swap", "strength")]), draw)
    return "out", [hidden], [hidden.label["id"], *hidden.label["equivalents"], *hidden.like]


class NotMade(Exception):
    pass


def make(program, models, folder, name, seed):
    """Data and label of a set; nothing where they are."""
    family, data, label = FAMILIES[name], folder / f"data/s{seed}", folder / f"sealed/s{seed}.json"
    nominal = models[family.model]
    if label.exists():
        return nominal
    draw = random.Random(f"{name}/{seed}")
    suite, hidden, without = plan(family, seed, draw)
    person = subject.Subject(nominal)
    person.depart(draw, family.muscles)
    for h in hidden:
        h.subject(person)
    data.mkdir(parents=True, exist_ok=True)
    label.parent.mkdir(parents=True, exist_ok=True)
    person.write(data / "hidden.osim")
    count, far = 4 if family.torque else 3, []
    for place in range(count):
        best = None
        for attempt in range(MOST_DRAWS):
            trial = Trial(program, data, family, nominal, hidden, draw, place)
            if trial.shown and (best is None or trial.far < best.far):
                best = trial
            if best and (attempt >= DRAWS - 1 or best.far < family.farthest):
                break
        if best is None:
            raise NotMade(f"{name} {seed}: not made, no trial of this subject stays within its limits")
        far.append(best.far)
        best.write(data / (f"train_{place}.csv" if place < count - 1 else "held_out.csv"), family, hidden, draw)
    for made in ("hidden.osim", "driven.csv"):
        (data / made).unlink()
    for made in (data / "replay").iterdir():
        made.unlink()
    (data / "replay").rmdir()
    label.write_text(json.dumps({"suite": suite, "family": name, "size": 1, "emg_noise": 0, "effects": [h.label for h in hidden], "left_out": without, "strength": far}, indent=1))
    return nominal


def look(program, models, folder, name, seed):
    try:
        nominal, out = make(program, models, folder, name, seed), folder / f"verdicts/s{seed}"
    except NotMade as why:
        print(why, flush=True)
        return
    if (out / "verdict.json").exists() and json.loads((out / "verdict.json").read_text())["verdict"] != "stopped":
        return
    data, without = folder / f"data/s{seed}", json.loads((folder / f"sealed/s{seed}.json").read_text())["left_out"]
    out.parent.mkdir(parents=True, exist_ok=True)
    with open(f"{out}.txt", "w", encoding="utf-8") as said:
        subprocess.run([program, "discover", nominal, *sorted(data.glob("train_*.csv")), "--hold-out", data / "held_out.csv", *FAMILIES[name].chosen(), "--threads", "1",
                        *(["--without", ",".join(without)] if without else []), "--force", "--out", out], stdout=said, stderr=subprocess.STDOUT, check=False)
    print(f"{name} {seed}", flush=True)


def scored(score, folder):
    return subprocess.run([score, "--labels", folder / "sealed", "--verdicts", folder / "verdicts", "--json", folder / "score.json"], check=False).returncode


def together(folder, names):
    """Links to the sets of all families."""
    for kind in ("sealed", "verdicts"):
        (folder / "together" / kind).mkdir(parents=True, exist_ok=True)
        for old in (folder / "together" / kind).iterdir():
            old.unlink()
        for name in names:
            for one in (folder / name / kind).iterdir():
                (folder / "together" / kind / f"{name}_{one.name}").symlink_to(one.resolve())


COLUMNS = {"named where nothing is hidden": "false alarms on null data", "right first, detectable single": "the same, clean, full size, not called too small to see",
           "right first, all single": "right name first, clean EMG, full size", "truth in class, of detected": "truth inside the class, of those detected",
           "two: both named": "two effects: both named", "out of catalogue: no unqualified name": "out of catalogue: no unqualified name",
           "confidently wrong": "confidently wrong", "95 % interval covers": "95 % interval covers the truth"}


def summary(folder, names):
    """A line of each family's score."""
    yield "| family | " + " | ".join(COLUMNS) + " | processor, median, largest |"
    yield "|---" * (len(COLUMNS) + 2) + "|"
    for name in names:
        score = json.loads((folder / name / "score.json").read_text())
        shares, spreads = ({one["metric"]: one for one in score[kind]} for kind in ("shares", "spreads"))
        time = spreads["time per data set"]
        cells = []
        for metric in COLUMNS.values():
            one = shares[metric]
            cells.append(f"{one['k']} of {one['n']}" + (f" ({100 * one['wilson_low']:.0f}–{100 * one['wilson_high']:.0f} %)" if one["n"] >= 20 else ""))
        yield f"| {name} | " + " | ".join(cells) + (f" | {time['median']:.0f}, {time['greatest']:.0f} s |" if time["n"] else " | – |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--build", default="build/program", type=pathlib.Path)
    parser.add_argument("--models", default=TOP.parent / "shared/data/models/opensim", type=pathlib.Path)
    parser.add_argument("--family", choices=sorted(FAMILIES), action="append")
    parser.add_argument("--seed", type=int, default=10000)
    parser.add_argument("--sets", type=int, default=12)
    parser.add_argument("--seconds", type=float, help="shorter trials than the families have, which are other sets")
    parser.add_argument("--jobs", type=int, default=2)
    asked = parser.parse_args()
    program, names = (TOP / asked.build / "apps/fisherhill").resolve(), asked.family or list(FAMILIES)
    for name in names if asked.seconds else []:
        FAMILIES[name].seconds = asked.seconds
    models = {family.model: (TOP / "models" if family.model == "elbow8.osim" else asked.models) / family.model for family in FAMILIES.values()}
    missing = sorted({str(models[FAMILIES[name].model]) for name in names if not models[FAMILIES[name].model].exists()})
    if missing:
        parser.error(f"there is no {missing[0]}; --models names the folder")
    with concurrent.futures.ThreadPoolExecutor(asked.jobs) as pool:
        for done in [pool.submit(look, program, models, asked.folder / name, name, seed) for seed in range(asked.seed, asked.seed + asked.sets) for name in names]:
            done.result()
    score = TOP / asked.build / "validation/discovery/score_discovery"
    for name in names:
        print(f"\n{name}\n", flush=True)
        scored(score, asked.folder / name)
    together(asked.folder, names)
    print("\ntogether\n", flush=True)
    status = scored(score, asked.folder / "together")
    print("\n" + "\n".join(summary(asked.folder, [*names, "together"])))
    sys.exit(status)


if __name__ == "__main__":
    main()
