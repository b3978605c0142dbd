"""What the tests beside the program share: its results for a question, in a folder of their own.

Run from the top of the source tree, with the program's path in FISHERHILL_PROGRAM; without that there is nothing to do.
"""

import csv
import json
import math
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import time
import unittest

import numpy as np

import fisherhill as fh

ELBOW = "models/elbow8.osim"
SLOW = "emg_data/curl_slow.sto"
FAST = "emg_data/curl_fast.sto"
DEGREE = math.pi / 180
PROGRAM = os.environ.get("FISHERHILL_PROGRAM", "")


@unittest.skipUnless(PROGRAM, "FISHERHILL_PROGRAM is not set")
class BesideProgram(unittest.TestCase):
    def run_program(self, *words, status=0):
        """summary.json, and the folder that it lies in."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        out = pathlib.Path(folder.name) / "out"
        done = subprocess.run([PROGRAM, *map(str, words), "--out", str(out), "--seed", "3", "--threads", "2"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, status, done.stderr)
        return json.loads((out / "summary.json").read_text(encoding="utf-8")), out

    def rows(self, file):
        with open(file, encoding="utf-8") as table:
            return list(csv.DictReader(table))

    def column(self, rows, name):
        return np.array([float(row[name]) for row in rows])

    def one_line(self, call, words):
        """A ValueError of one line that says these words (a regular expression)."""
        with self.subTest(words), self.assertRaisesRegex(ValueError, words) as raised:
            call()
        self.assertEqual(str(raised.exception).count("\n"), 0)

    def ends_soon_after_ctrl_c(self, call):
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            call()
        self.assertLess(time.monotonic() - begin, 20)


class AsTheProgram(BesideProgram):
    """With the shipped elbow and two of its trials."""

    @classmethod
    def setUpClass(cls):
        cls.model = fh.load_model(ELBOW)
        cls.slow, cls.fast = (fh.load_trial(file, cls.model) for file in (SLOW, FAST))
