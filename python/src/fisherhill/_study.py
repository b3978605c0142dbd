"""Carries the subjects of a study through emg, calibrate and discover, as `fisherhill study run` does."""

import contextlib
import math
import os
import re
import tempfile
from types import SimpleNamespace

from . import _fisherhill as fh
from ._progress import listener
from ._results import StudyRows


class _StageFailure(Exception):
    """A stage that could not be carried out; its message is that of the subject's row."""


@contextlib.contextmanager
def _stage(name):
    try:
        yield
    except Exception as error:
        raise _StageFailure(f"{name}: {error}") from error


def _angle(text, key):
    """[rad] of '30deg', '0.5rad' or '0.5'; all else are plain numbers [m]."""
    unit = math.pi / 180 if text.endswith("deg") else 1.0
    number = text[:-3] if text.endswith(("deg", "rad")) else text
    try:
        value = unit * float(number)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"{key}: '{text}' is not an angle: write 34deg, or 0.59 for radians")
    return value


def _assigned(texts, key):
    """{name: value} of NAME=VALUE, as a key of the file lists them."""
    values = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not name or not equals:
            raise ValueError(f"{key}: '{text}' is not NAME=VALUE")
        if name in values:
            raise ValueError(f"{key}: '{name}' is given twice")
        values[name] = _angle(value, key)
    return values


def _of_one_trial(name):
    """Whether an estimate is a start or a knot of a latent excitation, which belong to one trial."""
    return re.search(r"(^|\.)initial\.|\.latent\d+$", name) is not None


def _trial_files(subject, folder):
    """(training, held out), with those made of recordings."""
    train, held_out = list(subject.train), list(subject.hold_out)
    for i, recording in enumerate(subject.recordings, 1):
        with _stage(f"emg_{i}"):
            file = os.path.join(folder, f"emg_{i}.sto")
            fh.emg(recording.file, recording.config, write=file)
        (held_out if recording.held_out else train).append(file)
    return train, held_out


def _trial(file, model, held):
    trial = fh.load_trial(file, model, hold=held)
    for remark in trial.review(model):
        if remark.weight == "error":
            raise ValueError(f"{file}: {remark.subject}: {remark.message}")
    return trial


def _inputs(study, subject, files, moments):
    """Model, trials and the options that calibrate and discover share.

    moments: whether the moments at locked coordinates are among the data.
    """
    model = fh.load_model(subject.model)
    locks = _assigned(study.lock, "lock")
    if numbers := _assigned([*study.set, *subject.set], "set"):
        model = model.with_parameters(numbers, lock=locks)
    held = {}
    if moments:
        held = fh._held(model, [fh.load_trial(file, model) for file in files[0]], study.coordinates, locks)
    train, held_out = ([_trial(file, model, held) for file in some] for some in files)
    shared = {
        "hold_out": held_out,
        "noise": study.noise,
        "coordinate": study.coordinates,
        "lock": {name: value for name, value in locks.items() if name not in held},
        "step": study.step,
    }
    return model, train, shared


def _calibrate(study, subject, files, seed, threads, row):
    model, train, shared = _inputs(study, subject, files, moments=True)
    try:
        found = fh.calibrate(
            model,
            train,
            study.parameters,
            priors=study.priors,
            own_start=study.own_start,
            starts=study.starts,
            seed=seed,
            threads=threads,
            **shared,
        )
    except RuntimeError as error:
        row.status, row.message = "no solution", str(error)
        return
    row.calibration = found
    for name in ("rmse_before", "rmse_after", "rmse_held_out_before", "rmse_held_out"):
        setattr(row, name, getattr(found, name))
    if not math.isnan(found.rmse_before):  # else no angle is measured
        row.noise = found.noise
    of_subject = [one for name, one in found.estimates.items() if not _of_one_trial(name)]
    row.parameters = len(of_subject)
    row.identifiable = sum(one.identifiable for one in of_subject)
    if not found.converged:
        row.status, row.message = "not converged", found.why


def _discover(study, subject, files, row):
    model, train, shared = _inputs(study, subject, files, moments=False)
    found = fh.discover(model, train, max_effects=study.max_effects, without=study.without, **shared)
    row.discovery = found
    row.verdict, row.sentence = found.verdict, found.sentence
    row.effects = [one.id for one in found.effects]
    if found.effects:
        row.probability = found.effects[0].probability


def _row(study, subject, seed, threads):
    row = SimpleNamespace(
        subject=subject.name,
        status="ok",
        rmse_before=math.nan,
        rmse_after=math.nan,
        rmse_held_out_before=math.nan,
        rmse_held_out=math.nan,
        noise=math.nan,
        identifiable=0,
        parameters=0,
        verdict="",
        effects=[],
        probability=math.nan,
        sentence="",
        message="",
        calibration=None,
        discovery=None,
    )
    try:
        with tempfile.TemporaryDirectory() as folder:
            files = _trial_files(subject, folder)
            if study.parameters:
                with _stage("calibrate"):
                    _calibrate(study, subject, files, seed, threads, row)
            if study.discover:
                with _stage("discover"):
                    _discover(study, subject, files, row)
    except _StageFailure as failure:
        row.status, row.message = "failed", str(failure)
    return row


def _asked(plan, names):
    if names is None:
        return plan.subjects
    known = [subject.name for subject in plan.subjects]
    for name in names:
        if name not in known:
            raise ValueError(f"subjects: '{name}' is none of the study, which has {', '.join(known)}")
    return [subject for subject in plan.subjects if subject.name in names]


def study(file, *, subjects=None, each=None, seed=1, threads=1, progress=False):
    plan = fh.read_study(file)
    asked = _asked(plan, subjects)
    told = listener(progress, "study")
    rows = StudyRows()
    try:
        for subject in asked:
            rows.append(_row(plan, subject, seed, threads))
            if each is not None:
                each(rows[-1])
            if told is not None:
                told(len(rows) / len(asked))
    finally:
        if told is not None:
            told.close()
    return rows


study.__doc__ = fh._study_docstring
study.__module__ = __package__
