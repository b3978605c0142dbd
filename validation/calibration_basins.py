#!/usr/bin/env python3
"""One wrong number, found from motions far from the model's: does `calibrate` reach the truth's basin?

    validation/calibration_basins.py build/release OUT FIRST_SEED SETS

Each set: a wrap radius, a muscle's maximum force or a coordinate of a path point of models/elbow8.osim
is off by 1.5 to 3.5 standard deviations of its default prior. Three training trials and a held-out one
of 4.5 s: flexors and extensors receive random pulses without feedback, the arm starts at rest between
20 and 110 degrees and not in balance, the angle has 0.5 degrees of noise and is rounded to 0.01. Trials
are simulated with CVODE; one is drawn again where the arm leaves -12 to 140 degrees, or where the
model as it is differs by more than 40 degrees (RMS). `calibrate` then estimates the wrong number alone.

Counts: RMS of the residuals at most 1.1 times the noise on training and on held-out trials; 95 %
intervals that hold the truth, of those given. Results stay in OUT; sets that are there are not made again.
"""
import json
import math
import pathlib
import random
import re
import subprocess
import sys

MODEL = pathlib.Path(__file__).resolve().parent.parent / "models" / "elbow8.osim"
MUSCLES = ["TRIlong", "TRIlat", "TRImed", "ANC", "BIClong", "BICshort", "BRA", "BRD"]
NOISE = 0.5
# the number, its standard deviation (of the default priors), and where it stands in the file
POINTS = ["BRA-P4", "TRIlong-P5", "BRD-P3", "BICshort-P7"]


def in_element(text, kind, name, tag):
    """Span of the text of <tag> in the element of that kind and name."""
    start = re.search(rf'<{kind} name="{re.escape(name)}">', text).end()
    found = re.compile(rf"<{tag}>\s*([^<]*?)\s*</{tag}>").search(text, start)
    return found.span(1)


def draw_error(rng, text):
    """(parameter, true value, model's text with it)"""
    size = rng.choice([-1, 1]) * rng.uniform(1.5, 3.5)
    kind = rng.choice(["radius", "force", "force", "point"])
    if kind == "radius":
        name = "TRI"
        a, b = in_element(text, "WrapCylinder", name, "radius")
        value = float(text[a:b])
        true = value + size * 0.15 * value
        if true > 0.0208:  # a path point would come inside
            true = value - abs(size) * 0.15 * value
        return f"{name}.radius", true, text[:a] + repr(true) + text[b:]
    if kind == "force":
        muscle = rng.choice(MUSCLES)
        a, b = in_element(text, "Schutte1993Muscle_Deprecated", muscle, "max_isometric_force")
        value = float(text[a:b])
        true = value * max(0.1, 1 + size * 0.3)
        return f"{muscle}.max_isometric_force", true, text[:a] + repr(true) + text[b:]
    point = rng.choice(POINTS)
    muscle, number = point.split("-P")
    a, b = in_element(text, "PathPoint", point, "location")
    place = [float(word) for word in text[a:b].split()]
    place[0] += size * 0.005
    words = " ".join(repr(x) for x in place)
    return f"{muscle}.point{number}.x", place[0], text[:a] + words + text[b:]


def pulses(rng, until, highest):
    bumps = []
    t = rng.uniform(-0.2, 0.6)
    while t < until:
        width = rng.uniform(0.5, 1.4)
        bumps.append((t, min(width, until - t), rng.uniform(0.2, 1) * highest))
        t += width * rng.uniform(0.6, 1.4)
    return lambda t: sum(h * math.sin(math.pi * (t - s) / w) ** 2
                         for s, w, h in bumps if s < t < s + w)


def draw_trial(rng):
    until = rng.choice([3.0, 5.5, 5.5, 5.5])
    flexing, extending = pulses(rng, until, rng.uniform(0.03, 0.12)), \
        pulses(rng, until, rng.uniform(0.01, 0.05))
    tone = [rng.uniform(0.005, 0.012)] * 4 + [rng.uniform(0.025, 0.06)] * 4
    share = [rng.uniform(0.8, 1.2) for _ in MUSCLES]
    start = rng.uniform(20, 110)
    rows = []
    for k in range(451):
        t = 0.01 * k
        drive = [extending(t)] * 4 + [flexing(t)] * 4
        rows.append([t] + [round(min(1, tone[i] + share[i] * drive[i]), 5) for i in range(8)])
    return start, rows


def write_trial(path, rows, angles):
    with open(path, "w") as out:
        out.write("trial\nversion=1\ninDegrees=yes\nendheader\n")
        out.write("\t".join(["time"] + MUSCLES + ["elbow_flexion"]) + "\n")
        for row, angle in zip(rows, angles):
            out.write("\t".join(f"{x:.6g}" for x in row + [angle]) + "\n")


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True)


