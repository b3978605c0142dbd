"""The examples of the docstrings say what comes out, and those of docs/python.md run."""

import ast
import contextlib
import doctest
import importlib.util
import io
import os
import pathlib
import re
import unittest

import numpy as np

import fisherhill as fh

import stub

os.environ["MPLBACKEND"] = "agg"


def documented():
    """(name, docstring) of all that the stub documents."""
    for name, node in stub.functions.items():
        yield name, ast.get_docstring(node)
    for cls in stub.classes:
        for kind in stub.members(cls):
            for name, node in kind.items():
                yield f"{cls}.{name}", ast.get_docstring(node) or ""


def failures(name, docstring):
    """What doctest prints of the examples that go wrong, and how many examples there are."""
    said = []
    known = {"fisherhill": fh, "np": np}
    test = doctest.DocTestParser().get_doctest(docstring, known, name, None, None)
    doctest.DocTestRunner(verbose=False).run(test, out=said.append)
    return "".join(said), len(test.examples)


class Examples(unittest.TestCase):
    def test_they_give_what_they_say(self):
        with_examples = []
        for name, docstring in documented():
            with self.subTest(name):
                said, count = failures(name, docstring)
                self.assertEqual(said, "")
                with_examples += [name] * (count > 0)
        for name in ("load_model", "load_trial", "replay", "sensitivity", "calibrate", "Model.with_parameters", "estimate"):
            self.assertIn(name, with_examples)

    def test_one_that_goes_wrong_is_found(self):
        said, count = failures("wrong", ">>> 1 + 1\n3\n")
        self.assertEqual(count, 1)
        self.assertIn("Expected", said)


class Document(unittest.TestCase):
    def test_its_examples_run(self):
        """All but the study, which beside_program/test_study.py runs, with the model and the trial that they take for granted."""
        model = fh.load_model("models/elbow8.osim")
        known = {"fisherhill": fh, "np": np, "model": model, "trial": fh.load_trial("emg_data/curl_slow.sto", model)}
        blocks = re.findall(r"^```python\n(.*?)^```", pathlib.Path("docs/python.md").read_text(encoding="utf-8"), re.M | re.S)
        uses = {"torch": "torch", "pandas": "to_dataframe", "matplotlib": "plot()"}
        run = 0
        for block in blocks:
            needed = [name for name, use in uses.items() if name in block or use in block]
            if "study.toml" in block or any(importlib.util.find_spec(name) is None for name in needed):
                continue
            with self.subTest(block), contextlib.redirect_stdout(io.StringIO()):
                exec(compile(block, "docs/python.md", "exec"), dict(known))
                run += 1
        self.assertGreater(run, 0)


if __name__ == "__main__":
    unittest.main()
