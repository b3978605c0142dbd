#!/usr/bin/env python3
"""Runs every command over every model with one free coordinate, and tells what did not end as a command may.

    python3 validation/models/every_command.py [--build build/program] [--quick] [--small] [FOLDER|MODEL.osim …]

Of each model one coordinate is free (with --coordinates, that many, one after another). A trial of 0.2 s is made of its muscles,
and check, moment-arms, replay, render of the replay's states, sensitivity, compare, ensemble and calibrate are run; replay and
render also with two coordinates free. A command may end with 0 (done), 1 (the answer is no) or 2 (refused) and, unless 0, says
why. Faults are: a signal, another status, no word with 1 or 2, a message of the C++ library, an option that the command does not
know. A command that exceeds --limit seconds is ended and counted, but is no fault. --small adds small
models of every class of joint, muscle and surface; --quick leaves sensitivity, compare, ensemble and calibrate to models of at
most 12 muscles. --table prints models read, simulated and refused, by reason.
Exit status 1: a fault; 2: no model.
"""
import argparse
import collections
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import small_models

TOP = pathlib.Path(__file__).resolve().parents[2]
RAW = re.compile(r"stod|stoi|stol|_M_\w+|basic_string|map::at|vector::|bad_alloc|bad_variant|bad_optional|std::|Assertion|"
                 r"terminate called|see fisherhill [\w-]+ --help|runtime error:|AddressSanitizer|unordered_map|"
                 r"Segmentation|what\(\)|__cxa")
PREFERRED = ["elbow_flexion", "r_elbow_flex", "knee_angle_r", "ankle_angle_r", "hip_flexion_r", "flexion"]
HEAVY = 12  # muscles above which --quick runs only check, moment-arms, replay and render
Outcome = collections.namedtuple("Outcome", "model command status fault words")


def parts(path):
    """Names of a model's free coordinates and of its muscles; none where the file is no XML."""
    text = path.read_text(encoding="utf-8", errors="replace")
    text = re.sub(r"<\?.*?\?>|(?<=\w)::(?=\w)", "", text)  # a declared encoding; element names as HuntCrossleyForce::…
    try:
        root = xml.etree.ElementTree.fromstring(text)
    except (xml.etree.ElementTree.ParseError, ValueError):
        return [], []
    for parent in list(root.iter()):
        for defaults in parent.findall("defaults"):  # parts that OpenSim copies, none of the model
            parent.remove(defaults)
    said = lambda element, name: (element.findtext(name) or "").strip().lower()
    free = [e.get("name") for e in root.iter("Coordinate")
            if e.get("name") and said(e, "locked") != "true" and said(e, "motion_type") != "coupled"]
    coupled = {(e.findtext("dependent_coordinate_name") or "").strip() for e in root.iter("CoordinateCouplerConstraint")}
    free = [name for name in dict.fromkeys(free) if name not in coupled]
    free.sort(key=lambda name: PREFERRED.index(name) if name in PREFERRED else len(PREFERRED))
    muscles = [e.get("name") for e in root.iter() if "Muscle" in e.tag and e.find("GeometryPath") is not None and e.get("name")]
    return free, list(dict.fromkeys(muscles))


def write_trial(path, coordinates, muscles):
    """0.2 s at 100 Hz: excitations of 0.1, the coordinates slowly moving."""
    rows = [[0.01 * k, *[0.1] * len(muscles), *[0.1 + 0.002 * k] * len(coordinates)] for k in range(21)]
    path.write_text("trial\nnRows=21\nnColumns={}\ninDegrees=no\nendheader\n{}\n{}\n".format(
        len(rows[0]), "\t".join(["time", *muscles, *coordinates]), "\n".join("\t".join(f"{x:g}" for x in row) for row in rows)))


def commands(model, coordinates, muscles, folder, quick):
    """One after another, since a picture needs the states of the replay before it."""
    free = [word for name in coordinates for word in ("--coordinate", name)]
    trial, out = folder / "trial.sto", lambda name: ["--out", str(folder / name), "--force", "--threads", "1"]
    write_trial(trial, coordinates, muscles)
    yield ["replay", model, trial, *free, *out("replay")]
    states = folder / "replay" / "states.sto"
    if states.exists():
        yield ["render", model, states, "--size", "64x64", *out("render")]
        yield ["render", model, states, "--size", "64x64", "--show-wraps", "--thickness", "fixed", *out("render_fixed")]
    if len(coordinates) > 1:
        return
    yield ["moment-arms", model, *free, "--points", "11", *out("arms")]
    if quick and len(muscles) > HEAVY:
        return
    yield ["sensitivity", model, trial, *free, "--all", *out("sensitivity")]
    yield ["compare", model, trial, *free, "--integrators", "vi,rk4", "--steps", "0.005,0.01", *out("compare")]
    yield ["ensemble", model, trial, *free, "--draws", "4", *out("ensemble")]
    if muscles:
        yield ["calibrate", model, trial, *free, "--parameters", f"{muscles[0]}.max_isometric_force", *out("calibrate")]