def motion(program, model, trial, start, folder, integrator):
    done = run(program, "replay", model, trial, "--integrator", integrator, "--initial",
               f"elbow_flexion={start}deg", "--out", folder, "--force")
    if done.returncode != 0:
        return None
    lines = (folder / "states.sto").read_text().splitlines()
    head = next(i for i, line in enumerate(lines) if line.strip() == "endheader")
    names = lines[head + 1].split("\t")
    column = next(i for i, name in enumerate(names) if "elbow_flexion" in name
                  and ("value" in name or name.endswith("elbow_flexion")))
    rows = [[float(word) for word in line.split("\t")] for line in lines[head + 2:]]
    times, angles = [r[0] for r in rows], [math.degrees(r[column]) for r in rows]
    out, k = [], 0
    for i in range(451):
        t = 0.01 * i
        while k + 2 < len(times) and times[k + 1] < t - 1e-9:
            k += 1
        w = (t - times[k]) / (times[k + 1] - times[k])
        out.append((1 - w) * angles[k] + w * angles[k + 1])
    return out


def make(program, folder, seed):
    rng = random.Random(seed)
    parameter, true, text = draw_error(rng, MODEL.read_text())
    folder.mkdir(parents=True, exist_ok=True)
    truth = folder / "truth.osim"
    truth.write_text(text)
    trials = []
    while len(trials) < 4:
        start, rows = draw_trial(rng)
        path = folder / f"trial_{len(trials)}.sto"
        write_trial(path, rows, [start] * 451)
        motions = [motion(program, model, path, start, folder / "run", how)
                   for model, how in ((truth, "cvode"), (MODEL, "vi"))]
        if None in motions or min(motions[0]) < -12 or max(motions[0]) > 140:
            continue
        apart = math.sqrt(sum((a - b) ** 2 for a, b in zip(*motions)) / 451)
        if apart > 40:
            continue
        write_trial(path, rows, [round(a + rng.gauss(0, NOISE), 2) for a in motions[0]])
        trials.append(apart)
    return {"seed": seed, "parameter": parameter, "true": true, "apart_deg": trials}


def main():
    program, out = sys.argv[1] + "/apps/fisherhill", pathlib.Path(sys.argv[2])
    first, sets = int(sys.argv[3]), int(sys.argv[4])
    results = []
    for seed in range(first, first + sets):
        folder = out / f"s{seed}"
        label = folder / "result.json"
        if not label.exists():
            result = make(program, folder, seed)
            trials = [folder / f"trial_{k}.sto" for k in range(4)]
            fit = folder / "fit"
            done = run(program, "calibrate", MODEL, *trials[:3], "--hold-out", trials[3],
                       "--parameters", result["parameter"], "--own-start", "--threads", 1, "--out",
                       fit, "--force")
            summary = json.loads((fit / "summary.json").read_text()) \
                if (fit / "summary.json").exists() else {"status": done.stderr.strip()}
            result["status"] = summary["status"]
            for key in ("rmse_train_deg", "rmse_held_out_deg", "wall_s"):
                result[key] = summary.get(key)
            one = summary.get("estimates", {}).get(result["parameter"], {})
            result["estimate"], result["interval"] = one.get("value"), one.get("interval")
            result["minima"] = len(summary.get("other_minima", []))
            label.write_text(json.dumps(result, indent=1))
        results.append(json.loads(label.read_text()))
    report(results)


def report(results):
    reached = held = covered = given = two = 0
    for r in results:
        good = r["rmse_train_deg"] is not None and r["rmse_train_deg"] <= 1.1 * NOISE
        good_held = r["rmse_held_out_deg"] is not None and r["rmse_held_out_deg"] <= 1.1 * NOISE
        reached += good
        held += good and good_held
        low, high = r["interval"] or (None, None)
        holds = low is None or low <= r["true"] <= high
        if low is not None:
            given += 1
            covered += holds
            two += r["minima"] > 0
        if not (good and good_held and holds):
            print(r["seed"], r["parameter"], "true", r["true"], "estimate", r["estimate"],
                  "interval", low, high, "train", r["rmse_train_deg"], "held out", r["rmse_held_out_deg"],
                  r["status"])
    print(f"{len(results)} sets: training {reached}, training and held out {held}, "
          f"intervals {covered} of {given}, of which {two} enclose another minimum")
    apart = sorted(max(r["apart_deg"]) for r in results)
    times = sorted(r["wall_s"] for r in results if r["wall_s"])
    print(f"model as it is from the data: median of the worst trial {apart[len(apart) // 2]:.1f} "
          f"deg; median time {times[len(times) // 2]:.1f} s")


if __name__ == "__main__":
    main()
