// Draws the charts of a run from the object `run` that the report carries.
"use strict";
(function () {
  const { color, faint, points, axis, show } = shared;
  const wholeRun = { min: 0, max: run.end_s };
  const slot = (i) => "--c" + (i % 4);

  function line(label, data, stroke, extra) {
    return Object.assign({
      label, data, borderColor: stroke, backgroundColor: stroke, borderWidth: 1.5, pointRadius: 0,
      pointHitRadius: 4, tension: 0, fill: false,
    }, extra);
  }

  function draw(id, datasets, x, y, extra) {
    const scales = Object.assign({ x: axis(x, extra && extra.x), y: axis(y, extra && extra.y) },
                                 extra && extra.right && { right: extra.right });
    shared.draw(id, datasets, scales, extra && extra.plugins);
  }

  // One metre is as long on both axes.
  const equalAxes = {
    id: "equalAxes",
    afterLayout(chart) {
      const area = chart.chartArea;
      const box = chart.extent;
      const scale =
        1.06 * Math.max((box.x1 - box.x0) / area.width, (box.y1 - box.y0) / area.height);
      const cx = (box.x0 + box.x1) / 2, cy = (box.y0 + box.y1) / 2;
      const want = {
        x: [cx - scale * area.width / 2, cx + scale * area.width / 2],
        y: [cy - scale * area.height / 2, cy + scale * area.height / 2],
      };
      let changed = false;
      for (const k of ["x", "y"]) {
        const options = chart.options.scales[k];
        if (Math.abs((options.min ?? 1e9) - want[k][0]) > 1e-3 * scale * area.width) changed = true;
        options.min = want[k][0];
        options.max = want[k][1];
      }
      if (changed) setTimeout(() => chart.update("none"), 0);
    },
    beforeInit(chart) {
      const all = chart.data.datasets.flatMap((d) => d.data).filter((p) => p.x !== null);
      const xs = all.map((p) => p.x), ys = all.map((p) => p.y);
      chart.extent = {
        x0: Math.min(...xs), x1: Math.max(...xs, Math.min(...xs) + 1),
        y0: Math.min(...ys), y1: Math.max(...ys, Math.min(...ys) + 1),
      };
    },
  };

  // Where a sensor was at fault or the world disturbed, behind the lines; darker where both.
  const disturbedBands = {
    id: "disturbedBands",
    beforeDatasetsDraw(chart) {
      const { left, right, top, bottom } = chart.chartArea;
      const shade = (stretches, fill) => {
        chart.ctx.fillStyle = fill;
        for (const s of stretches) {
          const from = Math.max(left, chart.scales.x.getPixelForValue(s.begin));
          const to = Math.min(right, chart.scales.x.getPixelForValue(s.end));
          if (to > from) chart.ctx.fillRect(from, top, to - from, bottom - top);
        }
      };
      chart.ctx.save();
      shade(run.disturbances, faint("--paper", 0.13));
      shade(run.faults, faint("--soft", 0.13));
      chart.ctx.restore();
    },
  };

  function drawTrajectory() {
    const sets = [line("truth", points(run.truth.x, run.truth.y), color("--truth"),
                       { borderDash: [6, 4], borderWidth: 1.5, order: -1 })];
    run.estimators.forEach((e, i) => {
      if (e.path) sets.push(line(e.name, points(e.path.x, e.path.y), color(slot(i))));
    });
    draw("trajectory", sets, "east [m]", "north [m]", { plugins: [equalAxes] });
  }

  function drawHeading() {
    const sets = [];
    let top = 0;
    run.estimators.forEach((e, i) => {
      const worst = Math.max(...e.heading.error.map(Math.abs));
      const sigma = e.heading.sigma.filter((s) => s !== null).sort((a, b) => a - b);
      // A band that runs away must not flatten the errors.
      const band = sigma.length ? 3 * sigma[Math.floor(0.95 * (sigma.length - 1))] : 0;
      top = Math.max(top, 1.1 * worst, Math.min(1.1 * band, 3 * worst));
      sets.push(line(e.name, points(e.heading.t, e.heading.error), color(slot(i))));
      const bound = (sign) =>
        points(e.heading.t, e.heading.sigma.map((s) => (s === null ? null : sign * 3 * s)));
      sets.push(line("", bound(1), "transparent",
                     { fill: "+1", backgroundColor: faint(slot(i), 0.16), band: true,
                       borderWidth: 0 }));
      sets.push(line("", bound(-1), "transparent", { band: true, borderWidth: 0 }));
    });
    if (top === 0) top = 1;
    draw("heading", sets, "time [s]", "heading error [\u00b0]",
         { y: { min: -top, max: top }, x: wholeRun, plugins: [disturbedBands] });
  }

  function drawPosition() {
    const sets = [];
    run.estimators.forEach((e, i) => {
      if (!e.position) return;
      sets.push(line(e.name, points(e.position.t, e.position.error), color(slot(i))));
    });
    draw("position", sets, "time [s]", "position error [m]",
         { y: { beginAtZero: true }, x: wholeRun, plugins: [disturbedBands] });
  }

  function drawReadings() {
    const sets = [line("one reading of the polarimeter", points(run.readings.t, run.readings.error),
                       color("--paper"),
                       { showLine: false, pointRadius: 1.4, borderWidth: 0 })];
    draw("readings", sets, "time [s]", "heading error [\u00b0]",
         { x: wholeRun, plugins: [disturbedBands] });
  }

  function drawMemory() {
    draw("memory", [line("resident memory", points(run.memory.t, run.memory.mb), color("--c2"))],
         "time [s]", "MB", { y: { beginAtZero: true }, x: wholeRun });
  }

  // Amplitudes span decades. The first is the mean's, which was taken away.
  function drawForce() {
    if (!run.force) return;
    const lifted = (s) => points(s.t, s.v.map((v) => Math.max(v, 1e-6))).slice(1);
    const sets = [line("up", lifted(run.force.up), color("--c0")),
                  line("ahead", lifted(run.force.ahead), color("--c1"))];
    const values = sets.flatMap((set) => set.data.map((p) => p.y));
    const top = Math.max(...values);
    const bottom = 10 ** Math.floor(Math.log10(Math.min(...values)));
    const steps = run.force.steps_hz;
    if (steps !== null) {
      sets.push(line("steps, " + steps + " Hz", points([steps, steps], [bottom, top]),
                     color("--soft"), { borderDash: [6, 4] }));
    }
    draw("force", sets, "frequency [Hz]", "amplitude [m/s\u00b2]",
         { y: { type: "logarithmic", min: bottom }, x: { min: 0 } });
  }

  const over = (label, series, stroke, extra) =>
    line(label, points(series.t, series.v), stroke, extra);

  // On a logarithmic axis; dashed: what an honest covariance exceeds one time in twenty.
  function drawNees(id, of, title, limit) {
    const lifted = (series) => ({ t: series.t, v: series.v.map((v) => Math.max(v, 1e-3)) });
    const sets = [];
    run.estimators.forEach((e, i) => {
      if (e.nees[of]) sets.push(over(e.name, lifted(e.nees[of]), color(slot(i))));
    });
    sets.push(line("95 %", points([0, run.end_s], [limit, limit]), color("--soft"),
                   { borderDash: [6, 4] }));
    draw(id, sets, "time [s]", title,
         { y: { type: "logarithmic", min: 1e-3 }, x: wholeRun, plugins: [disturbedBands] });
  }

  function drawVision() {
    const inside = run.estimators.map((e, i) => ({ e, i })).filter(({ e }) => e.inside);
    if (!inside.length) return;
    const offered =
      over("offered", inside[0].e.inside.offered, color("--soft"), { borderWidth: 1 });
    const inliers = inside.map(({ e, i }) => over(e.name, e.inside.inliers, color(slot(i))));
    draw("features", [...inliers, offered], "time [s]", "points",
         { y: { beginAtZero: true }, x: wholeRun, plugins: [disturbedBands] });
    draw("vision-nis", inside.map(({ e, i }) => over(e.name, e.inside.nis, color(slot(i)))),
         "time [s]", "chi\u00b2 / degrees of freedom",
         { y: { beginAtZero: true }, x: wholeRun, plugins: [disturbedBands] });
    inside.forEach(({ e, i }) => {
      draw("rejected-" + i,
           [over("flow", e.inside.flow, color("--c0")), over("pose", e.inside.pose, color("--c1")),
            over("map", e.inside.map, color("--c3"))],
           "time [s]", "points",
           { y: { beginAtZero: true }, x: wholeRun, plugins: [disturbedBands] });
      draw("window-" + i,
           [over("landmarks", e.inside.landmarks, color("--c1")),
            over("keyframes", e.inside.keyframes, color("--c2"), { yAxisID: "right" })],
           "time [s]", "landmarks",
           { y: { beginAtZero: true }, x: wholeRun, plugins: [disturbedBands],
             right: axis("keyframes", { position: "right", beginAtZero: true,
                                        grid: { drawOnChartArea: false } }) });
      if (e.inside.sky) drawSky("sky-" + i, e.inside.sky);
    });
  }

  function drawSky(id, sky) {
    const dots = { showLine: false, pointRadius: 1.4, borderWidth: 0 };
    const bound = (sign) => points(sky.sigma.t, sky.sigma.v.map((s) => sign * 3 * s));
    draw(id,
         [over("used", sky.used, color("--c1"), dots),
          over("gated", sky.gated, color("--fail"), { ...dots, pointRadius: 2 }),
          line("", bound(1), "transparent",
               { fill: "+1", backgroundColor: faint("--c1", 0.16), band: true, borderWidth: 0 }),
          line("", bound(-1), "transparent", { band: true, borderWidth: 0 })],
         "time [s]", "heading residual [\u00b0]", { x: wholeRun, plugins: [disturbedBands] });
  }

  function drawAll() {
    drawTrajectory();
    drawHeading();
    drawPosition();
    drawReadings();
    drawMemory();
    drawForce();
    drawNees("nees-heading", "heading", "NEES", 3.84);
    drawNees("nees-position", "position", "NEES", 7.81);
    drawVision();
  }

  show(drawAll);
})();