def run(program, command, limit):
    """Of one command: its status (None: over the limit), the fault or "", and what it said."""
    try:
        done = subprocess.run([program, *map(str, command)], capture_output=True, timeout=limit, cwd="/")
    except subprocess.TimeoutExpired:
        return None, "", f"longer than {limit} s"
    text = (done.stderr + done.stdout).decode("utf-8", "replace").strip()
    raw = RAW.search(done.stderr.decode("utf-8", "replace"))
    told = [line for line in text.splitlines() if "warning:" not in line and not line.startswith(("unusual:", " "))]
    said = next((line for line in told if line.startswith(("error:", "fisherhill"))), told[-1] if told and done.returncode else "")
    if done.returncode < 0:
        return done.returncode, f"ended by signal {-done.returncode}", said
    if raw:
        return done.returncode, f"a message of the library or of the options: {raw.group()}", said
    if done.returncode not in (0, 1, 2):
        return done.returncode, f"exit status {done.returncode}", said
    if done.returncode and not text:
        return done.returncode, "no word", said
    return done.returncode, "", said


def run_model(arguments, name, path):
    outcomes = []

    def one(command, label):
        status, fault, words = run(arguments.program, command, arguments.limit)
        outcomes.append(Outcome(name, label, status, fault, words))

    coordinates, muscles = parts(path)
    with tempfile.TemporaryDirectory() as temporary:
        one(["check", path, "--threads", "1"], "check")
        folders = [pathlib.Path(temporary) / str(k) for k in range(arguments.coordinates + 1)]
        free = [[name] for name in coordinates[:arguments.coordinates]] + ([coordinates[:2]] if len(coordinates) > 1 else [])
        for names, folder in zip(free, folders):
            folder.mkdir()
            for command in commands(path, names, muscles, folder, arguments.quick):
                one(command, " ".join([command[0], *names]))
    return outcomes


def reason(words, path):
    """A refusal without the file, place, names and numbers, so that equal ones are counted together."""
    words = re.sub(r"^(error|fisherhill [\w-]+): *", "", words.replace(str(path), ""))
    words = re.sub(r"/\S*/|line \d+:? *", "", words)
    words = re.sub(r"'[^']*'", "'…'", words)
    return re.sub(r"^[: ]*\d*[: ]*", "", re.sub(r"[-+]?\d[\d.e+-]*", "#", words))[:110]


def table(models, outcomes):
    read, simulated, refused = 0, 0, collections.Counter()
    for name, path in models:
        of = [o for o in outcomes if o.model == name]
        readable = of[0].status == 0
        read += readable
        replay = next((o for o in of if o.command.startswith("replay")), None)
        simulated += replay is not None and replay.status == 0
        if not readable:
            refused["not read: " + reason(of[0].words, path)] += 1
        elif replay is None or replay.status != 0:
            refused["not simulated: " + (reason(replay.words, path) if replay else "no coordinate is free")] += 1
    print(f"| models | {len(models)} |\n|---|---|\n| read | {read} |\n| simulated | {simulated} |")
    for words, count in refused.most_common():
        print(f"| {words} | {count} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--build", default=str(TOP / "build" / "program"), help="build folder")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--small", action="store_true", help="add small models of every class")
    parser.add_argument("--table", action="store_true", help="print counts of models read, simulated, refused")
    parser.add_argument("--list", action="store_true", help="print each command's end")
    parser.add_argument("--coordinates", type=int, default=1, help="of each model, set free one after another")
    parser.add_argument("--limit", type=float, default=30, help="seconds of one command")
    parser.add_argument("--jobs", type=int, default=min(2, os.cpu_count() or 1))
    parser.add_argument("places", nargs="*", type=pathlib.Path)
    arguments = parser.parse_args()
    arguments.program = str((pathlib.Path(arguments.build) / "apps" / "fisherhill").resolve())
    with tempfile.TemporaryDirectory() as temporary:
        found = [p.resolve() for place in arguments.places
                 for p in (sorted(place.rglob("*.osim")) if place.is_dir() else [place])]
        if arguments.small:
            for name, text in small_models.all_models().items():
                path = pathlib.Path(temporary) / f"{name}.osim"
                path.write_text(text)
                found.append(path)
        if not found:
            print("every_command: no model is given or found", file=sys.stderr)
            return 2
        models = [(str(path), path) for path in found]
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            outcomes = [o for of in pool.map(lambda m: run_model(arguments, *m), models) for o in of]
        faults = [o for o in outcomes if o.fault]
        for o in outcomes if arguments.list else faults:
            print(f"{pathlib.Path(o.model).name}: {o.command}: {'over the limit' if o.status is None else o.status}"
                  f"{': ' + o.fault if o.fault else ''}{': ' + o.words if o.words else ''}")
        ends = collections.Counter("over the limit" if o.status is None else str(o.status) for o in outcomes)
        print(f"{len(models)} models, {len(outcomes)} commands: " + ", ".join(f"{n} ended with {s}" if s != "over the limit" else
              f"{n} were over {arguments.limit:g} s" for s, n in sorted(ends.items())) + f"; {len(faults)} faults")
        if arguments.table:
            table(models, outcomes)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
