// Draws the charts of a study from the object `study` that the report carries.
"use strict";
(function () {
  const { color, faint, points, axis, draw, show } = shared;
  // The same colour in all charts.
  const names = [...new Set(study.cases.flatMap((c) =>
    [...c.cdfs, ...c.series, ...c.scatters].flatMap((k) => k.lines.map((l) => l.name))))];
  const slot = (name) => "--c" + (names.indexOf(name) % 4);
  const dash = (name) => [[], [6, 4], [2, 3], [8, 3, 2, 3]][Math.floor(names.indexOf(name) / 4) % 4];

  function line(name, data, extra) {
    return Object.assign({
      label: name, data, borderColor: color(slot(name)), backgroundColor: color(slot(name)),
      borderDash: dash(name), borderWidth: 1.8, pointRadius: 0, pointHitRadius: 4, tension: 0,
      fill: false,
    }, extra);
  }

  // Two invisible lines, shaded between.
  function band(name, x, high, low, extra) {
    const side = { band: true, borderWidth: 0, borderColor: "transparent", ...extra };
    return [line(name, points(x, high), { ...side, fill: "+1",
                                          backgroundColor: faint(slot(name), 0.15) }),
            line(name, points(x, low), side)];
  }

  function drawCdf(chart) {
    const sets = [];
    for (const l of chart.lines) {
      const stepped = { stepped: "before" };
      sets.push(line(l.name, points(l.x, l.y), stepped));
      sets.push(...band(l.name, l.x, l.y.map((y) => Math.min(1, y + l.band)),
                        l.y.map((y) => Math.max(0, y - l.band)), stepped));
    }
    draw(chart.id, sets, { x: axis(chart.metric), y: axis("share of the trials", { min: 0, max: 1 }) });
  }

  function drawSeries(chart) {
    const sets = [];
    for (const l of chart.lines) {
      sets.push(line(l.name, points(l.t, l.median)));
      sets.push(...band(l.name, l.t, l.high, l.low));
    }
    draw(chart.id, sets, { x: axis("time [s]"), y: axis(chart.unit, { beginAtZero: true }) });
  }

  function drawScatter(chart) {
    const sets = chart.lines.map((l) =>
      line(l.name, points(l.x, l.y).sort((a, b) => a.x - b.x),
           { showLine: false, pointRadius: 2.4, borderWidth: 0 }));
    const xs = chart.lines.flatMap((l) => l.x);
    const low = Math.min(...xs), high = Math.max(...xs);
    const type = low > 0 && high > 20 * low ? "logarithmic" : "linear";
    draw(chart.id, sets,
         { x: axis(chart.x, { type }), y: axis(chart.y, { beginAtZero: true }) });
  }

  function drawAll() {
    for (const c of study.cases) {
      c.cdfs.forEach(drawCdf);
      c.series.forEach(drawSeries);
      c.scatters.forEach(drawScatter);
    }
  }

  show(drawAll);
})();
