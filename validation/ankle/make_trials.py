#!/usr/bin/env python3
"""Makes the trials of emg_data/ankle from the recordings of tibialis anterior on a dynamometer.

Data: one participant of Tecchio et al. 2024 (J Appl Physiol, 10.1152/japplphysiol.00845.2023; github PaulT95/Tecchio_et_al_2023,
Apache-2.0) as tables NAME_200hz.csv with the columns time, ankle_plantarflexion_deg, torque_measured_Nm, EMG_TA_envelope_V,
TA_fascicle_mm.

    python3 validation/ankle/make_trials.py FOLDER [--out emg_data/ankle]

Trials: every fourth row (50 Hz); excitation of TA = envelope / its maximum in all contractions; ankle_angle = -plantarflexion;
ankle_angle.moment = measured torque, dorsiflexion positive; TA.fiber_length = fascicle length, where the ultrasound has it.
"""
import argparse
import csv
import pathlib

CONTRACTIONS = ["Ref_Long_01", "Ref_Long_02", "PL_0_01", "PL_0_02", "PL_100_01", "PL_100_02"]
TRIALS = ["Pas_Sho2Long", "Pas_Long2Sho", "Pas_m10", "Pas_5", "Ref_Long_01", "Ref_Long_02", "PL_0_01", "PL_100_01"]
EVERY = 4  # rows of the table per row of the trial


def read(folder, name):
    with open(folder / f"{name}_200hz.csv", newline="") as file:
        return list(csv.DictReader(file))


def number(cell):
    return float(cell) if cell not in ("", "nan", "NaN") else None


def largest_envelope(folder):
    return max(number(row["EMG_TA_envelope_V"]) for name in CONTRACTIONS for row in read(folder, name))


def write_trial(folder, name, largest, out):
    with open(out / f"{name}.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        columns = ["time", "TA", "ankle_angle_deg", "ankle_angle.moment"]
        writer.writerow(columns + (["TA.fiber_length"] if name in CONTRACTIONS else []))
        for row in read(folder, name)[::EVERY]:
            excitation = min(1.0, max(0.0, number(row["EMG_TA_envelope_V"]) / largest))
            line = [row["time"], f"{excitation:.5f}", -number(row["ankle_plantarflexion_deg"]), row["torque_measured_Nm"]]
            if name in CONTRACTIONS:
                fascicle = number(row["TA_fascicle_mm"])
                line.append("" if fascicle is None else f"{fascicle / 1000:.6f}")
            writer.writerow(line)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("emg_data/ankle"))
    arguments = parser.parse_args()
    largest = largest_envelope(arguments.folder)
    for name in TRIALS:
        write_trial(arguments.folder, name, largest, arguments.out)


if __name__ == "__main__":
    main()
