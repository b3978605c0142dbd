"use strict";
// Draws every figure whose numbers stand in a script element beside its div.plot.
(() => {
  // Okabe and Ito's palette, told apart by colour-blind readers; grey stands for its yellow, which
  // is too pale on white.
  const colours = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#E69F00", "#56B4E9",
    "#808080"];
  const dashes = [[], [10, 5], [3, 4], [12, 4, 3, 4]];
  const font = '14px "Source Sans 3", "Segoe UI", "Liberation Sans", Arial, sans-serif';

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

  const axis = (label, side) => ({
    label, font, labelFont: "600 " + font, labelSize: 26, labelGap: 2,
    // On the left the axis is as wide as its longest number.
    size: (plot, values) => side === "x" ? 34 :
      18 + 8 * Math.max(2, ...(values || []).map(v => v === null ? 0 : v.length)),
    stroke: "#1a1a1a", grid: { stroke: "#e2e2e2", width: 1 }, ticks: { stroke: "#888", width: 1 },
    values: (plot, values) => values.map(v => v === null ? "" : numberText(v, 8)),
  });

  const draw = (place, figure) => {
    const tables = figure.series.map(curve => tableOf(curve, figure));
    const data = tables.length ? uPlot.join(tables) : [[]];
    const series = [{ label: figure.xLabel, value: (plot, v) => text(v) }];
    const bands = [];
    figure.series.forEach((curve, i) => {
      const colour = colours[i % colours.length];
      const points = curve.style === "points";
      const turn = Math.floor(i / colours.length) + (curve.style === "dashed" ? 1 : 0);
      series.push({
        label: curve.name, stroke: colour, width: points ? 0 : curve.style === "path" ? 1 : 2,
        dash: dashes[turn % dashes.length],
        points: points ? { show: true, size: 6, stroke: colour, fill: colour }
          : { show: figure.xLog && curve.style !== "path" },
        paths: points ? () => null : curve.style === "path" ? pathOf(curve) : undefined,
        value: (plot, v) => text(v),
      });
      if (curve.low) {
        const upper = series.length + 1;
        const edge = { stroke: "transparent", width: 0, points: { show: false }, class: "band" };
        series.push({ ...edge, label: "low" }, { ...edge, label: "high" });
        bands.push({ series: [upper, upper - 1], fill: colour + "33" });
      }
    });
    const plot = new uPlot({
      width: place.clientWidth, height: 340, series, bands,
      scales: {
        x: { time: false, distr: figure.xLog ? 3 : 1 },
        y: { distr: figure.yLog ? 3 : 1 },
      },
      axes: [axis(figure.xLabel, "x"), axis(figure.yLabel, "y")],
      cursor: { points: { size: 7 }, drag: { x: true, y: true, uni: 30 } },
      legend: { live: true },
    }, data, place);

    // The edges of a band need no line of their own in the legend; dashes and points show there.
    const rows = place.querySelectorAll(".u-legend .u-series");
    series.forEach((one, i) => {
      if (one.class === "band") rows[i].style.display = "none";
      const marker = rows[i].querySelector(".u-marker");
      if (!marker || !one.stroke || i === 0) return;
      const points = one.width === 0;
      const style = points ? "dotted" : one.dash && one.dash.length ? "dashed" : "solid";
      marker.style.cssText = points
        ? `width:8px;height:8px;border-radius:50%;border:0;background:${colours[colourIndex(i)]}`
        : `width:22px;height:0;border:0;border-top:3px ${style} ${colours[colourIndex(i)]}`;
    });
    function colourIndex(row) {
      return series.slice(1, row).filter(one => one.class !== "band").length % colours.length;
    }
    window.addEventListener("resize", () => plot.setSize({ width: place.clientWidth, height: 340 }));
  };

  document.querySelectorAll("figure:not(.picture)").forEach(figure => {
    draw(figure.querySelector(".plot"), JSON.parse(figure.querySelector("script").textContent));
  });
})();
