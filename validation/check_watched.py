#!/usr/bin/env python3
"""Is every script and program of validation run by an everyday test?

    python3 validation/check_watched.py BUILD

Scripts begin with #!, programs have a main(). Each must be named by the command of a test without the label `slow`, or stand in
EXCEPTIONS with the reason. Exit status 1 if one does not, or if an exception is run or is not there any more.
"""
import pathlib
import re
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
SLOW = "minutes long; a test of the label slow runs it"
SHARED = "needs models or tables that are not part of the project"
BLIND = "minutes long; generator, search and scoring run in short form in Quick.RobotsSuite and DiscoverySlice"
EXCEPTIONS = {
    "active_estimation_study": SLOW,
    "design_elbow": SLOW,
    "opensim_differences": SHARED,
    "posture_tables": SHARED,
    "opensim_motions.py": SHARED,
    "channel_cost": SHARED,
    "recorded_curls": SHARED,
    "free_pendulum.py": "needs published recordings, which are not part of the project",
    "driven_pendulum.py": "needs published recordings, which are not part of the project",
    "heavy_slide.py": "a minute or more of processor time for a set, in which three effects are found one after another",
    "opensim_sets.py": "needs sets that OpenSim made, which are not part of the project",
    "make_trials.py": "needs the published recordings, which are not part of the project",
    "replay_reports.py": "needs verdicts of a search",
    "elbow_blind": BLIND,
    "elbow_suite": BLIND,
    "equivalents_suite": BLIND,
    "reduced_benchmark": BLIND,
    "baseline_regression": BLIND,
    "look.sh": "read by robots_suite",
    "small_models.py": "read by every_command.py",
    "subject.py": "read by make_sets.py",
    "mechanisms.py": "read by scaled_twins.py and others",
    "make_hidden_elbow": "run by hidden_data_test",
    "make_hidden_robot": "run by robots_suite",
    "score_discovery": "run by robots_suite",
}


def scripts_and_programs():
    for path in sorted(FOLDER.rglob("*")):
        if not path.is_file() or path.suffix in (".md", ".txt", ".cmake", ".h", ".pyc"):
            continue
        text = path.read_text(encoding="utf-8", errors="ignore")
        if path.suffix == ".cc":
            if re.search(r"^int main\(", text, re.M):
                yield path.stem
        elif text.startswith("#!") or path.suffix in (".py", ".sh"):
            yield path.name


def everyday_words(build):
    """All words of the commands of tests that are not slow."""
    # read from CMake's own files: ctest does not show commands of programs that are not built yet
    for path in pathlib.Path(build, "validation").rglob("CTestTestfile.cmake"):
        text = path.read_text(encoding="utf-8")
        slow = set(re.findall(r"set_tests_properties\(\[=*\[(.+?)\]=*\] .*LABELS \"slow[\";]", text))
        for name, command in re.findall(r"add_test\(\[=*\[(.+?)\]=*\] (.*)\)", text):
            if name in slow:
                continue
            for word in re.findall(r"[^\s\"]+", command):
                yield pathlib.PurePath(word).name
                if word.endswith(".md"):  # check_figures.py runs the commands of a page
                    page = (FOLDER.parent / word).read_text(encoding="utf-8")
                    for line in re.findall(r"<!-- figures of: (.+?) -->", page):
                        yield from (pathlib.PurePath(w).name for w in line.split())


def main():
    run = set(everyday_words(sys.argv[1]))
    run |= {"kill_ranks", "interrupt_start"}  # registered where mpirun is
    there = set(scripts_and_programs())
    wrong = [f"{name}: no everyday test runs it" for name in sorted(there - run - EXCEPTIONS.keys())]
    wrong += [f"{name}: an exception, but a test runs it" for name in sorted(EXCEPTIONS.keys() & run)]
    wrong += [f"{name}: an exception that is not there" for name in sorted(EXCEPTIONS.keys() - there)]
    print("\n".join(wrong) or f"{len(there)} scripts and programs, {len(EXCEPTIONS)} exceptions")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
