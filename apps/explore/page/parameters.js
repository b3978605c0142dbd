"use strict";
// Sliders, and what the trials say of two parameters.

/// Four significant digits, as short as they can be.
function shortNumber(value) {
  return String(Number(value.toPrecision(4)));
}

class Sliders {
  /// @param changed  function(index, value)
  constructor(data, place, changed) {
    this.parameters = data.parameters;
    this.rows = data.parameters.map((p, index) => this.row(p, index, changed));
    place.replaceChildren(...this.rows.map(row => row.element));
  }

  row(p, index, changed) {
    const element = document.createElement("div");
    element.className = "slider";
    element.title = p.meaning;
    const head = document.createElement("div");
    head.className = "head";
    const label = document.createElement("label");
    p.name.split(/(?<=[._])/).forEach(part => label.append(part, document.createElement("wbr")));
    label.htmlFor = `parameter${index}`;
    const number = document.createElement("input");
    Object.assign(number, { type: "number", className: "value", step: "any" });
    if (p.lower !== null) number.min = p.lower;
    if (p.upper !== null) number.max = p.upper;
    number.setAttribute("aria-label", `${p.name}, value`);
    const unit = document.createElement("span");
    unit.className = "unit";
    unit.textContent = p.unit;
    const right = document.createElement("span");
    right.append(number, unit);
    head.append(label, right);
    const track = document.createElement("div");
    track.className = "track";
    const range = document.createElement("input");
    Object.assign(range, { type: "range", id: `parameter${index}`, step: "any", min: p.from, max: p.to });
    track.append(range);
    this.addBand(track, "prior", p, p.prior, p.priorSd);
    this.addBand(track, "posterior", p, p.value, p.sd);
    const mark = document.createElement("div");
    mark.className = "given";
    mark.style.left = this.place(p, p.before ?? p.value);
    mark.title = p.before === undefined ? "in the model" : "before the fit";
    track.append(mark);
    element.append(head, track);
    range.oninput = () => changed(index, Number(range.value));
    number.onchange = () => {
      const value = Number(number.value);
      const isAllowed = value >= (p.lower ?? -Infinity) && value <= (p.upper ?? Infinity);
      if (number.value !== "" && isAllowed) changed(index, value);
      else number.value = shortNumber(Number(range.value));
    };
    return { element, range, number };
  }

  // Where a value is on the track, whose knob has a width.
  place(p, value) {
    const share = Math.min(Math.max((value - p.from) / (p.to - p.from), 0), 1);
    return `calc(8px + ${share} * (100% - 16px))`;
  }

  addBand(track, kind, p, middle, sd) {
    if (!(sd > 0)) return;
    const band = document.createElement("div");
    band.className = `band ${kind}`;
    band.style.left = this.place(p, middle - sd);
    band.style.right = `calc(100% - (${this.place(p, middle + sd).slice(5, -1)}))`;
    band.title = `${kind === "prior" ? "prior" : "with these trials"}: ${shortNumber(middle)} ± ${shortNumber(sd)} ${p.unit}`;
    track.append(band);
  }

  show(values) {
    this.rows.forEach(({ range, number }, i) => {
      range.value = values[i];
      if (document.activeElement !== number) number.value = shortNumber(values[i]);
    });
  }

  /// Parameters that the chosen model does not have cannot be changed.
  enable(indices) {
    this.rows.forEach(({ element, range, number }, i) => {
      range.disabled = number.disabled = !indices.includes(i);
      element.style.opacity = range.disabled ? 0.4 : 1;
    });
  }
}

const svgNamespace = "http://www.w3.org/2000/svg";

class Ellipse {
  /// @param changed  function(index, value)
  constructor(data, changed) {
    this.data = data;
    this.svg = document.getElementById("ellipse");
    this.chosen = data.alike;
    ["across", "up"].forEach((id, axis) => {
      const select = document.getElementById(id);
      data.parameters.forEach((p, i) => {
        if (p.covarianceRow >= 0) select.add(new Option(p.name, i, false, i === this.chosen[axis]));
      });
      select.onchange = () => {
        this.chosen[axis] = Number(select.value);
        this.show(this.values);
      };
    });
    const move = event => {
      const box = this.svg.getBoundingClientRect();
      const x = (event.clientX - box.left) * 340 / box.width, y = (event.clientY - box.top) * 300 / box.height;
      const set = (axis, share) => {
        const p = data.parameters[this.chosen[axis]];
        const value = this.low[axis] + share * (this.high[axis] - this.low[axis]);
        changed(this.chosen[axis], Math.min(Math.max(value, p.from), p.to));
      };
      set(0, (x - 60) / 270);
      set(1, (250 - y) / 240);
    };
    this.svg.onpointerdown = event => { this.svg.setPointerCapture(event.pointerId); move(event); };
    this.svg.onpointermove = event => { if (event.buttons) move(event); };
  }

