#!/usr/bin/env python3
"""Blind sets for discover on two free joints, and on a dynamometer that reads a torque.

    python3 validation/discovery/joints_and_torque.py [--build build/program] [--sets 3] [--seed S] [--world joints|torque] [--kind ID] [--seconds 4.5] FOLDER

Each set has a training and a held-out trial of 4.5 s (--seconds) at 100 Hz, simulated by `replay` of the shipped elbow with one effect hidden in it, drawn at
random: damping of the elbow (or of the shoulder, where that is free), a mass in the hand, an electromechanical delay, or nothing; of "torque" also weight
or inertia of the dynamometer's lever, gain, bias or lag of its sensor (--kind: one of them). "joints": shoulder and elbow free, both angles measured with
0.3° of noise. "torque": the elbow turned by 40° to and fro, its moment measured with 0.2 N m of noise.
discover sees the files only; the truths are written to FOLDER/truths.json and read after all verdicts are there. Prints one line per set and a count.
Without --seed the sets are new ones. Exit status 1: a wrong name.
"""
import argparse
import bisect
import json
import math
import pathlib
import random
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
MODEL = TOP / "models/elbow8.osim"
WORLDS = ("joints", "torque")
# what discover may call it: the effect, or a class that holds it
NAMES = {"payload": {"payload", "mass"}, "delay": {"delay", "clock"}, "bias": {"bias", "const"}}
# of the recorded moment: sizes from … to …
MACHINE = {"lever_weight": (1.5, 5), "lever_inertia": (0.08, 0.3), "gain": (0.15, 0.3), "bias": (1, 3), "lag": (0.03, 0.08)}


def table(path):
    lines = path.read_text().splitlines()
    begin = [k for k, line in enumerate(lines) if line.strip() == "endheader"][0] + 1
    rows = [[float(x) for x in line.split("\t")] for line in lines[begin + 1:] if line.strip()]
    return lines[begin].split("\t"), list(zip(*rows))


def interpolated(times, from_times, values):
    """Linear between rows, and as the first or last row outside."""
    found = []
    for t in times:
        k = min(max(bisect.bisect_right(from_times, t) - 1, 0), len(from_times) - 2)
        share = min(max((t - from_times[k]) / (from_times[k + 1] - from_times[k]), 0), 1)
        found.append((1 - share) * values[k] + share * values[k + 1])
    return found


def write(path, names, columns):
    path.write_text(",".join(names) + "\n" + "".join(",".join(f"{x:.8g}" for x in row) + "\n" for row in zip(*columns)))


def damped(text, coordinate, viscosity):
    spring = (f'<SpringGeneralizedForce name="hidden"><appliesForce>true</appliesForce><coordinate>{coordinate}</coordinate>'
              f"<stiffness>0</stiffness><rest_length>0</rest_length><viscosity>{viscosity}</viscosity></SpringGeneralizedForce>")
    at = text.index("<objects>", text.index("<ForceSet")) + len("<objects>")
    return text[:at] + spring + text[at:]


def loaded(text, mass):
    begin = text.index("<mass>", text.index('<Body name="hand"')) + len("<mass>")
    end = text.index("<", begin)
    return text[:begin] + repr(float(text[begin:end]) + mass) + text[end:]


def kinds(world):
    return ["nothing", "payload", "elbow_flexion.visc", "delay"] + (["shoulder_elv.visc"] if world == "joints" else list(MACHINE))


def hide(world, draw, text, asked):
    """An effect by its id, its size, the model with it and the delay of the muscles [s]."""
    kind = asked or draw.choice(kinds(world))
    if kind == "nothing":
        return kind, 0.0, text, 0.0
    if kind in MACHINE:
        return kind, draw.uniform(*MACHINE[kind]), text, 0.0
    if kind == "payload":
        mass = draw.uniform(0.25, 0.9)
        return kind, mass, loaded(text, mass), 0.0
    if kind == "delay":
        delay = draw.uniform(0.03, 0.08)
        return kind, delay, text, delay
    viscosity = draw.uniform(0.3, 1.0)
    return kind, viscosity, damped(text, kind.split(".")[0], viscosity), 0.0


def as_recorded(kind, size, moment, angle, bend):
    """The moment [N m] as the dynamometer of a kind records it: a lever that is level at 20°, an acceleration bend [rad/s^2], rows of 0.01 s."""
    if kind == "lever_weight":
        return [m + size * math.cos(math.radians(q - 20)) for m, q in zip(moment, angle)]
    if kind == "lever_inertia":
        return [m - size * b for m, b in zip(moment, bend)]
    if kind == "gain":
        return [(1 + size) * m for m in moment]
    if kind == "bias":
        return [m + size for m in moment]
    if kind == "lag":
        shown = moment[:1]
        for m in moment[1:]:
            shown.append(m + (shown[-1] - m) * math.exp(-0.01 / size))
        return shown
    return moment


def options(world):
    return ["--prescribe", "elbow_flexion"] if world == "torque" else ["--coordinate", "elbow_flexion", "--coordinate", "shoulder_elv"]


