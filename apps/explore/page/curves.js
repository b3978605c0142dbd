"use strict";
// Measured and simulated curves, what is left between them, and what drives the muscles.

const mostMuscles = 10;
const mostPoints = 160;

class Curves {
  constructor(data, colours) {
    this.data = data;
    this.colours = colours;
    this.channel = 0;
    this.inputs = "excitations";
    this.time = 0;
  }

  /// What the motion's curve can show: measured channels, then coordinates that were not measured.
  channels(trial) {
    const measured = trial.channels.map((c, i) => ({ ...c, measured: i }));
    const others = this.data.coordinates
      .filter(c => !trial.channels.some(m => m.coordinate === c.name))
      .map(c => ({ ...c, coordinate: c.name, measured: -1 }));
    return [...measured, ...others].map(c => ({ ...c, label: c.name + (c.measured < 0 ? " (simulated)" : "") }));
  }

  // Times and values of a channel in a result.
  simulated(result, trial, channel) {
    const row = result.names.coordinates.indexOf(channel.coordinate);
    if (row >= 0) {
      const count = result.names.coordinates.length;
      return [result.times, Float64Array.from(result.times, (_, k) => channel.factor * result.coordinates[k * count + row])];
    }
    let from = 0;
    for (let i = 0; i < channel.measured; ++i) from += trial.channels[i].times.length;
    const values = result.measured.subarray(from, from + channel.times.length);
    return [channel.times, values.map(v => channel.factor * v)];
  }

  // Simulated minus measured, in the shown unit; null where there is no simulated value.
  residuals(result, trial, channel) {
    let from = 0;
    for (let i = 0; i < channel.measured; ++i) from += trial.channels[i].times.length;
    return channel.values.map((value, k) => {
      const simulated = result.measured[from + k];
      return Number.isNaN(simulated) ? null : channel.factor * (simulated - value);
    });
  }

  /// Indices of at most mostPoints values that are there.
  thinned(values) {
    const there = [];
    values.forEach((value, i) => { if (value !== null && value !== undefined) there.push(i); });
    const every = Math.ceil(there.length / mostPoints);
    return there.filter((_, i) => i % every === 0);
  }

  static rms(values) {
    const there = values.filter(v => v !== null);
    return Math.sqrt(there.reduce((sum, v) => sum + v * v, 0) / there.length);
  }

  /// @param anew  whether the plots are made afresh, for another channel or width
  show(state, anew = false) {
    const trial = this.data.trials[state.trial], result = state.result;
    const channel = this.channels(trial)[this.channel];
    const key = `${state.trial} ${this.channel} ${this.inputs} ${result.names.muscles.length}`;
    if (anew || key !== this.key) this.make(channel, result);
    this.key = key;
    const [times, values] = this.simulated(result, trial, channel);
    const [before, reference] = this.simulated(state.reference, trial, channel);
    const tables = [[Array.from(times), Array.from(values)], [Array.from(before), Array.from(reference)]];
    if (channel.measured >= 0) tables.push([channel.times, channel.values.map(v => channel.factor * v)]);
    this.drawn = { channel, tables };
    this.motion.setData(uPlot.join(tables));
    this.showFit(state, trial, result, channel);
    // what drives the muscles seldom changes, and drawing it takes as long as a simulation
    const same = this.driven && this.driven.length === result[this.inputs].length &&
      this.driven.every((value, i) => value === result[this.inputs][i]);
    if (this.drive && !same) {
      const count = result.names.muscles.length;
      this.driven = result[this.inputs];
      this.drive.setData([Array.from(result.times), ...this.muscles.map(
        i => Array.from(result.times, (_, k) => result[this.inputs][k * count + i]))]);
    }
  }