  add(kind, attributes, text = "") {
    const element = document.createElementNS(svgNamespace, kind);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    element.textContent = text;
    this.svg.append(element);
  }

  show(values) {
    this.values = values;
    const { data } = this, [i, j] = this.chosen, p = data.parameters[i], q = data.parameters[j];
    const [a, b] = [p.covarianceRow, q.covarianceRow];
    const C = [data.covariance[a][a], data.covariance[a][b], data.covariance[b][b]];
    const sd = [Math.sqrt(C[0]), Math.sqrt(C[2])];
    this.svg.replaceChildren();
    // three posterior deviations about the model, and the point in any case
    const middle = [p.value, q.value];
    const reach = [0, 1].map(k => Math.max(3.2 * sd[k], 1.15 * Math.abs(values[this.chosen[k]] - middle[k])));
    this.low = middle.map((m, k) => m - reach[k]);
    this.high = middle.map((m, k) => m + reach[k]);
    const X = x => 60 + 270 * (x - this.low[0]) / (this.high[0] - this.low[0]);
    const Y = y => 250 - 240 * (y - this.low[1]) / (this.high[1] - this.low[1]);
    const style = getComputedStyle(document.documentElement);
    const line = style.getPropertyValue("--line"), accent = style.getPropertyValue("--accent"), prior = style.getPropertyValue("--prior");
    this.add("rect", { x: 60, y: 10, width: 270, height: 240, fill: "none", stroke: line });
    const outline = (covariance, scale) => {
      const [xx, xy, yy] = covariance, l = Math.sqrt(xx), m = xx > 0 ? xy / l : 0, n = Math.sqrt(Math.max(yy - m * m, 0));
      const points = [];
      for (let k = 0; k <= 72; ++k) {
        const c = scale * Math.cos(k * Math.PI / 36), s = scale * Math.sin(k * Math.PI / 36);
        points.push(`${X(middle[0] + l * c).toFixed(2)},${Y(middle[1] + m * c + n * s).toFixed(2)}`);
      }
      return points.join(" ");
    };
    const clip = "url(#inside)";
    const define = document.createElementNS(svgNamespace, "clipPath");
    define.id = "inside";
    const box = document.createElementNS(svgNamespace, "rect");
    for (const [name, value] of Object.entries({ x: 60, y: 10, width: 270, height: 240 })) box.setAttribute(name, value);
    define.append(box);
    this.svg.append(define);
    const scale95 = Math.sqrt(-2 * Math.log(0.05));
    this.add("polygon", { points: outline([p.priorSd ** 2, 0, q.priorSd ** 2], 1), fill: "none", stroke: prior, "stroke-width": 3, "clip-path": clip });
    this.add("polygon", { points: outline(C, scale95), fill: accent, "fill-opacity": 0.15, stroke: accent, "stroke-dasharray": "5 4", "clip-path": clip });
    this.add("polygon", { points: outline(C, 1), fill: accent, "fill-opacity": 0.25, stroke: accent, "clip-path": clip });
    this.add("circle", { cx: X(middle[0]), cy: Y(middle[1]), r: 2.5, fill: accent });
    this.add("circle", { cx: X(values[i]), cy: Y(values[j]), r: 6, fill: "#d55e00", stroke: "#fff", "stroke-width": 1.5 });
    [0, 0.5, 1].forEach(share => {
      const at = k => shortNumber(this.low[k] + share * (this.high[k] - this.low[k]));
      this.add("text", { x: 60 + 270 * share, y: 266, "text-anchor": share === 0 ? "start" : share === 1 ? "end" : "middle" }, at(0));
      this.add("text", { x: 55, y: 250 - 240 * share + (share === 1 ? 10 : 4 * (share > 0)), "text-anchor": "end" }, at(1));
    });
    this.add("text", { x: 195, y: 288, "text-anchor": "middle" }, `${p.name}${p.unit ? ` [${p.unit}]` : ""}`);
    this.add("text", { transform: "translate(11 130) rotate(-90)", "text-anchor": "middle" }, `${q.name}${q.unit ? ` [${q.unit}]` : ""}`);
    const correlation = C[1] / (sd[0] * sd[1]);
    document.getElementById("ellipseNote").textContent = i === j ? "" :
      `Inner: one standard deviation; outer: 95 %; thick grey: one standard deviation of the prior. Correlation ${correlation.toFixed(2)}. ${data.covarianceNote} Drag the point.`;
  }
}
