"""Who is told how far a computation is; other threads run meanwhile."""

import contextlib
import importlib.util
import io
import sys
import threading
import time
import types
import unittest
from unittest import mock

import numpy as np

import fisherhill as fh

NAMES = ["TRI.radius", "hand.mass"]


class Elbow(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = fh.load_model("models/elbow8.osim")
        cls.trial = fh.load_trial("emg_data/curl_slow.sto", cls.model)

    def work(self):
        """{name: call with a progress}, of all that take one but study and discover_robot."""
        model, trial = self.model, self.trial
        hidden = fh.load_trial("emg_data/hidden_a/train_1.sto", model)
        few = {"candidates": 4, "generations": 4, "knots": 1.5}
        return {
            "calibrate": lambda to: fh.calibrate(model, [trial], NAMES, progress=to),
            "discover": lambda to: fh.discover(model, [hidden], noise=np.radians(0.5), max_effects=1, progress=to),
            "ensemble": lambda to: fh.ensemble(model, trial, parameters=NAMES, draws=200, progress=to),
            "global_sensitivity": lambda to: fh.global_sensitivity(model, [trial], NAMES, samples=16, progress=to),
            "design": lambda to: fh.design(model, trial, NAMES, iterations=0, progress=to, **few),
            "separate": lambda to: fh.separate(model, trial, "visc", "stiffness", progress=to, **few),
        }


class Progress(Elbow):
    def test_fractions_rise_to_one_on_the_calling_thread(self):
        for name, call in self.work().items():
            told, threads = [], set()

            def tell(fraction):
                told.append(fraction)
                threads.add(threading.get_ident())

            with self.subTest(name):
                call(tell)
                self.assertEqual(told, sorted(set(told)))
                self.assertEqual(told[-1], 1)
                self.assertGreater(len(told), 1)
                self.assertGreater(told[0], 0)
                self.assertEqual(threads, {threading.get_ident()})

    def test_what_it_raises_ends_the_work(self):
        class Enough(Exception):
            pass

        def tell(fraction):
            raise Enough(fraction)

        began = time.monotonic()
        with self.assertRaises(Enough):
            fh.ensemble(self.model, self.trial, draws=1_000_000, progress=tell)
        self.assertLess(time.monotonic() - began, 60)  # all of it takes hours

    def test_study_tells_after_every_subject(self):
        told = []
        plan = fh.read_study("emg_data/study.toml")
        some = [one.name for one in plan.subjects][:2]
        with mock.patch("fisherhill._study._row", lambda plan, subject, seed, threads: types.SimpleNamespace(subject=subject.name)):
            fh.study("emg_data/study.toml", subjects=some, progress=told.append)
        self.assertEqual(told, [0.5, 1])

    def test_a_bar_is_made_where_it_is_asked_for(self):
        bars = []

        class Bar:
            def __init__(self, total, desc, bar_format):
                self.total, self.name, self.n, self.closed = total, desc, 0.0, False
                bars.append(self)

            def update(self, more):
                self.n += more

            def close(self):
                self.closed = True

        with mock.patch.dict(sys.modules, {"tqdm": types.ModuleType("tqdm"), "tqdm.auto": types.SimpleNamespace(tqdm=Bar)}):
            fh.ensemble(self.model, self.trial, parameters=NAMES, draws=64, progress=True)
            fh.ensemble(self.model, self.trial, parameters=NAMES, draws=64, progress=False)
            with self.assertRaises(ValueError):
                fh.calibrate(self.model, [self.trial], ["ghost"], progress=True)
        self.assertEqual([one.name for one in bars], ["ensemble", "calibrate"])
        self.assertAlmostEqual(bars[0].n, bars[0].total)
        self.assertTrue(bars[0].closed and bars[1].closed)

    @unittest.skipUnless(importlib.util.find_spec("tqdm"), "tqdm is not installed (apt-get install python3-tqdm)")
    def test_the_bar_of_tqdm_ends_at_100_percent(self):
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            fh.ensemble(self.model, self.trial, parameters=NAMES, draws=64, progress=True)
        self.assertIn("ensemble: 100 %", said.getvalue())

    def test_what_to_install_is_said_before_the_work_begins(self):
        with mock.patch.dict(sys.modules, {"tqdm": None, "tqdm.auto": None}):
            with self.assertRaisesRegex(ImportError, "apt-get install python3-tqdm"):
                fh.ensemble(self.model, self.trial, draws=1_000_000, progress=True)
        with self.assertRaisesRegex(TypeError, "progress: a str, must be"):
            fh.ensemble(self.model, self.trial, draws=1_000_000, progress="yes")


class Threads(Elbow):
    def test_others_run_while_it_is_simulated(self):
        """A thread that counts gets on during every function, which it would not with the interpreter's lock held."""
        calls = {name: (lambda call: lambda: call(None))(call) for name, call in self.work().items()}
        calls["sensitivity"] = lambda: fh.sensitivity(self.model, [self.trial], ["all"])
        calls["cost_gradient"] = lambda: [fh.cost_gradient(self.model, [self.trial], ["all"]) for _ in range(10)]
        calls["predict"] = lambda: [fh.predict(self.model, [self.trial], ["all"], weights=[np.ones(451)]) for _ in range(10)]
        calls["replay"] = lambda: fh.replay(self.model, self.trial, integrator="rk4", step=5e-6)
        for name, call in calls.items():
            ticks, stop = [], threading.Event()

            def count():
                while not stop.wait(0.001):
                    ticks.append(time.monotonic())

            ticker = threading.Thread(target=count)
            with self.subTest(name):
                ticker.start()
                began = time.monotonic()
                try:
                    call()
                    ended = time.monotonic()
                finally:
                    stop.set()
                    ticker.join()
                during = [one for one in ticks if began < one < ended]
                longest = max(np.diff([began, *during, ended]))
                self.assertGreater(len(during), 3, f"{ended - began:.3f} s")
                self.assertLess(longest, max(0.5 * (ended - began), 0.25))

    def test_two_threads_simulate_at_once_and_get_what_one_gets(self):
        alone = fh.replay(self.model, self.trial).q
        found = {}

        def run(which):
            found[which] = fh.replay(self.model, self.trial).q

        threads = [threading.Thread(target=run, args=(i,)) for i in range(4)]
        for one in threads:
            one.start()
        for one in threads:
            one.join()
        self.assertEqual(sorted(found), [0, 1, 2, 3])
        for q in found.values():
            np.testing.assert_array_equal(q, alone)


if __name__ == "__main__":
    unittest.main()
