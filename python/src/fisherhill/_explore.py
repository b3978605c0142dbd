"""Writes the page of `fisherhill explore` by running the program, which has the simulation as WebAssembly inside."""

import math
import os
import pathlib
import shutil

from . import _fisherhill as fh


def _program():
    """The installed program: FISHERHILL_PROGRAM, else `fisherhill` on the PATH."""
    named = os.environ.get("FISHERHILL_PROGRAM", "")
    found = shutil.which(named or "fisherhill")
    if found is None:
        raise RuntimeError(
            f"explore runs the program {named or 'fisherhill'}, which is not there: build it with ./start and put "
            "build/program/apps on the PATH, or name it in the environment variable FISHERHILL_PROGRAM"
        )
    return found


def _names(given):
    return [given] if isinstance(given, str) else list(given)


def _files(given):
    several = not isinstance(given, (str, os.PathLike))
    files = [os.fspath(one) for one in given] if several else [os.fspath(given)]
    if not files:
        raise ValueError("trials: empty, must have at least one")
    return files


def _repeated(option, values):
    return [word for value in values for word in (option, value)]


def _assigned(option, values):
    return _repeated(option, [f"{name}={float(value)!r}" for name, value in values.items()])


def explore(
    model,
    trials,
    out,
    *,
    verdict="",
    parameters=(),
    noise=math.radians(1),
    values={},
    prescribe=(),
    initial={},
    wrap_as_cylinder=(),
    ignore_extra=False,
    force=False,
    coordinate=(),
    lock={},
    integrator="vi",
    step=None,
):
    import subprocess  # takes long for what few need

    words = [_program(), "explore", os.fspath(model), *_files(trials), "--out", os.fspath(out), "--noise", repr(math.degrees(noise))]
    if verdict:
        words += ["--verdict", os.fspath(verdict)]
    words += _repeated("--parameters", _names(parameters))
    words += _repeated("--prescribe", _names(prescribe)) + _repeated("--coordinate", _names(coordinate))
    words += _repeated("--wrap-as-cylinder", _names(wrap_as_cylinder))
    words += _assigned("--set", values) + _assigned("--initial", initial) + _assigned("--lock", lock)
    words += ["--integrator", integrator] + ([] if step is None else ["--step", repr(float(step))])
    words += ["--ignore-extra"] * ignore_extra + ["--force"] * force
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode == 0:
        return str(pathlib.Path(out) / "report.html")
    said = done.stderr.strip().rpartition("\n")[2] or f"{words[0]} ended with status {done.returncode}"
    raise (ValueError if done.returncode == 2 else RuntimeError)(said)


explore.__doc__ = fh._explore_docstring
explore.__module__ = __package__
