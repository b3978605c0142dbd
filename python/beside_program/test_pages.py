"""The page of explore, and the configuration that emg writes to begin with, as the program makes them."""

import os
import pathlib
import stat
import subprocess
import tempfile
import unittest
from unittest import mock

import numpy as np

import fisherhill as fh

import stub
from beside_program.as_the_program import ELBOW, FAST, PROGRAM, SLOW, BesideProgram

RAW = "emg_data/curl_slow_raw.csv"


class Explore(BesideProgram):
    def test_it_writes_the_program_s_page(self):
        with tempfile.TemporaryDirectory() as folder:
            page = fh.explore(ELBOW, [SLOW, pathlib.Path(FAST)], pathlib.Path(folder) / "page", parameters=["TRI.radius", "hand.mass"],
                              values={"hand.mass": 0.6}, coordinate="elbow_flexion", step=0.02)
            text = pathlib.Path(page).read_text(encoding="utf-8")
            self.assertGreater(len(text), 100_000)
            for words in ("TRI.radius", SLOW, FAST, "WebAssembly"):
                self.assertIn(words, text)
            self.one_line(lambda: fh.explore(ELBOW, SLOW, os.path.dirname(page)), "--force")
            self.assertEqual(fh.explore(ELBOW, SLOW, os.path.dirname(page), force=True), page)

    def test_what_the_program_refuses_is_one_line(self):
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "page")
            self.one_line(lambda: fh.explore(ELBOW, SLOW, out, parameters="ghost"), "ghost")
            self.one_line(lambda: fh.explore("none.osim", SLOW, out), "none.osim")
            self.one_line(lambda: fh.explore(ELBOW, SLOW, out, integrator="cvode"), "cvode")
            self.one_line(lambda: fh.explore(ELBOW, [], out), "trials: empty")
            self.assertFalse(os.path.exists(out))


class WithoutProgram(unittest.TestCase):
    def test_it_says_what_to_do(self):
        with mock.patch.dict(os.environ, {"FISHERHILL_PROGRAM": "", "PATH": "/nowhere"}):
            with self.assertRaisesRegex(RuntimeError, "explore runs the program fisherhill, which is not there: build it with ./start"):
                fh.explore(ELBOW, SLOW, "never")
        with mock.patch.dict(os.environ, {"FISHERHILL_PROGRAM": "/nowhere/fisherhill"}):
            with self.assertRaisesRegex(RuntimeError, "/nowhere/fisherhill"):
                fh.explore(ELBOW, SLOW, "never")

    def test_its_arguments_become_options(self):
        with tempfile.TemporaryDirectory() as folder:
            program, words = os.path.join(folder, "echo"), os.path.join(folder, "words")
            with open(program, "w", encoding="utf-8") as file:
                file.write(f'#!/bin/sh\nprintf "%s\\n" "$@" > {words}\n')
            os.chmod(program, os.stat(program).st_mode | stat.S_IXUSR)
            with mock.patch.dict(os.environ, {"FISHERHILL_PROGRAM": program}):
                page = fh.explore("m.osim", "t.sto", "out", verdict="v", parameters="a", noise=np.radians(2), values={"b": 1},
                                  prescribe=["c"], initial={"c": 0.5}, wrap_as_cylinder=["e"], ignore_extra=True, force=True,
                                  coordinate=["c", "d"], lock={"f": 1}, integrator="rk4", step=0.001)
            self.assertEqual(page, os.path.join("out", "report.html"))
            with open(words, encoding="utf-8") as file:
                said = file.read().split()
            self.assertEqual(said, (
                "explore m.osim t.sto --out out --noise 2.0 --verdict v --parameters a --prescribe c --coordinate c --coordinate d "
                "--wrap-as-cylinder e --set b=1.0 --initial c=0.5 --lock f=1.0 --integrator rk4 --step 0.001 --ignore-extra --force").split())


class EmgConfig(BesideProgram):
    def test_it_is_the_program_s_file_and_emg_takes_it(self):
        with tempfile.TemporaryDirectory() as folder:
            ours, theirs = os.path.join(folder, "ours.toml"), os.path.join(folder, "theirs.toml")
            found = fh.write_emg_config(RAW, ours)
            stub.check(found, "EmgConfigDraft")
            self.assertEqual((found.channels, found.electrodes, found.is_complete), (9, 8, True))
            done = subprocess.run([PROGRAM, "emg", RAW, "--write-config", theirs], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            with open(ours, encoding="utf-8") as one, open(theirs, encoding="utf-8") as other:
                text = one.read()
                self.assertEqual(text, other.read())
            for channel in fh.read_recording(RAW).channels:
                self.assertIn(f'"{channel.name}"', text)
            columns = fh.emg(RAW, ours).columns
            self.assertEqual(set(columns) - {"time"}, set(fh.load_model(ELBOW).muscles))
            self.one_line(lambda: fh.write_emg_config(RAW, ours), "ours.toml: is there already and is not overwritten")
            self.one_line(lambda: fh.write_emg_config("none.csv", theirs + "2"), "none.csv")
            self.assertFalse(os.path.exists(theirs + "2"))

    def test_channels_are_a_table(self):
        channels = fh.read_recording(RAW).channels
        columns = channels._columns()
        self.assertEqual(list(columns), ["name", "unit", "rate", "start_time"])
        self.assertEqual(columns["rate"][0], 2000)


if __name__ == "__main__":
    unittest.main()
