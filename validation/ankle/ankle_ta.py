#!/usr/bin/env python3
"""Calibrates models/ankle_ta.osim on a dynamometer's recordings and predicts a held-out trial.

Data: one participant of Tecchio et al. 2024 (J Appl Physiol, 10.1152/japplphysiol.00845.2023; github PaulT95/Tecchio_et_al_2023,
Apache-2.0) as tables NAME_200hz.csv with the columns time, ankle_plantarflexion_deg, torque_measured_Nm, EMG_TA_envelope_V,
TA_fascicle_mm. They are not part of this project.

    python3 validation/ankle/ankle_ta.py FOLDER [--program build/program/apps/fisherhill] [--out out/ankle]

Trials: excitation of TA = envelope / its maximum in all contractions; ankle_angle = −plantarflexion, prescribed;
ankle_angle.moment = measured torque, dorsiflexion positive; TA.fiber_length = fascicle length.
"""
import argparse
import csv
import json
import math
import pathlib
import subprocess

CONTRACTIONS = ["Ref_Long_01", "Ref_Long_02", "PL_0_01", "PL_0_02", "PL_100_01", "PL_100_02"]
TRAINING = ["Pas_Sho2Long", "Pas_Long2Sho", "Pas_m10", "Pas_5", "Ref_Long_01"]
HELD_OUT = ["Ref_Long_02"]
STRETCHED = ["PL_0_01", "PL_100_01"]  # never fitted: the model has no history dependence
PARAMETERS = ["TA.max_isometric_force", "TA.optimal_fiber_length", "TA.tendon_slack_length", "emg.nonlinearity",
              "other_tissues.stiffness", "other_tissues.rest_length"]
# surface EMG of strong contractions rises less than the force does: allowed to be more curved than by default
NONLINEARITY = ["--bounds", "emg.nonlinearity=-8:0", "--prior", "emg.nonlinearity=-2:2"]
EVERY = 4  # rows of the table per row of the trial: 50 Hz


def read(folder, name):
    with open(folder / f"{name}_200hz.csv", newline="") as file:
        return list(csv.DictReader(file))


def number(cell):
    return float(cell) if cell not in ("", "nan", "NaN") else None


def largest_envelope(folder):
    return max(number(row["EMG_TA_envelope_V"]) for name in CONTRACTIONS for row in read(folder, name))


def write_trial(folder, name, largest, out):
    """One trial; the fascicle's length stands where the ultrasound has it."""
    rows = read(folder, name)
    isContraction = name in CONTRACTIONS
    with open(out / f"{name}.csv", "w", newline="") as file:
        writer = csv.writer(file)
        columns = ["time", "TA", "ankle_angle_deg", "ankle_angle.moment"]
        writer.writerow(columns + (["TA.fiber_length"] if isContraction else []))
        for row in rows[::EVERY]:
            excitation = min(1.0, max(0.0, number(row["EMG_TA_envelope_V"]) / largest))
            line = [row["time"], f"{excitation:.5f}", -number(row["ankle_plantarflexion_deg"]), row["torque_measured_Nm"]]
            if isContraction:
                fascicle = number(row["TA_fascicle_mm"])
                line.append("" if fascicle is None else f"{fascicle / 1000:.6f}")
            writer.writerow(line)
    return str(out / f"{name}.csv")


def drive(trial, shape, out):
    """The trial with u' = (exp(A·u) − 1)/(exp(A) − 1), as emg.nonlinearity = A maps excitations."""
    with open(trial, newline="") as file:
        rows = list(csv.DictReader(file))
    with open(out, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        for row in rows:
            u = float(row["TA"])
            row["TA"] = f"{math.expm1(shape * u) / math.expm1(shape) if shape else u:.6f}"
            writer.writerow(row)
    return str(out)


def column(file, name):
    """A column of a .sto table."""
    lines = pathlib.Path(file).read_text().splitlines()
    begin = lines.index("endheader")
    place = lines[begin + 1].split("\t").index(name)
    return [float(line.split("\t")[place]) for line in lines[begin + 2:]]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", default="build/program/apps/fisherhill")
    parser.add_argument("--model", default="models/ankle_ta.osim")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/ankle"))
    arguments = parser.parse_args()
    trials = arguments.out / "trials"
    trials.mkdir(parents=True, exist_ok=True)
    largest = largest_envelope(arguments.folder)
    files = {name: write_trial(arguments.folder, name, largest, trials) for name in TRAINING + HELD_OUT + STRETCHED}
    common = ["--prescribe", "ankle_angle", "--prescribe-cutoff", "6", "--force"]
    command = [arguments.program, "calibrate", arguments.model] + [files[name] for name in TRAINING]
    for name in HELD_OUT:
        command += ["--hold-out", files[name]]
    command += ["--parameters", ",".join(PARAMETERS), "--out", str(arguments.out / "calibrate")] + NONLINEARITY + common
    print(" ".join(command))
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    summary = json.loads((arguments.out / "calibrate" / "summary.json").read_text())
    for name, one in summary["estimates"].items():
        sd = "no interval" if one["sd"] is None else f"± {one['sd']:.3g}"
        print(f"  {name} = {one['value']:.4g} {sd} {one['unit']} (was {one['model']:.4g})")
    for one in summary["held_out_predictions"]:
        low, high = one["interval"]
        print(f"  {one['file'].split('/')[-1]}, peak of {one['channel']}: measured {one['peak_measured']:.4g} {one['unit']}, predicted "
              f"{one['peak_predicted']:.4g}, 95 % interval {low:.4g} to {high:.4g} (sd of estimates {one['sd_of_estimates']:.2g}, "
              f"of a sample {one['noise']:.2g}): {'holds it' if one['holds_peak'] else 'does not hold it'}; "
              f"{100 * one['share_of_samples_held']:.0f} % of the samples lie in their intervals")
    shape = summary["estimates"]["emg.nonlinearity"]["value"]
    for name in TRAINING + HELD_OUT + STRETCHED:
        trial = drive(files[name], shape, trials / f"{name}_driven.csv")
        out = arguments.out / f"replay_{name}"
        replay = [arguments.program, "replay", str(arguments.out / "calibrate" / "calibrated.osim"), trial, "--out", str(out)]
        subprocess.run(replay + common, check=True, stdout=subprocess.DEVNULL)
        error = json.loads((out / "summary.json").read_text())["rms_error"]["ankle_angle.moment"]
        with open(trial, newline="") as file:
            measured = [float(row["ankle_angle.moment"]) for row in csv.DictReader(file)]
        predicted = [-value for value in column(out / "forces.sto", "ankle_angle.reaction")]
        role = "fitted" if name in TRAINING else "held out" if name in HELD_OUT else "stretched, not fitted"
        line = f"{name} ({role}): RMS {error['value']:.2f} N m, largest {error['max']:.2f} N m"
        if name in CONTRACTIONS:
            rise, expected = (max(values) - values[0] for values in (measured, predicted))
            line += (f"; the contraction raises the moment by {rise:.1f} N m, predicted {expected:.1f} N m "
                     f"({100 * (expected / rise - 1):+.1f} %), RMS {100 * error['value'] / rise:.1f} % of it")
        print(line)


if __name__ == "__main__":
    main()
