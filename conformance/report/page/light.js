/* Draws the estimators of light: error against samples and against time. Needs what report.js defines. */
const light = JSON.parse(document.getElementById("light-data").textContent);
const lightForm = document.getElementById("light-controls");
const DASH = { combined: "dash", bias: "dot" };
const LIGHT_SYMBOLS = { grid: "square", monte_carlo: "circle", filtered: "diamond", guarded: "triangle-up", combined: "cross", prefiltered: "star", bias: "circle-open" };

/* Nanoseconds of any number of samples: on a line between two measured ones. */
function timeAt(samples, ns, n) {
  if (samples.length === 1) return ns[0];
  const k = Math.min(Math.max(samples.findIndex((s) => s >= n), 1), samples.length - 1);
  return ns[k - 1] + ((ns[k] - ns[k - 1]) * (n - samples[k - 1])) / (samples[k] - samples[k - 1]);
}

function curvesOf(computed, map, lobe) {
  const own = light.errors[computed].filter((c) => c[0] === map && c[1] === lobe);
  const model = light.errors.at(-1).filter((c) => c[0] === map && c[1] === lobe && !own.some((o) => o[2] === c[2]));
  return [...own, ...model].sort((a, b) => Object.keys(light.estimators).indexOf(a[2]) - Object.keys(light.estimators).indexOf(b[2]));
}

function trace(name, xs, ys, words) {
  return {
    x: xs, y: ys, mode: "lines+markers", name: light.estimators[name], cliponaxis: false,
    hovertemplate: xs.map((x, k) => `<b>${light.estimators[name]}</b><br>${words[k]}<br>error ${number(ys[k])}<extra></extra>`),
    line: { color: colour(name), width: name === "bias" ? 1.5 : 2, dash: DASH[name] ?? "solid" },
    marker: { color: colour(name), size: name === "prefiltered" ? 13 : 7, symbol: LIGHT_SYMBOLS[name] },
  };
}

function drawPlot(id, traces, title, empty) {
  const plot = document.getElementById(id);
  if (!traces.length) {
    Plotly.purge(plot);
    plot.replaceChildren(Object.assign(document.createElement("p"), { className: "small", textContent: empty }));
    return;
  }
  if (!plot.querySelector(".plot-container")) plot.replaceChildren();
  const xs = traces.flatMap((t) => t.x), ys = traces.flatMap((t) => t.y);
  const x = logRange(xs, 0.06), y = logRange(ys, 0.06);
  const plan = layout(
    axes(title, { type: "log", range: x, ...(id === "light-samples" ? { tickmode: "array", tickvals: [1, 8, 32, 128, 512, 2048], ticktext: ["1", "8", "32", "128", "512", "2048"] } : ticks(x)) }),
    axes("relative RMS error", { type: "log", range: y, ...ticks(y) }),
  );
  Plotly.react(plot, traces, plan, { displayModeBar: false, responsive: true });
}

function drawLight() {
  const { map, lobe, computed } = Object.fromEntries(new FormData(lightForm));
  const curves = curvesOf(Number(computed), map, lobe).map(([, , name, samples, rms]) => {
    const kept = samples.map((n, k) => [n, rms[k]]).filter(([, e]) => e !== null && e > 0);
    return { name, samples: kept.map(([n]) => n), rms: kept.map(([, e]) => e) };
  });
  const times = new Map(light.times[computed].filter((t) => t[0] === lobe).map((t) => [t[1], t]));
  drawPlot("light-samples", curves.map((c) => trace(c.name, c.samples, c.rms, c.samples.map((n) => `${n} samples`))), "samples", "");
  const timed = curves.filter((c) => times.has(c.name)).map((c) => {
    const [, , samples, ns] = times.get(c.name);
    const us = c.samples.map((n) => timeAt(samples, ns, n) / 1000);
    return trace(c.name, us, c.rms, c.samples.map((n, k) => `${n} samples, ${number(us[k])} µs`));
  });
  drawPlot("light-time", timed, "µs per shaded point", "Nothing is timed here: choose a driver.");
  const there = new Set(curves.map((c) => c.name));
  for (const key of document.querySelectorAll("#light-legend span")) key.hidden = !there.has(key.dataset.estimator);
  const shownBy = Math.min(Number(computed), light.drivers.length - 2);
  for (const row of document.querySelectorAll("#light-table tbody tr")) {
    row.hidden = row.dataset.map !== map || Number(row.dataset.computed) !== shownBy;
  }
}

lightForm.addEventListener("submit", (event) => event.preventDefault());
lightForm.addEventListener("input", drawLight);
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawLight);
drawLight();
