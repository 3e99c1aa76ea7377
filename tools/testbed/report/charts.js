// What the charts of every report share: colours, axes, drawing, and drawing again.
"use strict";
const shared = (function () {
  const charts = [];
  const color = (name) =>
    getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const faint = (name, alpha) =>
    color(name) + Math.round(255 * alpha).toString(16).padStart(2, "0");
  const points = (x, y) => x.map((t, i) => ({ x: t, y: y[i] }));

  function axis(title, limits) {
    return Object.assign({
      type: "linear",
      title: { display: true, text: title, color: color("--soft") },
      ticks: { color: color("--soft"), maxRotation: 0, includeBounds: false },
      grid: { color: color("--grid") },
    }, limits);
  }

  // Lines marked `band` stay out of the legend.
  function draw(id, datasets, scales, plugins) {
    const canvas = document.getElementById(id);
    if (!canvas) return;
    charts.push(new Chart(canvas, {
      type: "line",
      data: { datasets },
      options: {
        animation: false, parsing: false, normalized: true, maintainAspectRatio: false,
        interaction: { mode: "nearest", intersect: false },
        scales,
        plugins: {
          legend: {
            labels: {
              color: color("--ink"), boxWidth: 14, boxHeight: 3,
              filter: (item, data) => !data.datasets[item.datasetIndex].band,
            },
          },
        },
      },
      plugins: plugins || [],
    }));
  }

  // Now, and again whenever light and dark change places.
  function show(drawAll) {
    const again = () => {
      charts.splice(0).forEach((chart) => chart.destroy());
      drawAll();
    };
    again();
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
  }

  return { color, faint, points, axis, draw, show };
})();
