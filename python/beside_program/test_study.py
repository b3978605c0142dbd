"""study: some of the subjects, rows as they come, and moments at coordinates that the model locks, against the program."""

import csv
import json
import os
import pathlib
import tempfile
import unittest

import numpy as np

import fisherhill as fh

import stub
from beside_program.as_the_program import DEGREE, ELBOW, AsTheProgram


class Study(AsTheProgram):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def trial(self, name, rows, **more):
        """Some rows of the shipped trial, and further columns."""
        times, angle = self.slow.measured["elbow_flexion"]
        columns = {"time": self.slow.times, **dict(zip(self.slow.muscles, self.slow.excitations.T)), **more}
        columns["elbow_flexion"] = np.interp(self.slow.times, times, angle)
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as out:
            table = np.transpose([np.broadcast_to(one, self.slow.times.shape)[rows] for one in columns.values()])
            csv.writer(out).writerows([list(columns), *([repr(float(x)) for x in row] for row in table)])

    def study(self, subjects, head='parameters = ["hand.mass"]\nnoise_deg = 1.0\nstep_s = 0.01\n'):
        file = os.path.join(self.folder, "study.toml")
        with open(file, "w", encoding="utf-8") as out:
            out.write(head)
            for name, train in subjects.items():
                out.write(f'[[subject]]\nname = "{name}"\nmodel = "{os.path.abspath(ELBOW)}"\ntrain = "{train}"\n')
        return file

    def test_an_interrupted_study_goes_on(self):
        for k in range(3):
            self.trial(f"t{k}.csv", slice(20 * k, 20 * k + 51))
        file = self.study({f"s{k}": f"t{k}.csv" for k in range(3)})
        whole = fh.study(file)
        self.assertEqual([row.status for row in whole], ["ok"] * 3)

        done = {}

        def keep(row):
            stub.check(row, "StudyRow")
            done[row.subject] = row
            if row.subject == "s1":
                raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            fh.study(file, each=keep)
        self.assertEqual(list(done), ["s0", "s1"])
        left = [one.name for one in fh.read_study(file).subjects if one.name not in done]
        rows = fh.study(file, subjects=left, each=keep)
        self.assertEqual([[row.subject for row in rows], list(done)], [["s2"], ["s0", "s1", "s2"]])
        for row, one in zip(done.values(), whole):
            self.assertEqual(row.calibration.estimates["hand.mass"].value, one.calibration.estimates["hand.mass"].value)
        # in the order of the file
        self.assertEqual([row.subject for row in fh.study(file, subjects=["s2", "s0"])], ["s0", "s2"])
        self.assertEqual(fh.study(file, subjects=[]), [])
        with self.assertRaisesRegex(ValueError, "^subjects: 's3' is none of the study, which has s0, s1, s2$"):
            fh.study(file, subjects=["s0", "s3"])

    def test_the_example_of_the_documentation_computes_what_is_left(self):
        with open("docs/python.md", encoding="utf-8") as file:
            blocks = [text.split("```")[0] for text in file.read().split("```python\n")[1:]]
        (example,) = [block for block in blocks if "study.toml" in block]
        for k in range(2):
            self.trial(f"t{k}.csv", slice(20 * k, 20 * k + 51))
        file = self.study({f"s{k}": f"t{k}.csv" for k in range(2)})
        for earlier, rows in (("{}", ["s0", "s1"]), ('{"s0": None}', ["s0", "s1"])):
            known = {"fisherhill": fh}
            exec(example.replace("{}", earlier, 1).replace("study.toml", file), known)
            self.assertEqual(list(known["done"]), rows)
            self.assertIsNotNone(known["done"]["s1"].calibration)
        self.assertIsNone(known["done"]["s0"])

    def test_numbers_of_the_models_are_set_as_the_program_sets_them(self):
        self.trial("t.csv", slice(0, 51))
        head = 'parameters = ["hand.mass"]\nnoise_deg = 1.0\nstep_s = 0.01\nset = ["hand.mass=0.8"]\n'
        file = self.study({"s0": "t.csv", "s1": "t.csv", "s2": "t.csv"}, head)
        study = pathlib.Path(file)
        text = study.read_text(encoding="utf-8").replace('name = "s1"', 'name = "s1"\nset = ["BRA.max_isometric_force=1000"]')
        study.write_text(text + 'set = ["BRA.max_isometric_force=1000", "hand.weight=1"]\n', encoding="utf-8")  # of the last
        asked = fh.read_study(file)
        stub.check(asked, "StudyFile")
        self.assertEqual(asked.set, ["hand.mass=0.8"])
        self.assertEqual([one.set for one in asked.subjects], [[], ["BRA.max_isometric_force=1000"], ["BRA.max_isometric_force=1000", "hand.weight=1"]])
        rows = fh.study(file)
        _, out = self.run_program("study", "run", file, status=1)
        its = {row["subject"]: row for row in self.rows(out / "estimates.csv")}
        for row in rows[:2]:
            estimate = row.calibration.estimates["hand.mass"]
            self.assertEqual(estimate.model, 0.8)
            self.assertEqual(float(its[row.subject]["model"]), 0.8)
            self.assertAlmostEqual(estimate.value / float(its[row.subject]["estimate"]), 1, 7)
        self.assertNotEqual(its["s0"]["estimate"], its["s1"]["estimate"])
        self.assertEqual(rows[2].status, "failed")
        self.assertIn("no parameter is called 'hand.weight'", rows[2].message)
        self.assertIn("no parameter is called 'hand.weight'", self.rows(out / "study.csv")[2]["message"])

    def test_moments_at_coordinates_that_the_model_locks_are_fitted(self):
        self.trial("held.csv", slice(0, 101), **{"pro_sup.moment": -0.4})
        parameters = ["hand.mass", "BIClong.max_isometric_force"]
        file = self.study({"one": "held.csv"}, f"parameters = {json.dumps(parameters)}\nstep_s = 0.01\n")
        (row,) = fh.study(file)
        _, out = self.run_program("study", "run", file)
        told = json.loads((out / "subjects/one/calibrate/summary.json").read_text(encoding="utf-8"))
        self.assertEqual(row.status, told["status"], row.message)
        self.assertEqual({name: one.value for name, one in row.calibration.estimates.items()},
                         {name: one["value"] for name, one in told["estimates"].items()})
        self.assertAlmostEqual(row.noise / DEGREE, told["noise_deg"], 12)
        # the moment counts
        self.trial("free.csv", slice(0, 101))
        (free,) = fh.study(self.study({"one": "free.csv"}, f"parameters = {json.dumps(parameters)}\nstep_s = 0.01\n"))
        self.assertNotAlmostEqual(free.calibration.estimates[parameters[1]].value,
                                  row.calibration.estimates[parameters[1]].value, 3)


del AsTheProgram  # has no tests of its own

if __name__ == "__main__":
    unittest.main()