def make_trial(program, folder, name, world, model, hidden, delay, source, frequency, phase, seconds, draw):
    columns, recorded = table(TOP / f"emg_data/{source}.sto")
    muscles, time = columns[1:9], [0.01 * k for k in range(round(100 * seconds) + 1)]
    excitations = [interpolated(time, recorded[0], recorded[k]) for k in range(1, 9)]
    if world == "torque":
        excitations = [[min(max(2.5 * u, 0.01), 0.9) for u in one] for one in excitations]
    driven = [interpolated([t - delay for t in time], time, one) for one in excitations]
    angle = [70 + 40 * math.sin(2 * math.pi * frequency * t + phase) for t in time]
    given = [angle] if world == "torque" else []
    write(folder / "driven.csv", ["time", *muscles] + ["elbow_flexion_deg"] * len(given), [time, *driven, *given])
    start = [] if given else ["--initial", "elbow_flexion=30deg", "--initial", "shoulder_elv=15deg"]
    ran = subprocess.run([program, "replay", folder / model, folder / "driven.csv", "--out", folder / "replay", "--force", "--step", "0.0025",
                          *options(world), *start], capture_output=True, text=True, check=False)
    if ran.returncode not in (0, 1):
        sys.exit(ran.stderr)
    if world == "torque":
        columns, simulated = table(folder / "replay/forces.sto")
        moment = [-r for r in interpolated(time, simulated[0], simulated[columns.index("elbow_flexion.reaction")])]
        bend = [math.radians(70 - q) * (2 * math.pi * frequency) ** 2 for q in angle]
        shown, names = [angle, [draw.gauss(m, 0.2) for m in as_recorded(*hidden, moment, angle, bend)]], ["elbow_flexion_deg", "elbow_flexion.moment"]
    else:
        columns, simulated = table(folder / "replay/states.sto")
        names, shown = ["elbow_flexion_deg", "shoulder_elv_deg"], []
        for coordinate in ("elbow_flexion", "shoulder_elv"):
            place = next(k for k, column in enumerate(columns) if column.endswith(coordinate + "/value"))
            shown.append([draw.gauss(math.degrees(q), 0.3) for q in interpolated(time, simulated[0], simulated[place])])
    write(folder / f"{name}_{source}.csv", ["time", *muscles, *names], [time, *excitations, *shown])


def judged(kind, verdict):
    """right: the name or a class that holds it, and no other; missed: no name; wrong: another name."""
    named = {effect["id"] for effect in verdict["effects"]}
    if kind == "nothing":
        return "wrong" if named else "right"
    if not named:
        return "missed"
    short = kind.split(".")[1] if "." in kind else kind
    return "right" if named <= NAMES.get(kind, set()) | {kind, short} else "wrong"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--build", default="build/program")
    parser.add_argument("--sets", type=int, default=3)
    parser.add_argument("--seed", type=int)
    parser.add_argument("--world", choices=WORLDS)
    parser.add_argument("--kind", choices=sorted({*kinds("joints"), *kinds("torque")}))
    parser.add_argument("--seconds", type=float, default=4.5)
    asked = parser.parse_args()
    worlds = [asked.world] if asked.world else [world for world in WORLDS if not asked.kind or asked.kind in kinds(world)]
    if asked.kind and not all(asked.kind in kinds(world) for world in worlds):
        parser.error(f"--kind {asked.kind}: --world must not be {asked.world}")
    program = (TOP / asked.build / "apps/fisherhill").resolve()
    draw = random.Random(asked.seed)
    asked.folder.mkdir(parents=True, exist_ok=True)
    truths, counts = {}, {}
    for number in range(asked.sets):
        for world in worlds:
            name = f"{world}{number}"
            kind, size, text, delay = hide(world, draw, MODEL.read_text(), asked.kind)
            truths[name] = (kind, size)
            (asked.folder / "hidden.osim").write_text(text)
            for source, frequency, phase in (("curl_slow", 0.25, 0.0), ("curl_fast", 0.4, 1.0)):
                make_trial(program, asked.folder, name, world, "hidden.osim", truths[name], delay, source, frequency, phase, asked.seconds, draw)
    (asked.folder / "truths.json").write_text(json.dumps(truths, indent=1))
    (asked.folder / "hidden.osim").unlink()
    for name in truths:
        subprocess.run([program, "discover", MODEL, asked.folder / f"{name}_curl_slow.csv", "--hold-out", asked.folder / f"{name}_curl_fast.csv",
                        *options(name.rstrip("0123456789")), "--out", asked.folder / name, "--force"], capture_output=True, check=False)
    for name, (kind, size) in truths.items():
        verdict = json.loads((asked.folder / name / "verdict.json").read_text())
        outcome = judged(kind, verdict)
        counts[outcome] = counts.get(outcome, 0) + 1
        print(f"{name}: hidden {kind} {size:.3g}; {outcome}: {verdict['sentence'].split('. ')[0]}; {verdict['wall_s']:.0f} s")
    print(", ".join(f"{count} {outcome}" for outcome, count in sorted(counts.items())))
    sys.exit(1 if counts.get("wrong") else 0)


if __name__ == "__main__":
    main()
