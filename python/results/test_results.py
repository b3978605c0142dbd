"""Tables, HTML and drawings of results: what they hold, and what is said where pandas or matplotlib are missing."""

import ast
import importlib.util
import os
import sys
import types
import unittest
from unittest import mock

import numpy as np

import fisherhill as fh
from fisherhill import _results, _tables

import stub

ELBOW = "models/elbow8.osim"
SLOW = "emg_data/curl_slow.sto"
NAMES = ["TRI.radius", "hand.mass", "BRA.max_isometric_force"]
os.environ["MPLBACKEND"] = "agg"

has = {name: importlib.util.find_spec(name) is not None for name in ("pandas", "matplotlib")}


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = fh.load_model(ELBOW)
        cls.trial = fh.load_trial(SLOW, cls.model)
        cls.motion = fh.replay(cls.model, cls.trial)
        cls.told = fh.sensitivity(cls.model, [cls.trial], NAMES)

    def examples(self):
        """A result of most kinds."""
        model, trial = self.model, self.trial
        yield self.motion
        yield self.told
        yield fh.parameter_sweep(model, trial, "TRI.radius", [0.014, 0.018])
        yield fh.profile_likelihood(model, [trial], NAMES[:2], "TRI.radius")
        yield fh.global_sensitivity(model, [trial], NAMES[:2], samples=2)
        yield fh.ensemble(model, trial, parameters=NAMES, draws=4)
        yield fh.calibrate(model, [trial], NAMES[:2], step=0.02)
        yield fh.compare(model, trial, integrators=["vi"], steps=[0.01, 0.02], timings=1)
        yield fh.moment_arms(model, {"elbow_flexion": np.linspace(0, 1, 3)})
        yield fh.identifiability(self.told.fisher, self.told.values, NAMES)
        yield fh.list_effects(model)
        yield fh.list_parameters(model)
        yield model.review()
        yield fh.estimate(lambda theta: np.array([theta[0], theta[0] + 1.0]), [1.0, 2.1], 0.1, [0.5], names=["a"])

    @unittest.skipUnless(has["pandas"], "pandas is not there")
    def test_tables_hold_the_numbers_of_the_result(self):
        frame = self.motion.to_dataframe()
        self.assertEqual(frame.index.name, "time")
        np.testing.assert_array_equal(frame.index, self.motion.time)
        np.testing.assert_array_equal(frame["elbow_flexion"], self.motion.q[:, 0])
        np.testing.assert_array_equal(frame["BRA.tendon_force"], self.motion.tendon_force[:, self.motion.muscles.index("BRA")])
        bounds = self.told.to_dataframe()
        self.assertEqual(list(bounds.index), NAMES)
        np.testing.assert_array_equal(bounds["bound_joint"], self.told.bound_joint)
        listed = fh.list_parameters(self.model)
        frame = listed.to_dataframe()
        self.assertEqual(len(frame), len(listed))
        self.assertEqual(frame.loc["TRI.radius", "value"], 0.016)
        draws = fh.ensemble(self.model, self.trial, parameters=NAMES, draws=4)
        np.testing.assert_array_equal(draws.to_dataframe()[NAMES].to_numpy(), draws.parameters)
        self.assertEqual(len(fh.list_parameters(self.model)[:0]), 0)

    @unittest.skipUnless(has["pandas"] and has["matplotlib"], "pandas or matplotlib is not there")
    def test_every_kind_has_a_table_html_and_what_the_stub_says(self):
        from matplotlib import pyplot

        kinds = set()
        for result in self.examples():
            kind = type(result).__name__
            kinds.add(kind)
            with self.subTest(kind):
                frame = result.to_dataframe()
                self.assertGreater(frame.shape[1], 0)
                shown = result._repr_html_()
                self.assertIn(kind, shown)
                self.assertEqual(shown.count("<table>"), shown.count("</table>"))
                self.assertLess(len(shown), 20000)
                if hasattr(result, "plot"):
                    axes = result.plot()
                    self.assertIsNotNone(axes)
                    pyplot.close("all")
        self.assertGreater(len(kinds), 12)

    @unittest.skipUnless(has["matplotlib"], "matplotlib is not there")
    def test_drawings_go_where_they_are_asked_to(self):
        from matplotlib import pyplot

        figure, (above, below) = pyplot.subplots(2)
        drawn = self.motion.plot([above, below])
        self.assertEqual(drawn, [above, below])
        self.assertEqual(len(above.lines), len(self.motion.coordinates))
        np.testing.assert_array_equal(below.lines[0].get_ydata(), self.motion.tendon_force[:, 0])
        self.assertIs(self.told.plot(above), above)
        with self.assertRaisesRegex(ValueError, "axes: 1, must be 2"):
            self.motion.plot(above)
        pyplot.close(figure)

    def test_what_is_missing_is_named_with_its_package(self):
        for module, call, words in (
            ("pandas", self.motion.to_dataframe, "^to_dataframe needs pandas: apt-get install python3-pandas$"),
            ("pandas", fh.list_parameters(self.model).to_dataframe, "^to_dataframe needs pandas"),
            ("matplotlib.pyplot", self.motion.plot, "^plot needs matplotlib: apt-get install python3-matplotlib$"),
        ):
            with mock.patch.dict(sys.modules, {module: None}), self.assertRaisesRegex(ImportError, words):
                call()
        with mock.patch.dict(sys.modules, {"pandas": None, "matplotlib.pyplot": None}):
            self.assertIn("elbow_flexion", self.motion._repr_html_())

    def test_html_is_escaped_and_short(self):
        verdict = _results.DiscoveryResult(sentence="<script>alert(1)</script> & more", effects=[])
        shown = verdict._repr_html_()
        self.assertNotIn("<script", shown)
        self.assertIn("&lt;script&gt;alert(1)&lt;/script&gt; &amp; more", shown)
        rows = _results.Rows(types.SimpleNamespace(name=f"<{i}>", value=float("nan")) for i in range(30))
        shown = rows._repr_html_()
        self.assertIn("&lt;0&gt;", shown)
        self.assertIn("10 more rows", shown)
        self.assertEqual(shown.count("<tr>"), 21)
        self.assertNotIn("nan", shown)
        left = len(self.motion._columns()) - 12
        self.assertIn(f"{len(self.motion.time) - 20} more rows and {left} more columns", self.motion._repr_html_())

    def test_effects_of_a_verdict_are_rows(self):
        number = types.SimpleNamespace(value=1.25, sd=0.1, unit="N m")
        effect = types.SimpleNamespace(id="coulomb", name="dry friction", kind="structure", parameters={"coulomb.torque": number},
                                       log_bayes_factor=12.0, probability=0.9, cannot_be_told_from=["stribeck"])
        verdict = _results.RobotDiscoveryResult(sentence="It is dry friction.", effects=[effect])
        columns = verdict._columns()
        self.assertEqual(columns["parameters"], ["coulomb.torque = 1.25 ± 0.1 N m"])
        self.assertIn("It is dry friction.", verdict._repr_html_())

    def test_a_row_that_is_no_single_value_is_left_out(self):
        rows = _results.Rows([types.SimpleNamespace(name="a", words=["x", "y"], course=np.zeros(3), value=None)])
        self.assertEqual(rows._columns(), {"name": ["a"], "words": ["x, y"], "value": [None]})
        self.assertEqual(_results.Rows()._columns(), {})
        self.assertIn("0 rows", _results.Rows()._repr_html_())

    def test_classes_are_those_of_the_stub(self):
        in_stub = {name: [one.id for one in node.bases if isinstance(one, ast.Name)]
                   for name, node in stub.definitions(stub.tree.body, ast.ClassDef).items()}
        named = {name: bases for name, bases in in_stub.items() if {"_Table", "_Plotted"} & set(bases) and not name.startswith("_")}
        self.assertGreater(len(named), 15)
        for name, bases in named.items():
            kind = getattr(_results, name)
            self.assertEqual(issubclass(kind, _tables.Plotted), "_Plotted" in bases, name)
            self.assertTrue(issubclass(kind, _tables.Table), name)
            # no member of a result hides what all of them have
            self.assertFalse({"plot", "to_dataframe"} & set(stub.results[name]), name)


if __name__ == "__main__":
    unittest.main()
