"""program_options.toml names every option of the program and what there is of it in Python.

The options are read off the program's own --help; without FISHERHILL_PROGRAM there is nothing to do.
"""

import os
import pathlib
import re
import subprocess
import tomllib
import unittest

import fisherhill as fh

import stub

PROGRAM = os.environ.get("FISHERHILL_PROGRAM", "")
TABLE = tomllib.loads((pathlib.Path(__file__).parent / "program_options.toml").read_text(encoding="utf-8"))


def said(*words):
    return subprocess.run([PROGRAM, *words, "--help"], capture_output=True, text=True, check=True).stdout


def commands():
    """Names of the subcommands."""
    listed = said().partition("\nSubcommands:\n")[2].partition("\n\n")[0]
    return re.findall(r"^  ([a-z][a-z-]*)  ", listed, re.MULTILINE)


def options_in(text):
    """The long names at the beginnings of the lines of --help."""
    return re.findall(r"^  (?:-\w,)?(--[a-z][a-z-]*)", text, re.MULTILINE)


def row(table, command, option):
    """What the table says of an option of a command; None: nothing."""
    own = table.get(command, {})
    for of in (own, {"*": own["*"]} if "*" in own else {}, table["model"], table["every"]):
        found = of.get(option, of.get("*"))
        if found is not None:
            return found.replace("{function}", command.replace("-", "_"))
    return None


def missing(table, options):
    """(command, option) without a row."""
    return [(command, option) for command, all_of_it in options.items() for option in all_of_it if row(table, command, option) is None]


def mistake(place):
    """What is wrong with 'function(argument)', 'function' or 'Class.member'; empty: nothing."""
    name, _, argument = place.rstrip(")").partition("(")
    owner, _, member = name.partition(".")
    if owner not in fh.__all__ or not hasattr(fh, owner) or (member and not hasattr(getattr(fh, owner), member)):
        return f"fisherhill has no {name}"
    if argument and argument not in [one for one, _, _ in stub.parameters(stub.functions[owner])]:
        return f"{owner} has no argument {argument}"
    return ""


@unittest.skipUnless(PROGRAM, "FISHERHILL_PROGRAM is not set")
class ProgramOptions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.options = {}
        for command in commands():
            cls.options[command] = options_in(said(command))
        if "--trials" not in cls.options["robot"]:  # of a program of its own, which may not be there
            del cls.options["robot"]

    def test_the_options_are_read(self):
        self.assertGreater(len(self.options), 13)
        self.assertGreater(sum(map(len, self.options.values())), 200)
        self.assertIn("--set", self.options["calibrate"])
        self.assertIn("--help", self.options["calibrate"])

    def test_every_option_has_a_row(self):
        self.assertEqual(missing(TABLE, self.options), [])

    def test_a_new_option_or_command_would_be_missed(self):
        found = missing(TABLE, {"replay": ["--step", "--brand-new"], "brand-new": ["--deep", "--json"]})
        self.assertEqual(found, [("replay", "--brand-new"), ("brand-new", "--deep")])

    def test_every_row_is_an_options(self):
        shared = {option for options in self.options.values() for option in options}
        for section, rows in TABLE.items():
            if section in ("every", "model"):
                self.assertLessEqual(set(rows), shared, section)
            elif section != "robot" or "robot" in self.options:
                self.assertIn(section, self.options)
                self.assertLessEqual(set(rows) - {"*"}, set(self.options[section]), section)

    def test_every_command_has_a_section(self):
        self.assertLessEqual(set(self.options), set(TABLE))

    def test_what_a_row_names_is_there(self):
        for command, options in self.options.items():
            for option in options:
                said = row(TABLE, command, option)
                if said.startswith("none: "):
                    self.assertGreater(len(said), len("none: ") + 5, f"{command} {option}")
                    continue
                for place in said.split(";"):
                    self.assertEqual(mistake(place.strip()), "", f"{command} {option}")

    def test_a_row_that_names_nothing_would_be_found(self):
        self.assertEqual(mistake("replay(speed)"), "replay has no argument speed")
        self.assertEqual(mistake("repaly"), "fisherhill has no repaly")
        self.assertEqual(mistake("Model.with_wings"), "fisherhill has no Model.with_wings")
        self.assertEqual(mistake("Model.with_muscles"), "")


if __name__ == "__main__":
    unittest.main()
