#!/usr/bin/env python3
"""The page of `explore` in a headless Chromium: it simulates what the program simulates, and asks nobody.

    page_test.py PROGRAM SOURCE_DIR     status 77: no Chromium
    page_test.py --times PROGRAM SOURCE_DIR     first picture, also in a browser that has just been started, and simulations
                                                per second while a slider moves
"""

import json
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

from browser import Browser, missing

largest_page = 3_000_000
settings = 50


def table(path):
    """Column names and rows of a .sto file."""
    lines = path.read_text().splitlines()
    head = next(i for i, line in enumerate(lines) if line.split("\t")[0] == "time")
    return lines[head].split("\t"), [[float(x) for x in line.split("\t")] for line in lines[head + 1:] if line]


class Case:
    def __init__(self, program, folder, model, trial, *options):
        self.program, self.folder, self.model, self.trial, self.options = program, folder, model, trial, options

    def call(self, *words):
        run = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True)
        assert run.returncode == 0, f"{words}: {run.stderr}"

    def page(self, name, *more):
        out = self.folder / name
        self.call("explore", self.model, self.trial, *self.options, *more, "--out", out)
        assert (out / "report.html").stat().st_size <= largest_page
        return out / "report.html"

    def replayed(self, values, step):
        out = self.folder / "replay"
        words = [word for name, value in values.items() for word in ("--set", f"{name}={value!r}")]
        self.call("replay", self.model, self.trial, *self.options, "--step", step, *words, "--out", out, "--force")
        return table(out / "states.sto")


def simulates_as_the_program(browser, case, settings, seed):
    """The largest difference of a coordinate over random settings of the sliders [rad] or [m]."""
    draw = random.Random(seed)
    browser.open(case.page("compared"))
    assert browser.wait("document.body.dataset.ready === 'yes'"), browser.log()
    parameters = browser.run("return JSON.parse(document.getElementById('data').textContent).parameters")
    largest, failed = 0, 0
    for setting in range(1 + settings):
        # first what the page begins with
        values = {p["name"]: draw.uniform(p["from"], p["to"]) for p in parameters} if setting > 0 else {}
        page = browser.run("""const { state, set } = window.explore;
            const result = Object.keys(arguments[0]).length ? await set(arguments[0]) : state.result;
            return {trouble: document.getElementById('trouble').textContent, names: result.names.coordinates,
                    times: [...result.times], q: [...result.coordinates], step: result.asked.step};""".replace(
                        "arguments[0]", "a[0]"), values)
        assert setting > 0 or not page["trouble"], page["trouble"]
        if page["trouble"]:
            failed += 1
            continue
        columns, rows = case.replayed(values, page["step"])
        assert [row[0] for row in rows] == page["times"], "other times"
        for i, name in enumerate(page["names"]):
            column = next(c for c, title in enumerate(columns) if title.endswith(f"/{name}/value"))
            for k, row in enumerate(rows):
                largest = max(largest, abs(row[column] - page["q"][k * len(page["names"]) + i]))
    assert failed <= settings // 5, f"{failed} of {settings} settings could not be simulated"
    return largest


def keeps_to_itself(browser, case):
    """Names stay text, and nothing is asked from outside."""
    browser.open(case.page("hostile"))
    assert browser.wait("document.body.dataset.ready === 'yes'"), browser.log()
    told = browser.run("""let reached = true;
        try { await fetch('http://127.0.0.1:1/'); } catch (error) { reached = false; }
        return {bad: window.bad, images: document.images.length, scripts: document.scripts.length,
                title: document.title, policy: document.querySelector('meta[http-equiv]').content, reached};""")
    assert told.get("bad") is None and told["images"] == 0 and told["scripts"] == 6, told
    assert "<img" in told["title"] and "default-src 'none'" in told["policy"] and not told["reached"], told
    refused = [line for line in browser.log() if "Content Security Policy" in line]
    assert refused and all("127.0.0.1:1" in line for line in refused), refused


