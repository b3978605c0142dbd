"use strict";
// Draws every figure whose numbers stand in a script element beside its div.plot.
(() => {
  const font = '14px "Source Sans 3", "Segoe UI", "Liberation Sans", Arial, sans-serif';

  // Curves have the colours of paper; on a dark screen those that would be lost are lighter. Paper stays light.
  const dark = matchMedia("(prefers-color-scheme: dark)");
  let isPrinting = false;
  const lighter = { "#0072B2": "#56B4E9", "#56B4E9": "#B6A8F0", "#000000": "#E8E8E6", "#009E73": "#2CC79A", "#D55E00": "#FF8A3D",
    "#808080": "#A8ACB1" };
  const onScreen = colour => dark.matches && !isPrinting ? lighter[colour] || colour : colour;
  const style = name => isPrinting ? { "--ink": "#1a1a1a", "--grid": "#e2e2e2", "--tick": "#888" }[name]
    : getComputedStyle(document.documentElement).getPropertyValue(name);
  const plots = [], samples = [];
  const recolour = () => {
    plots.forEach(plot => plot.redraw(false));
    samples.forEach(({ svg, curve }) => paint(svg, curve));
  };
  dark.addEventListener("change", recolour);
  addEventListener("beforeprint", () => { isPrinting = true; recolour(); });
  addEventListener("afterprint", () => { isPrinting = false; recolour(); });

  const numberText = (value, digits) => {
    if (value == null) return "–";
    const short = Number(value.toPrecision(digits));
    const plain = short === 0 || (Math.abs(short) >= 1e-3 && Math.abs(short) < 1e6);
    return (plain ? String(short) : short.toExponential()).replace("e+", "e").replace("-", "−");
  };
  const text = value => numberText(value, 4);

  // One table of increasing x for each curve; a value a logarithmic axis cannot show becomes a gap.
  const tableOf = (curve, figure) => {
    const columns = [curve.y].concat(curve.low ? [curve.low, curve.high] : []);
    const order = curve.x.map((x, i) => i)
      .filter(i => curve.x[i] !== null && !(figure.xLog && curve.x[i] <= 0))
      .sort((a, b) => curve.x[a] - curve.x[b]);
    const shown = value => value !== null && !(figure.yLog && value <= 0) ? value : null;
    return [order.map(i => curve.x[i]), ...columns.map(column => order.map(i => shown(column[i])))];
  };

  // A curve in the order of its points, which may turn back; null lifts the pen.
  const pathOf = curve => plot => {
    const path = new Path2D();
    let down = false;
    curve.x.forEach((x, i) => {
      if (x === null || curve.y[i] === null) {
        down = false;
        return;
      }
      const at = [plot.valToPos(x, "x", true), plot.valToPos(curve.y[i], "y", true)];
      if (down) path.lineTo(...at); else path.moveTo(...at);
      down = true;
    });
    return { stroke: path, fill: null, clip: null, band: null, gaps: null, flags: 1 };
  };

  // A constant is a level line in the middle of its axis, not at the edge of one from 0 to 100.
  const range = (log, usual) => log ? undefined : (plot, low, high) => {
    if (low === null || high === null) return [0, 1];
    const size = Math.max(Math.abs(low), Math.abs(high));
    if (size < 1e-300) return [-1, 1];
    return high - low < 1e-9 * size ? [low - 0.1 * size, high + 0.1 * size] : usual(low, high);
  };

  // On a logarithmic axis of many decades lines between these would be one grey band.
  const isDecade = v => Math.abs(Math.log10(v) - Math.round(Math.log10(v))) < 1e-6;
  const decades = (plot, splits) => splits.at(-1) < 2e3 * splits[0] ? splits : splits.map(v => isDecade(v) ? v : null);
  const filtered = (log, lines) => log ? { ...lines, filter: decades } : lines;

  const axis = (label, side, log) => ({
    label, font, labelFont: "600 " + font, labelSize: 26, labelGap: 2,
    // On the left the axis is as wide as its longest number.
    size: (plot, values) => side === "x" ? 34 :
      18 + 8 * Math.max(2, ...(values || []).map(v => v === null ? 0 : v.length)),
    stroke: () => style("--ink"), grid: filtered(log, { stroke: () => style("--grid"), width: 1 }),
    ticks: filtered(log, { stroke: () => style("--tick"), width: 1 }),
    values: (plot, values) => values.map(v => v === null ? "" : numberText(v, 8)),
  });

  const paint = (svg, curve) =>
    svg.firstChild.setAttribute(curve.style === "points" ? "fill" : "stroke", onScreen(curve.colour));

  // A piece of the curve for the legend: a row in black and white is told by its dashes.
  const sample = curve => {
    const one = (name, attributes) => {
      const element = document.createElementNS("http://www.w3.org/2000/svg", name);
      Object.entries(attributes).forEach(([key, value]) => element.setAttribute(key, value));
      return element;
    };
    const svg = one("svg", { width: 34, height: 10, style: "display:block", "aria-hidden": "true" });
    svg.append(curve.style === "points" ? one("circle", { cx: 17, cy: 5, r: 4 })
      : one("path", { d: "M0 5H34", "stroke-width": curve.style === "path" ? 1.5 : 2.5,
        "stroke-dasharray": curve.dashes.join(" ") || "none" }));
    paint(svg, curve);
    samples.push({ svg, curve });
    return svg;
  };

  const draw = (place, figure) => {
    // points first, so that the lines, which are thinner, lie above them
    const curves = figure.series.filter(curve => curve.style === "points")
      .concat(figure.series.filter(curve => curve.style !== "points"));
    const tables = curves.map(curve => tableOf(curve, figure));
    const data = tables.length ? uPlot.join(tables) : [[]];
    const series = [{ label: figure.xLabel, value: (plot, v) => text(v) }];
    const bands = [], curveOf = new Map();
    curves.forEach(curve => {
      const colour = () => onScreen(curve.colour);
      const points = curve.style === "points";
      const size = curve.x.length > 600 ? 4 : curve.x.length > 60 ? 5 : 7;
      curveOf.set(series.length, curve);
      series.push({
        label: curve.name, stroke: colour, width: points ? 0 : curve.style === "path" ? 1 : 2,
        dash: curve.dashes,
        points: points ? { show: true, size, stroke: colour, fill: colour }
          : { show: figure.xLog && curve.style !== "path" },
        paths: points ? () => null : curve.style === "path" ? pathOf(curve) : undefined,
        value: (plot, v) => text(v),
      });
      if (curve.low) {
        const upper = series.length + 1;
        const edge = { stroke: "transparent", width: 0, points: { show: false }, class: "band" };
        series.push({ ...edge, label: "low" }, { ...edge, label: "high" });
        bands.push({ series: [upper, upper - 1], fill: () => colour() + "33" });
      }
    });
    const plot = new uPlot({
      width: place.clientWidth, height: 340, series, bands,
      scales: {
        x: { time: false, distr: figure.xLog ? 3 : 1, range: range(figure.xLog, (low, high) => [low, high]) },
        y: { distr: figure.yLog ? 3 : 1, range: range(figure.yLog, (low, high) => uPlot.rangeNum(low, high, 0.1, true)) },
      },
      axes: [axis(figure.xLabel, "x", figure.xLog), axis(figure.yLabel, "y", figure.yLog)],
      cursor: { points: { size: 7 }, drag: { x: true, y: true, uni: 30 } },
      legend: { live: true },
    }, data, place);
    plots.push(plot);

    // The edges of a band need no line of their own in the legend.
    const rows = place.querySelectorAll(".u-legend .u-series");
    series.forEach((one, i) => {
      if (one.class === "band") rows[i].style.display = "none";
      const marker = rows[i].querySelector(".u-marker");
      if (marker && curveOf.has(i)) {
        marker.style.cssText = "width:34px;height:10px;border:0;background:none";
        marker.append(sample(curveOf.get(i)));
      }
    });
    window.addEventListener("resize", () => plot.setSize({ width: place.clientWidth, height: 340 }));
  };

  document.querySelectorAll("figure:not(.picture):not(.playback)").forEach(figure => {
    draw(figure.querySelector(".plot"), JSON.parse(figure.querySelector("script").textContent));
  });
})();
