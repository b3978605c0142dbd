#!/usr/bin/env python3
"""Replays what `fisherhill discover` wrote and compares with what its report says.

    validation/discovery/replay_reports.py build/release VERDICT_FOLDER...

Each folder holds a verdict.json. For every trial in it that has a figure after the search, the model
that was written is replayed on the trial as recorded, or as corrected where EMG or sensor were at
fault. Prints one line for every folder that differs by more than 0.01 degrees, and the largest
difference of all. Exit status 1 if one differs.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

LIMIT = 0.01  # degrees


def replayed(program: str, model: pathlib.Path, trial: pathlib.Path, step: float) -> float:
    """RMS error [deg] of the first measured coordinate."""
    with tempfile.TemporaryDirectory() as out:
        done = subprocess.run([program, "replay", str(model), str(trial), "--step", str(step),
                               "--out", out, "--force"], capture_output=True, text=True)
        summary = json.loads(pathlib.Path(out, "summary.json").read_text()) \
            if done.returncode in (0, 1) else None
    if summary is None:
        raise RuntimeError(done.stderr.strip())
    return summary["rms_error_deg"]


def main() -> int:
    program = sys.argv[1] + "/apps/fisherhill"
    count = 0
    sets = 0
    wrong = 0
    largest = 0.0
    for name in sys.argv[2:]:
        folder = pathlib.Path(name)
        verdict = json.loads((folder / "verdict.json").read_text())
        if not verdict.get("model"):
            continue
        sets += 1
        worst = 0.0
        for trial in verdict["trials"]:
            if "rmse_after_deg" not in trial:
                continue
            model = folder / verdict["model"]
            path = pathlib.Path(trial["replay_file"])
            if not path.exists():
                path = folder / path
            difference = abs(replayed(program, model, path, verdict["step_s"])
                             - trial["rmse_after_deg"])
            worst = max(worst, difference)
            count += 1
        if worst > LIMIT:
            wrong += 1
            print(f"{folder}: {worst:.4f} deg")
        largest = max(largest, worst)
    print(f"{sets} sets, {count} trials: largest difference {largest:.6f} deg, "
          f"{wrong} sets above {LIMIT} deg")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
