"""What proof.py measures beside motions: derivatives, ensembles over ranks, and MuJoCo."""

import json
import pathlib
import statistics
import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree

here = pathlib.Path(__file__).resolve().parent
top = here.parents[1]


def output(*words):
    run = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False, cwd=top)
    if run.returncode != 0:
        raise RuntimeError(f"{words[0]}: {run.stderr.strip()}")
    return run.stdout


def derivatives(bench):
    """Table of the derivatives of one motion in all parameters, as bench/sensitivity_bench measures them."""
    jobs = {"simulation": "one simulation, vi at 0.01 s", "gradient/of_a_cost_in_all": "gradient of a cost in all parameters, by one sweep back",
            "sensitivities/of_the_motion_to_all": "the whole motion's derivatives in all parameters, forward",
            "sensitivities/of_everything_to_all": "of muscle states and forces as well", "centralDifferences/of_the_motion_to_all": "central differences of the motion"}
    text = output(bench, "--benchmark_format=json", "--benchmark_repetitions=5", "--benchmark_enable_random_interleaving=true",
                  "--benchmark_min_time=0.1", f"--benchmark_filter=^({'|'.join(jobs)})$")
    times, count = {}, 0
    for row in json.loads(text)["benchmarks"]:
        if row["run_type"] == "iteration":
            times.setdefault(row["run_name"], []).append(row["cpu_time"])
            count = max(count, int(row.get("parameters", 0)))
    least = statistics.median(times["simulation"])
    table = f"\nDerivatives of the elbow's motion (4.5 s) in its {count} parameters, medians of 5 in random order, processor time:\n\n| what | time [ms] | in simulations |\n|---|---|---|\n"
    for job, words in jobs.items():
        time = statistics.median(times[job])
        table += f"| {words} | {time:.3g} | {time / least:.3g} |\n"
    return table


def scaling(program):
    """What bench/ensemble_scaling prints."""
    return "\nEnsembles of the elbow over MPI ranks, nine parameters (`bench/ensemble_scaling`):\n\n" + output(top / "bench/ensemble_scaling", program)


def without_pictures(parts, path):
    """Writes a model of MyoSim's parts without meshes and materials, which do not move it: all bodies have their inertia."""
    root = ElementTree.Element("mujoco", model="elbow")
    for part in parts:
        root.extend(item for item in ElementTree.parse(part).getroot() if item.tag not in ("asset", "visual"))
    for item in root.iter():
        for mesh in [child for child in item if child.tag == "geom" and child.get("type") == "mesh"]:
            item.remove(mesh)
        item.attrib.pop("material", None)
    ElementTree.ElementTree(root).write(path)


def mujoco_runs(myo_sim, motion):
    """Runs of MuJoCo as proof.py has them, (integrator, step) -> (RMS error [deg], time [ms]), and what it says of itself."""
    parts = [myo_sim / "elbow/assets" / name for name in ("myoelbow_assets.xml", "myoelbow_1dof6muscles_body.xml")]
    (joint, start), = motion.start.items()
    with tempfile.TemporaryDirectory() as folder:
        model, program = pathlib.Path(folder) / "elbow.xml", pathlib.Path(folder) / "mujoco_times"
        without_pictures(parts, model)
        output("g++", "-std=c++20", "-O3", "-march=native", here / "mujoco_times.cc", "-lmujoco", "-o", program)
        head, _, *rows = output(program, model, motion.trial, 2, f"{joint}={start!r}").splitlines()
    runs = {}
    for row in rows:
        integrator, step, error, time = row.split(",")
        runs[integrator, float(step)] = float(error), float(time)
    return runs, head.lstrip("# ")