  showFit(state, trial, result, channel) {
    const fit = document.getElementById("fit");
    const draft = result.asked.isDraft && `Draft while a slider moves, steps of ${result.asked.step} s`;
    const speed = `${draft || "One simulation"}: ${result.milliseconds.toFixed(result.milliseconds < 10 ? 1 : 0)} ms`;
    if (channel.measured < 0) {
      fit.textContent = `${channel.name} was not measured. ${speed}.`;
      return;
    }
    const left = this.residuals(result, trial, channel);
    const before = Curves.rms(this.residuals(state.reference, trial, channel));
    fit.textContent = `RMS error ${Curves.rms(left).toPrecision(3)} ${channel.unit} (as given: ${before.toPrecision(3)} ${channel.unit}). ${speed}.`;
    this.residual.setData([channel.times, left]);
  }

  // Plots ---------------------------------------------------------------------------------------

  plot(id, height, yLabel, series) {
    const place = document.getElementById(id);
    const style = getComputedStyle(document.documentElement);
    const text = style.getPropertyValue("--soft"), line = style.getPropertyValue("--line");
    const axis = (label, side) => ({ label, stroke: text, grid: { stroke: line, width: 0.5 }, ticks: { stroke: line, width: 0.5 },
      labelSize: 20, size: side === "y" ? 58 : 32, font: "12px sans-serif", labelFont: "12px sans-serif" });
    place.replaceChildren();
    const chart = new uPlot({
      width: place.clientWidth, height, series: [{ label: "time [s]" }, ...series],
      scales: { x: { time: false } }, axes: [axis("Time [s]", "x"), axis(yLabel, "y")],
      legend: { live: false, markers: { width: 2, stroke: (u, i) => i ? series[i - 1].stroke : null,
        fill: (u, i) => i && series[i - 1].points ? series[i - 1].stroke : null } }, cursor: { y: false },
      hooks: { draw: [u => this.drawTime(u)] },
    }, [[0], ...series.map(() => [null])], place);
    return chart;
  }

  drawTime(u) {
    const x = u.valToPos(this.time, "x", true);
    if (x < u.bbox.left || x > u.bbox.left + u.bbox.width) return;
    u.ctx.save();
    u.ctx.strokeStyle = getComputedStyle(document.documentElement).getPropertyValue("--soft");
    u.ctx.beginPath();
    u.ctx.moveTo(x, u.bbox.top);
    u.ctx.lineTo(x, u.bbox.top + u.bbox.height);
    u.ctx.stroke();
    u.ctx.restore();
  }

  setTime(time) {
    this.time = time;
    [this.motion, this.residual, this.drive].forEach(plot => plot && plot.redraw(false, false));
  }

  make(channel, result) {
    const colour = this.colours();
    const unit = `[${channel.unit}]`;
    const series = [{ label: "simulated", stroke: colour[0], width: 2.5 },
                    { label: "as given", stroke: colour[1], width: 1.5, dash: [6, 4] }];
    if (channel.measured >= 0) {
      // filled, not outlined, and no more than fit side by side: outlines take most of the time
      const text = getComputedStyle(document.documentElement).getPropertyValue("--text");
      const points = { show: true, size: 4, width: 0, stroke: text, fill: text, space: 0, filter: (u, i, show) => show ? this.thinned(u.data[i]) : null };
      series.push({ label: "measured", stroke: text, width: 0, points });
    }
    this.motion = this.plot("motion", 260, `${channel.name} ${unit}`, series);
    document.getElementById("residual").hidden = channel.measured < 0;
    this.residual = this.plot("residual", 150, `sim. − meas. ${unit}`,
                              [{ label: "simulated − measured", stroke: colour[0], width: 1.2 }]);
    // the muscles with the largest peaks
    const count = result.names.muscles.length;
    const peaks = result.names.muscles.map((_, i) => {
      let peak = 0;
      for (let k = i; k < result[this.inputs].length; k += count) peak = Math.max(peak, result[this.inputs][k]);
      return peak;
    });
    this.muscles = [...peaks.keys()].sort((a, b) => peaks[b] - peaks[a]).slice(0, mostMuscles).sort((a, b) => a - b);
    document.getElementById("drive").hidden = document.getElementById("inputs").parentNode.hidden = count === 0;
    const what = this.inputs === "excitations" ? "Excitation" : "Activation";
    this.driven = null;
    this.drive = count === 0 ? null : this.plot("drive", 190, `${what} [1]`, this.muscles.map((i, k) => ({
      label: result.names.muscles[i], stroke: colour[k % colour.length], width: 1.5, dash: k < colour.length ? [] : [5, 3] })));
  }

