"""The examples of the docstrings say what comes out."""

import ast
import doctest
import unittest

import numpy as np

import fisherhill as fh

import stub


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


if __name__ == "__main__":
    unittest.main()
