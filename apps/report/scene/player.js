"use strict";
// Play, pause and scrub over a span of time; of explore's page and of reports.

class Player {
  /// @param parts  elements {button, range, clock, speed}
  /// @param show  called with each time [s]
  constructor(parts, show) {
    Object.assign(this, { parts, show, time: 0, start: 0, end: 0, playing: false, before: 0 });
    parts.button.onclick = () => this.toggle();
    parts.range.oninput = () => this.set(Number(parts.range.value));
  }

  setSpan(start, end) {
    this.start = start;
    this.end = end;
    Object.assign(this.parts.range, { min: start, max: end });
    this.set(start);
  }

  set(time) {
    this.time = time;
    this.parts.range.value = time;
    this.parts.clock.textContent = `${time.toFixed(3)} s`;
    this.parts.range.setAttribute("aria-valuetext", `${time.toFixed(2)} s`);
    this.show(time);
  }

  toggle() {
    this.playing = !this.playing;
    this.parts.button.textContent = this.playing ? "Pause" : "Play";
    this.before = performance.now();
    if (this.playing) requestAnimationFrame(now => this.advance(now));
  }

  advance(now) {
    if (!this.playing) return;
    const next = this.time + Number(this.parts.speed.value) * (now - this.before) / 1000;
    this.before = now;
    this.set(next > this.end ? this.start : Math.max(next, this.start));
    requestAnimationFrame(later => this.advance(later));
  }
}