  // Files ---------------------------------------------------------------------------------------

  svg() {
    const { channel, tables } = this.drawn;
    const width = 720, height = 400, left = 70, bottom = 50, top = 20, right = 20;
    const xs = tables[0][0], ys = tables.flatMap(t => t[1]).filter(v => v !== null && !Number.isNaN(v));
    const [x0, x1, y0, y1] = [xs[0], xs.at(-1), Math.min(...ys), Math.max(...ys)];
    const X = x => (left + (x - x0) / (x1 - x0) * (width - left - right)).toFixed(2);
    const Y = y => (height - bottom - (y - y0) / (y1 - y0 || 1) * (height - bottom - top)).toFixed(2);
    const escaped = text => text.replace(/[&<>"]/g, c => `&#${c.charCodeAt(0)};`);
    const line = ([x, y], style) => `<polyline fill="none" ${style} points="${x.map((t, k) => Number.isNaN(y[k]) ? "" : `${X(t)},${Y(y[k])}`).join(" ")}"/>`;
    const ticks = (low, high) => {
      const raw = (high - low) / 5, unit = 10 ** Math.floor(Math.log10(raw || 1));
      const step = [1, 2, 5, 10].map(f => f * unit).find(s => s >= raw) || 1;
      const list = [];
      for (let t = Math.ceil(low / step) * step; t <= high + 1e-9 * step; t += step) list.push(Number(t.toPrecision(6)));
      return list;
    };
    const parts = [`<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" font-family="sans-serif" font-size="13">`,
      `<rect width="${width}" height="${height}" fill="white"/>`];
    for (const t of ticks(x0, x1)) parts.push(`<line x1="${X(t)}" x2="${X(t)}" y1="${top}" y2="${height - bottom}" stroke="#ddd"/><text x="${X(t)}" y="${height - bottom + 18}" text-anchor="middle">${t}</text>`);
    for (const t of ticks(y0, y1)) parts.push(`<line x1="${left}" x2="${width - right}" y1="${Y(t)}" y2="${Y(t)}" stroke="#ddd"/><text x="${left - 8}" y="${Y(t)}" dy="4" text-anchor="end">${t}</text>`);
    parts.push(line(tables[1], 'stroke="#d55e00" stroke-width="1.5" stroke-dasharray="6 4"'), line(tables[0], 'stroke="#0072b2" stroke-width="2.5"'));
    if (tables[2]) tables[2][0].forEach((t, k) => parts.push(`<circle cx="${X(t)}" cy="${Y(tables[2][1][k])}" r="1.8"/>`));
    parts.push(`<text x="${(left + width - right) / 2}" y="${height - 10}" text-anchor="middle">Time [s]</text>`,
      `<text transform="translate(16 ${(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">${escaped(`${channel.name} [${channel.unit}]`)}</text>`,
      `<text x="${width - right}" y="14" text-anchor="end">line: simulated, dashes: as given${tables[2] ? ", dots: measured" : ""}</text></svg>`);
    return parts.join("\n");
  }

  /// Coordinates in radians or metres, excitations and activations, at the rows of the simulation.
  csv(state) {
    const { names, times, coordinates, excitations, activations } = state.result;
    const quoted = name => /[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name;
    const head = ["time", ...names.coordinates, ...names.muscles.map(m => `${m}.excitation`), ...names.muscles.map(m => `${m}.activation`)];
    const rows = [head.map(quoted).join(",")];
    const n = names.coordinates.length, m = names.muscles.length;
    times.forEach((t, k) => rows.push([t, ...coordinates.subarray(k * n, k * n + n), ...excitations.subarray(k * m, k * m + m),
      ...activations.subarray(k * m, k * m + m)].join(",")));
    return rows.join("\n") + "\n";
  }
}
