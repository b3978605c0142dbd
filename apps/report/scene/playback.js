"use strict";
// Plays the motions of a report: every figure.playback whose numbers stand in its script element.
(() => {
  /// The stream of a motion as numbers that View.setDrawing takes, at any of its times.
  class Motion {
    /// @param given   {times, centre, unit, data}: see packed_frames.h
    /// @param bodies  how many
    constructor(given, bodies) {
      Object.assign(this, { times: given.times, centre: given.centre, unit: given.unit, bodies });
      const bytes = Uint8Array.from(atob(given.data), c => c.charCodeAt(0));
      const view = new DataView(bytes.buffer);
      const stream = { at: 0, next: () => view.getInt16(2 * stream.at++, true) };
      this.frames = this.times.map(() => this.frameFrom(stream, given.lines));
    }

    pointFrom(stream) {
      return this.centre.map(c => c + this.unit * stream.next());
    }

    frameFrom(stream, lines) {
      const frame = { bodies: [], lines: [] };
      for (let i = 0; i < this.bodies; ++i)
        frame.bodies.push({ p: this.pointFrom(stream), turn: [0, 0, 0, 0].map(() => stream.next() / 32767) });
      for (let i = 0; i < lines; ++i) {
        const count = stream.next(), line = { radius: 1e-5 * stream.next(), activation: stream.next() / 1e4, points: [] };
        if (line.activation < 0) line.activation = NaN;
        for (let k = 0; k < count; ++k) line.points.push(this.pointFrom(stream));
        frame.lines.push(line);
      }
      return frame;
    }

    /// Frames before and after a time, and the share of the second.
    around(time) {
      const last = this.times.length - 1;
      let k = 0;
      while (k + 1 < last && this.times[k + 1] <= time) ++k;
      const next = Math.min(k + 1, last);
      const share = next > k ? (time - this.times[k]) / (this.times[next] - this.times[k]) : 0;
      return [this.frames[k], this.frames[next], Math.min(Math.max(share, 0), 1)];
    }

    /// The numbers of Core.drawing(); null where the posture is not known.
    at(time) {
      const [a, b, share] = this.around(time);
      const between = (x, y) => x.map((value, i) => value + share * (y[i] - value));
      const numbers = [];
      for (let i = 0; i < this.bodies; ++i) {
        const from = a.bodies[i], to = b.bodies[i];
        const cosine = from.turn.reduce((sum, x, k) => sum + x * to.turn[k], 0);
        if (cosine === 0) return null;
        let [x, y, z, w] = between(from.turn, to.turn.map(v => Math.sign(cosine) * v));
        const size = Math.hypot(x, y, z, w);
        x /= size; y /= size; z /= size; w /= size;
        numbers.push(1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
                     2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                     2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), ...between(from.p, to.p));
      }
      a.lines.forEach((from, i) => {
        const to = b.lines[i];
        const points = lineBetween(from.points, to.points, share);
        const [radius, activation] = between([from.radius, from.activation], [to.radius, to.activation]);
        numbers.push(points.length, 0, activation, radius, ...points.flat());
      });
      return new Float64Array(numbers);
    }
  }

  /// Shares of the length at which the points of a line are.
  function sharesOf(points) {
    const along = [0];
    for (let k = 1; k < points.length; ++k)
      along.push(along[k - 1] + Math.hypot(...points[k].map((x, i) => x - points[k - 1][i])));
    const whole = along.at(-1);
    return whole > 0 ? along.map(s => s / whole) : along.map((s, k) => k / Math.max(1, along.length - 1));
  }

  function pointsAt(points, shares, wanted) {
    let k = 0;
    return wanted.map(s => {
      while (k + 2 < points.length && shares[k + 1] < s) ++k;
      const part = shares[k + 1] - shares[k];
      const f = part > 0 ? Math.min(Math.max((s - shares[k]) / part, 0), 1) : 0;
      return points[k].map((x, i) => x + f * (points[k + 1][i] - x));
    });
  }

  /// A line between two others, which may have different numbers of points.
  function lineBetween(a, b, share) {
    if (a.length < 2 || b.length < 2) return share < 0.5 ? a : b;
    if (a.length !== b.length) {
      const ofA = sharesOf(a), ofB = sharesOf(b);
      const all = [...ofA, ...ofB.slice(1, -1)].sort((x, y) => x - y);
      [a, b] = [pointsAt(a, ofA, all), pointsAt(b, ofB, all)];
    }
    return a.map((p, k) => p.map((x, i) => x + share * (b[k][i] - x)));
  }

  const element = (name, properties = {}, ...children) => {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  };
  const choice = (label, options, chosen) => {
    const select = element("select");
    options.forEach(([value, text]) => select.add(new Option(text, value, false, value === chosen)));
    return { select, label: element("label", {}, label + " ", select) };
  };

  class Playback {
    constructor(figure, data) {
      Object.assign(this, { data, trial: 0, motions: new Map() });
      data.models.forEach(model => { model.shapes = new Float64Array(model.shapes); });
      this.canvas = element("canvas", { tabIndex: 0 });
      this.canvas.setAttribute("role", "img");
      this.canvas.setAttribute("aria-label", `${data.description} Drag or arrow keys turn the view, + and − zoom.`);
      this.addControls(figure);
      this.view = new View(this.canvas);
      this.view.setUp(data.up);
      // a wheel or finger that passes by scrolls the page
      this.view.controls.enableZoom = false;
      this.canvas.style.touchAction = "pan-y";
      this.canvas.addEventListener("focus", () => { this.view.controls.enableZoom = true; });
      this.canvas.addEventListener("blur", () => { this.view.controls.enableZoom = false; });
      this.canvas.addEventListener("pointerdown", () => this.canvas.focus({ preventScroll: true }));
      this.canvas.addEventListener("keydown", event => this.press(event));
      this.player = new Player({ button: this.button, range: this.range, clock: this.clock, speed: this.speed.select },
                               time => this.show(time));
      figure.classList.add("live");
      window.addEventListener("resize", () => this.view.resize());
      this.view.resize();
      this.takeTrial(0);
      figure.playback = this;  // for scripts and tests
    }

    addControls(figure) {
      const { data } = this;
      this.button = element("button", { type: "button", textContent: "Play" });
      this.range = element("input", { type: "range", step: "any" });
      this.range.setAttribute("aria-label", "time");
      this.clock = element("output");
      this.trials = choice("Trial", data.trials.map((trial, i) => [String(i), trial.name]), "0");
      this.trials.label.hidden = data.trials.length < 2;
      this.shown = choice("Motion", [], "");
      this.ghost = choice("Ghost", [], "");
      const sides = ["side", "front", "top", "isometric"];
      this.camera = choice("View", sides.map(side => [side, side]), data.view);
      this.speed = choice("Speed", ["0.1", "0.25", "0.5", "1", "2"].map(x => [x, x]), "1");
      const wraps = element("input", { type: "checkbox" });
      const wrapLabel = element("label", { hidden: !data.hasWraps }, wraps, " wrap surfaces");
      const bar = element("canvas", { width: 160, height: 10 });
      drawColours(bar);
      const colours = element("div", { className: "colours", hidden: !(data.largest > 0) },
        "activation 0", bar, String(data.largest));
      const stage = element("div", { className: "stage" }, this.canvas, colours,
        element("div", { className: "row" }, this.button, this.range, this.clock),
        element("div", { className: "row" }, this.trials.label, this.shown.label, this.ghost.label, this.camera.label,
          this.speed.label, wrapLabel));
      figure.querySelector(".still").before(stage);
      this.trials.select.onchange = () => this.takeTrial(Number(this.trials.select.value));
      this.shown.select.onchange = () => this.show(this.player.time);
      this.ghost.select.onchange = () => this.show(this.player.time);
      this.camera.select.onchange = () => { this.view.lookFrom(this.camera.select.value); this.view.render(); };
      wraps.onchange = () => this.view.showWraps(wraps.checked);
    }

    press(event) {
      const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
      const zooms = { "+": 0.9, "=": 0.9, "-": 1 / 0.9 };
      if (turns[event.key]) this.view.turn(...turns[event.key]);
      else if (zooms[event.key]) this.view.zoom(zooms[event.key]);
      else if (event.code === "Space") this.player.toggle();
      else return;
      event.preventDefault();
    }

    /// Decoded when it is first shown.
    motion(index) {
      const given = this.data.trials[this.trial].motions[index];
      if (!this.motions.has(given)) this.motions.set(given, new Motion(given, this.data.models[given.model].bodies));
      return this.motions.get(given);
    }

    takeTrial(index) {
      this.trial = index;
      const { motions, start, end } = this.data.trials[index];
      const fill = (one, options, chosen) => {
        one.select.replaceChildren();
        options.forEach(([value, text]) => one.select.add(new Option(text, value, false, value === chosen)));
      };
      const solid = motions.map((motion, i) => [String(i), motion.name]).filter(([i]) => !motions[i].isGhost);
      fill(this.shown, solid, solid[0][0]);
      this.shown.label.hidden = solid.length < 2;
      const measured = motions.findIndex(motion => motion.isGhost);
      fill(this.ghost, [["", "none"], ...motions.map((motion, i) => [String(i), motion.name])], measured < 0 ? "" : String(measured));
      this.ghost.label.hidden = motions.length < 2;
      this.fit();
      this.player.setSpan(start, end);
    }

    /// The view has room for the whole motion.
    fit() {
      this.view.bounds = null;
      this.view.isFitted = true;
      const { start, end } = this.data.trials[this.trial];
      let all = null;
      for (let i = 0; i <= 8; ++i) {
        this.show(start + i * (end - start) / 8);
        all = all ? all.union(this.view.content()) : this.view.content();
      }
      this.view.bounds = all;
      this.view.lookFrom(this.camera.select.value);
    }

    show(time) {
      const { models, trials, largest } = this.data;
      const { motions } = trials[this.trial];
      const shown = Number(this.shown.select.value), ghost = this.ghost.select.value;
      const shapes = models[motions[shown].model];
      this.view.setShapes(shapes.shapes, shapes.bodies);
      const other = ghost === "" || Number(ghost) === shown ? null : this.motion(Number(ghost)).at(time);
      if (other) {
        const its = models[motions[ghost].model];
        this.view.setGhost(its.shapes, its.bodies, other);
      } else {
        this.view.hideGhost();
      }
      const drawing = this.motion(shown).at(time);
      if (drawing) this.view.setDrawing(drawing, largest || 1);
    }
  }

  const hasWebGl = () => {
    const context = document.createElement("canvas").getContext("webgl2");
    if (context) context.getExtension("WEBGL_lose_context")?.loseContext();
    return context !== null;
  };
  document.querySelectorAll("figure.playback").forEach(figure => {
    if (!hasWebGl()) return;  // the still drawing stays
    new Playback(figure, JSON.parse(figure.querySelector("script").textContent));
  });
})();