def tells_the_command(browser, case, sets):
    """The command line below the page gives the page's own motion; it sets so many numbers."""
    browser.open(case.page(f"command_{sets}"))
    assert browser.wait("document.body.dataset.ready === 'yes'"), browser.log()
    words = browser.run("""const name = JSON.parse(document.getElementById('data').textContent).parameters[1].name;
        await window.explore.set({[name]: window.explore.state.values[1] * 1.02});
        return document.getElementById('command').textContent;""")
    assert words.startswith("fisherhill replay ") and words.count("--set ") == sets, words
    out = case.folder / f"told_{sets}"
    run = subprocess.run(words.replace("fisherhill", str(case.program), 1) + f" --out {out}", shell=True,
                         capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    last = browser.run("return window.explore.state.result.coordinates.at(-1)")
    columns, rows = table(out / "states.sto")
    column = next(i for i, name in enumerate(columns) if name.endswith("elbow_flexion/value"))
    assert abs(rows[-1][column] - last) <= 1e-9, (rows[-1][column], last)


def follows_the_hand_with_drafts(browser, case):
    """A simulation that takes long is replaced by drafts while a slider moves, and done when it rests."""
    browser.open(case.page("dragged"))
    assert browser.wait("document.body.dataset.ready === 'yes'"), browser.log()
    told = browser.run("""const state = window.explore.state, fit = document.getElementById('fit'), seen = [];
        const slider = document.querySelectorAll('#sliders input[type=range]')[1];
        window.explore.drafts.longer = 0;  // every simulation takes long
        const until = async is => { while (!is()) await new Promise(resolve => setTimeout(resolve, 5)); };
        await until(() => state.result && !state.result.asked.isDraft);
        for (let k = 1; k <= 6; ++k) {
          slider.value = state.values[1] * 1.001;
          slider.dispatchEvent(new Event('input'));
          const before = state.result;
          await until(() => state.result !== before);
          seen.push([state.result.asked.isDraft === true, state.result.asked.step, fit.textContent.includes('Draft')]);
        }
        const drafted = state.result.coordinates.at(-1);
        await until(() => !state.result.asked.isDraft);
        const rested = state.result, shown = fit.textContent, value = rested.asked.values[1] === state.values[1];
        const again = await window.explore.set({});
        // a file that is asked for while a draft is shown
        const saved = [];
        URL.createObjectURL = blob => { saved.push(blob); return ''; };
        HTMLAnchorElement.prototype.click = () => {};
        window.explore.drafts.rest = 1e6;
        slider.value = state.values[1] * 1.001;
        slider.dispatchEvent(new Event('input'));
        await until(() => state.result.asked.isDraft);
        document.getElementById('csv').click();
        await until(() => saved.length > 0);
        const lines = (await saved[0].text()).trim().split('\\n').length;
        return {seen, drafted, lines, rows: rested.times.length, rested: rested.coordinates.at(-1),
                again: again.coordinates.at(-1), shown, step: rested.asked.step, value};""")
    assert told["seen"] == [[True, step, True] for step in (0.02, 0.05, 0.1, 0.1, 0.1, 0.1)], told
    assert told["step"] == 0.01 and told["value"] and "Draft" not in told["shown"], told
    assert told["lines"] == 1 + told["rows"], told  # what is saved is what was asked for
    assert told["again"] == told["rested"] and 0 < abs(told["drafted"] - told["rested"]) < 0.1, told


def first_picture(browser, page):
    """Milliseconds from opening the page."""
    browser.open(page)
    assert browser.wait("document.body.dataset.ready === 'yes'", 120), browser.log()
    return browser.run("return Math.round(performance.getEntriesByName('first picture')[0].startTime);")


def times(browser, case):
    page = case.page("timed")
    with Browser() as new:
        in_a_new_browser = first_picture(new, page)
    pictures = [first_picture(browser, page) for _ in range(4)]
    return {"first_picture_ms": statistics.median(pictures[1:]),
            "in_a_browser_just_started_ms": in_a_new_browser} | browser.run("""
        const begin = window.explore.state.values[1];
        let frames = 0, simulations = 0, last = null, moving = true;
        (function count() {
          ++frames;
          if (window.explore.state.result !== last) { ++simulations; last = window.explore.state.result; }
          if (moving) requestAnimationFrame(count);
        })();
        const slider = document.querySelectorAll('#sliders input[type=range]')[1];
        const start = performance.now();
        while (performance.now() - start < 5000) {
          slider.value = begin * (1 + 0.02 * Math.sin((performance.now() - start) / 300));
          slider.dispatchEvent(new Event('input'));
          await new Promise(resolve => setTimeout(resolve, 8));
        }
        moving = false;
        const seconds = (performance.now() - start) / 1000;
        return {frames_per_s: Math.round(frames / seconds),
                simulations_per_s: Math.round(10 * simulations / seconds) / 10};""")


def main():
    words = sys.argv[1:]
    if lacking := missing():
        print(lacking)
        return 77
    timed = words[0] == "--times"
    program, source = pathlib.Path(words[timed]).resolve(), pathlib.Path(words[timed + 1]).resolve()
    with tempfile.TemporaryDirectory() as name, Browser() as browser:
        folder = pathlib.Path(name)
        elbow = Case(program, folder, source / "models/elbow8.osim", source / "emg_data/curl_slow.sto")
        if timed:
            cases = {"elbow8": elbow}
            for i in range(2 + timed, len(words), 2):
                cases[words[i]] = Case(program, folder / str(i), words[i], words[i + 1], "--ignore-extra")
            for case in cases.values():
                case.folder.mkdir(exist_ok=True)
            print(json.dumps({name: times(browser, case) for name, case in cases.items()}, indent=2))
            return 0
        difference = simulates_as_the_program(browser, elbow, settings, 1)
        print(f"largest difference over {settings} settings: {difference:.3g} rad")
        assert difference <= 1e-9, difference
        tells_the_command(browser, elbow, 1)
        follows_the_hand_with_drafts(browser, elbow)
        # also with numbers that are set from the start, one with a slider and one without
        numbers = "--set", "BRA.optimal_fiber_length=0.09", "--set", "TRImed.pennation_angle=0.1"
        more = "--parameters", "BRA.optimal_fiber_length,hand.mass"
        tells_the_command(browser, Case(program, folder, elbow.model, elbow.trial, *numbers, *more), 3)
        trial = folder / "<img src=x onerror='window.bad=1'>.sto"
        trial.write_bytes(elbow.trial.read_bytes())
        keeps_to_itself(browser, Case(program, folder, elbow.model, trial))
    return 0


if __name__ == "__main__":
    sys.exit(main())
