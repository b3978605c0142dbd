#!/usr/bin/env python3
"""Runs the commands whose output stands in pages of validation and compares it with the page.

    python3 validation/check_figures.py [--build build/program] [--write] PAGE.md [COMMAND-WORD …]

A page holds blocks

    <!-- figures of: COMMAND -->
    what COMMAND prints
    <!-- end of figures -->

Each command is run from the top of the source tree, with `build/program` in it replaced by the build folder. Its exit status must
be 0, and what it prints must be the block: the same words, and every number the same to two units of its last digit (2.2 stands
for 2.0 to 2.4). --write replaces the blocks instead. With words, only commands that contain all of them are run.
Exit status 1: a figure differs or a command failed; 2: a page without blocks, or without such a command.
"""
import argparse
import pathlib
import re
import shlex
import subprocess
import sys

BLOCK = re.compile(r"(<!-- figures of: (?P<command>.+?) -->\n)(?P<text>.*?)(<!-- end of figures -->)", re.S)
NUMBER = re.compile(r"(?<![\w.])[-+−]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
LAST_DIGITS = 2  # that a number may differ by: what another compiler or processor changes
TOP = pathlib.Path(__file__).resolve().parents[1]


def last_digit(number):
    """What one unit of a printed number's last digit is worth."""
    mantissa, _, exponent = number.lower().partition("e")
    digits = len(mantissa.partition(".")[2])
    return 10.0 ** (int(exponent or 0) - digits)


def differences(expected, printed):
    """In words, where two texts differ."""
    old, new = expected.strip().splitlines(), printed.strip().splitlines()
    found = []
    for a, b in zip(old, new):
        numbers, others = NUMBER.findall(a), NUMBER.findall(b)
        same = NUMBER.sub("#", a) == NUMBER.sub("#", b) and all(
            abs(float(x.replace("−", "-")) - float(y.replace("−", "-"))) <= (LAST_DIGITS + 1e-6) * last_digit(x)
            for x, y in zip(numbers, others))
        if not same:
            found.append(f"the page has  {a}\n  printed was   {b}")
    if len(old) != len(new):
        found.append(f"the page has {len(old)} lines, printed were {len(new)}")
    return found


def run(command, build):
    words = shlex.split(command.replace("build/program", build))
    return subprocess.run(words, cwd=TOP, capture_output=True, text=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--build", default="build/program")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("words", nargs="*")
    arguments = parser.parse_args()
    text = arguments.page.read_text(encoding="utf-8")
    chosen = [block for block in BLOCK.finditer(text) if all(word in block["command"] for word in arguments.words)]
    if not chosen:
        print(f"{arguments.page}: no figures of a command{' with ' if arguments.words else ''}{' '.join(arguments.words)}", file=sys.stderr)
        return 2
    failed = False
    for block in reversed(chosen):  # so that places before stay where they are
        done = run(block["command"], arguments.build)
        print(f"{block['command']}: exit status {done.returncode}")
        if done.returncode != 0:
            print(done.stdout + done.stderr)
            failed = True
        elif arguments.write:
            text = text[:block.start("text")] + done.stdout + text[block.end("text"):]
        else:
            for difference in differences(block["text"], done.stdout):
                print(difference)
                failed = True
    if arguments.write and not failed:
        arguments.page.write_text(text, encoding="utf-8")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
