#!/usr/bin/env python3
"""The 3-D view of reports in a headless Chromium: it moves, names stay text, nothing is asked from outside.

    report_playback_test.py PROGRAM SOURCE_DIR     status 77: no Chromium
"""

import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "explore"))

from browser import Browser, missing  # noqa: E402

largest_report = 3_000_000
hostile = "<img src=x onerror='window.bad=1'>.sto"

# The drawn picture as one number, and the page's own objects.
helpers = """const figure = document.querySelector('figure.playback'), { playback } = figure;
    const canvas = figure.querySelector('.stage canvas');
    const picture = () => [...canvas.toDataURL()].reduce((sum, c) => (sum * 31 + c.charCodeAt(0)) | 0, 0);
    const pause = ms => new Promise(resolve => setTimeout(resolve, ms));
    const press = key => canvas.dispatchEvent(new KeyboardEvent('keydown', { key, code: key === ' ' ? 'Space' : key }));
    """


def written(program, source, out, *words):
    run = subprocess.run([program, *map(str, words), "--out", out, "--force"], capture_output=True, text=True, cwd=source)
    assert (out / "report.html").is_file(), f"{words}: {run.stderr}"
    assert (out / "report.html").stat().st_size <= largest_report
    return out / "report.html"


def opened(browser, page):
    browser.open(page)
    assert browser.wait("document.querySelector('figure.playback')?.playback !== undefined"), browser.log()


def messages(browser):
    """What the console says; software rendering remarks that it is slow."""
    return [line for line in browser.log() if "GPU stall" not in line]


def plays(browser):
    told = browser.run(helpers + """const first = picture(), start = playback.player.time;
        playback.button.click();
        for (let tries = 0; tries < 200 && playback.player.time === start; ++tries) await pause(50);
        await pause(100);
        playback.button.click();
        const then = playback.player.time, second = picture();
        await pause(200);
        return {first, second, start, then, stopped: playback.player.time, label: playback.button.textContent};""")
    assert told["then"] > told["start"] and told["first"] != told["second"], told
    assert told["stopped"] == told["then"] and told["label"] == "Play", told
    scrubbed = browser.run(helpers + """const before = picture();
        playback.range.value = 0.7 * playback.range.max;
        playback.range.dispatchEvent(new Event('input'));
        return {moved: picture() !== before, time: playback.player.time, end: playback.player.end};""")
    assert scrubbed["moved"] and abs(scrubbed["time"] - 0.7 * scrubbed["end"]) < 1e-6, scrubbed
    turned = browser.run(helpers + """const pictures = [picture()];
        for (const key of ['ArrowLeft', 'ArrowUp', '+', '-']) { press(key); pictures.push(picture()); }
        press(' ');
        const playing = playback.player.playing;
        press(' ');
        return {different: new Set(pictures).size, playing, stopped: !playback.player.playing};""")
    assert turned["different"] >= 4 and turned["playing"] and turned["stopped"], turned


def shows_the_ghost(browser):
    told = browser.run(helpers + """const options = [...playback.ghost.select.options].map(o => o.text);
        const visible = playback.view.ghost.group.visible, before = picture();
        playback.ghost.select.value = '';
        playback.ghost.select.onchange();
        return {options, visible, hidden: !playback.view.ghost.group.visible, different: picture() !== before};""")
    assert "measured" in told["options"] and told["visible"] and told["hidden"] and told["different"], told


def is_where_the_states_are(browser, out):
    """The forearm turns by as much as the coordinate does."""
    lines = (out / "states.sto").read_text().splitlines()
    head = next(i for i, line in enumerate(lines) if line.startswith("time\t"))
    column = next(i for i, name in enumerate(lines[head].split("\t")) if name.endswith("elbow_flexion/value"))
    rows = [[float(x) for x in line.split("\t")] for line in lines[head + 1:]]
    moves = browser.run(helpers + """const { times } = playback.motion(0);
        const turns = time => {
          playback.player.set(time);
          return playback.view.limb.bodies.map(body => [0, 1, 2, 4, 5, 6, 8, 9, 10].map(i => body.matrix.elements[i]));
        };
        const first = turns(times[0]);
        // |R − R0| = √8 sin(angle/2)
        const angle = (a, b) => 2 * Math.asin(Math.min(1, Math.hypot(...a.map((x, i) => x - b[i])) / Math.sqrt(8)));
        return times.map(time => [time, Math.max(...turns(time).map((turned, b) => angle(turned, first[b])))]);""")
    assert len(moves) > 50
    for time, angle in moves:
        row = min(rows, key=lambda r: abs(r[0] - time))
        assert abs(angle - abs(row[column] - rows[0][column])) < 3e-4, (time, angle, row[column] - rows[0][column])


def keeps_to_itself(browser):
    told = browser.run("""let reached = true;
        try { await fetch('http://127.0.0.1:1/'); } catch (error) { reached = false; }
        return {bad: window.bad, images: document.images.length, reached,
                names: [...document.querySelectorAll('.playback option')].map(o => o.text)};""")
    assert told.get("bad") is None and told["images"] == 0 and not told["reached"], told
    refused = [line for line in messages(browser) if "127.0.0.1:1" not in line]
    assert not refused, refused


def falls_back(browser, page):
    """Without WebGL the drawing stays, and nothing is said on the console."""
    text = page.read_text().replace(
        "<script>", "<script>HTMLCanvasElement.prototype.getContext = (get => function (kind, ...more) {"
        " return kind.startsWith('webgl') ? null : get.call(this, kind, ...more); })"
        "(HTMLCanvasElement.prototype.getContext);</script><script>", 1)
    still = page.parent / "without.html"
    still.write_text(text)
    browser.open(still)
    told = browser.run("""const svg = document.querySelector('.playback .still');
        return {shown: svg.getBoundingClientRect().height > 50, stage: document.querySelector('.stage') !== null,
                words: svg.getAttribute('aria-label')};""")
    assert told["shown"] and not told["stage"] and "elbow_flexion between" in told["words"], told
    assert not messages(browser)


def main():
    if lacking := missing():
        print(lacking)
        return 77
    program, source = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as name, Browser() as browser:
        folder = pathlib.Path(name)
        model, slow = source / "models/elbow8.osim", source / "emg_data/curl_slow.sto"
        page = written(program, source, folder / "replay", "replay", model, slow)
        opened(browser, page)
        plays(browser)
        shows_the_ghost(browser)
        is_where_the_states_are(browser, page.parent)
        assert not messages(browser)
        falls_back(browser, page)
        # a trial with a hostile name beside another one, in the chooser
        trial = folder / hostile
        trial.write_bytes((source / "emg_data/curl_fast.sto").read_bytes())
        opened(browser, written(program, source, folder / "calibrate", "calibrate", model, slow, "--hold-out", trial,
                                "--parameters", "hand.mass"))
        told = browser.run(helpers + """const texts = select => [...select.options].map(o => o.text);
            return {trials: texts(playback.trials.select), motions: texts(playback.shown.select)};""")
        assert len(told["trials"]) == 2 and "<img" in told["trials"][0] and "(held out)" in told["trials"][0], told
        assert told["motions"] == ["calibrated", "before"], told
        plays(browser)
        keeps_to_itself(browser)
    return 0


if __name__ == "__main__":
    sys.exit(main())
