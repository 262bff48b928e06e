/* Draws the plots, filters table and cards. The state stands in the address, so that a view can be linked. */
const { drivers, modes, groups } = JSON.parse(document.getElementById("data").textContent);
const form = document.getElementById("controls");
const state = { driver: "0", mode: modes[0], unit: "steps", filter: "" };
const UNITS = { steps: "error in 8-bit steps", ulp: "error in ULP" };
const LOWEST = { steps: 1e-6, ulp: 1e-2 };   // where errors of zero are drawn
const HALF_STEP = 0.5;
const SYMBOLS = { base: "circle", variant: "circle", printed: "x-thin-open", peer: "diamond" };
const tagOf = (e) => (e.not_finite ? `${e.tag}, not always finite` : e.tag);
const wrapped = (words) => words.replaceAll(";", "<br>  ");

function here(group) {
  return group.entries.filter((e) => e.driver === Number(state.driver) && e.speed[state.mode]);
}

function height(e) {
  const error = e.errors?.[state.unit];
  return !error || error.max === null ? null : Math.max(error.max, LOWEST[state.unit]);
}

/* ---------------------------------------------------------------- plots */

/* Beside or under its mark, where it covers no other mark, bar or label. */
function labelPlaces(plot, x, y, xs, ys, tops, tags) {
  const width = Math.max(plot.clientWidth - 70, 100), tall = Math.max(plot.clientHeight - 54, 100);
  const px = (v) => ((Math.log10(v) - x[0]) / (x[1] - x[0])) * width, py = (v) => ((Math.log10(v) - y[0]) / (y[1] - y[0])) * tall;
  const taken = xs.map((v, k) => [px(v) - 6, py(ys[k]) - 6, px(v) + 6, Math.max(py(tops[k]), py(ys[k]) + 6)]);
  return xs.map((v, k) => {
    const w = 6.4 * tags[k].length + 8, cx = px(v), cy = py(ys[k]);
    const places = {
      "bottom center": [cx - w / 2, cy - 22, cx + w / 2, cy - 7], "middle right": [cx + 7, cy - 7, cx + 7 + w, cy + 8],
      "middle left": [cx - 7 - w, cy - 7, cx - 7, cy + 8], "top center": [cx - w / 2, cy + 7, cx + w / 2, cy + 22],
    };
    const cost = (box) => taken.filter((t, n) => n !== k && t[0] < box[2] && box[0] < t[2] && t[1] < box[3] && box[1] < t[3]).length
      + 2 * (box[0] < 0 || box[2] > width) + 2 * (box[1] < 0 || box[3] > tall);
    const best = Object.keys(places).reduce((a, b) => (cost(places[b]) < cost(places[a]) ? b : a));
    taken.push(places[best]);
    return best;
  });
}

function halfStep(plan) {
  if (state.unit !== "steps") return;
  const y = Math.log10(HALF_STEP), [low, high] = plan.yaxis.range;
  if (y < low || y > high) return;
  plan.shapes.push({ type: "line", xref: "paper", x0: 0, x1: 1, y0: HALF_STEP, y1: HALF_STEP, line: { color: colour("soft"), width: 1, dash: "dot" } });
  plan.annotations.push({
    xref: "paper", x: 1, xanchor: "right", y, yanchor: "bottom", text: "half a step", showarrow: false,
    font: { size: 11, color: colour("soft") },
  });
}

function hover(e) {
  const s = e.speed[state.mode], error = e.errors?.[state.unit];
  const lines = [`<b>${e.name}</b>`, `${number(s.net)} ns [${s.quartiles.map(number).join(", ")}]`];
  if (s.ratio !== null) lines.push(`${number(s.ratio)} × default [${number(s.low)}, ${number(s.high)}]`);
  if (error) {
    lines.push(`${number(error.max)} ${state.unit === "ulp" ? "ULP" : "steps"} at most, 99.9 %: ${number(error.p999)}`);
    if (e.not_finite) lines.push(`${e.not_finite} of ${e.inputs} results are not finite`);
    if (error.guaranteed !== null) lines.push(`permitted: ${permitted(error)}`);
    lines.push(`worst input:<br>  ${wrapped(error.words)}`);
  }
  lines.push(e.replay || e.again);
  return lines.join("<br>") + "<extra></extra>";
}

function permitted(error) {
  const share = error.guaranteed < 1 ? `, on ${number(100 * error.guaranteed)} % of the inputs; anything on the rest` : "";
  return `${error.permitted === null ? "anything" : number(error.permitted)}${share}`;
}

function drawCard(card) {
  const group = groups[Number(card.dataset.index)];
  const entries = here(group).filter((e) => height(e) !== null);
  const plot = card.querySelector(".plot");
  list(card, group);
  if (!entries.length) {
    Plotly.purge(plot);
    plot.replaceChildren(Object.assign(document.createElement("p"), { className: "small", textContent: "Not measured on this driver." }));
    return;
  }
  const xs = entries.map((e) => e.speed[state.mode].ns), ys = entries.map(height);
  const tops = entries.map((e, k) => Math.max(e.errors[state.unit].permitted ?? ys[k], ys[k]));
  const x = logRange(xs, 0.16), y = logRange([...ys, ...tops], 0.14);
  if (x[1] - x[0] < 0.6) { const mid = (x[0] + x[1]) / 2; x[0] = mid - 0.3; x[1] = mid + 0.3; }
  const plan = layout(
    axes(`ns per evaluation, ${state.mode}`, { type: "log", range: x, ...ticks(x) }),
    axes(UNITS[state.unit], { type: "log", range: y, dtick: decades(y), exponentformat: "power" }),
  );
  halfStep(plan);
  const front = entries.filter((e) => e.front.includes(`${state.mode} ${state.unit}`))
    .sort((a, b) => a.speed[state.mode].ns - b.speed[state.mode].ns);
  const traces = [
    {
      x: front.map((e) => e.speed[state.mode].ns), y: front.map(height), mode: "lines", hoverinfo: "skip",
      line: { color: colour("front"), width: 2, shape: "hv" },
    },
    {
      x: xs, y: ys, mode: "markers", hoverinfo: "skip", marker: { opacity: 0 },
      error_y: {
        type: "data", symmetric: false, array: tops.map((t, k) => t - ys[k]), arrayminus: ys.map(() => 0),
        color: colour("permitted"), thickness: 4, width: 0,
      },
    },
  ];
  traces.push({
    x: xs, y: ys, mode: "markers+text", text: entries.map(tagOf), cliponaxis: false,
    textposition: labelPlaces(plot, x, y, xs, ys, tops, entries.map(tagOf)),
    textfont: { size: 11, color: entries.map((e) => colour(e.kind === "base" ? "ink" : e.kind)) },
    hovertemplate: entries.map(hover),
    marker: {
      size: 11, symbol: entries.map((e) => SYMBOLS[e.kind]), color: entries.map((e) => colour(e.kind)),
      line: { width: entries.map((e) => (e.kind === "printed" ? 2 : 0)), color: entries.map((e) => colour(e.kind)) },
    },
  });
  for (const trace of traces) if (trace.text) trace.text = trace.text.map((t) => ` ${t} `);
  Plotly.react(plot, traces, plan, { displayModeBar: false, responsive: true });
}

function drawOverview() {
  const points = [];
  for (const group of groups) {
    for (const e of here(group)) {
      if (e.kind !== "base" && height(e) !== null && e.speed[state.mode].ratio > 0 && shown(e.name)) points.push(e);
    }
  }
  const plot = document.getElementById("overview-plot");
  const xs = points.map((e) => e.speed[state.mode].ratio), ys = points.map(height);
  const across = logRange([...xs, 1], 0.05), up = logRange(ys.length ? ys : [1], 0.06);
  const plan = layout(
    axes(`time relative to the default form, ${state.mode}`, { type: "log", range: across, ...ticks(across) }),
    axes(UNITS[state.unit], { type: "log", range: up, dtick: decades(up), exponentformat: "power" }),
  );
  halfStep(plan);
  plan.shapes.push({ type: "line", yref: "paper", y0: 0, y1: 1, x0: 1, x1: 1, line: { color: colour("soft"), width: 1 } });
  const trace = {
    x: xs, y: ys, mode: "markers", hovertemplate: points.map(hover),
    marker: {
      size: 9, opacity: 0.85, symbol: points.map((e) => SYMBOLS[e.kind]), color: points.map((e) => colour(e.kind)),
      line: { width: points.map((e) => (e.kind === "printed" ? 2 : 0)), color: points.map((e) => colour(e.kind)) },
    },
  };
  Plotly.react(plot, [trace], plan, { displayModeBar: false, responsive: true });
}

/* ---------------------------------------------------------------- the same in words, for keyboards and readers */

function list(card, group) {
  const holder = card.querySelector(".list");
  holder.replaceChildren(...here(group).map((e) => {
    const one = document.createElement("dl");
    const add = (tag, text, code) => {
      const node = document.createElement(tag);
      if (code) node.append(Object.assign(document.createElement("code"), { textContent: text }));
      else node.textContent = text;
      one.append(node);
    };
    const s = e.speed[state.mode], error = e.errors?.[state.unit];
    add("dt", e.name);
    add("dd", `${number(s.net)} ns, quartiles ${s.quartiles.map(number).join(" and ")}` +
      (s.ratio === null || e.kind === "base" ? "" : `; ${number(s.ratio)} times the default, quartiles ${number(s.low)} and ${number(s.high)}`));
    if (s.visits.length > 1 && e.kind !== "base")
      add("dd", `by visit, each in a process of its own: ${s.visits.map(number).join(", ")} times the default`);
    if (error) {
      const unit = state.unit === "ulp" ? "ULP" : "8-bit steps";
      add("dd", `at most ${number(error.max)} ${unit} on ${e.inputs.toLocaleString("en")} inputs (${e.domain})`);
      if (error.guaranteed !== null) add("dd", `the specification (${e.table}) permits ${permitted(error)}`);
      add("dd", `worst input, words in hex${e.replay ? ", and what replays it in the folder of this report" : ""}:`);
      add("dd", error.words, true);
      if (e.replay) add("dd", e.replay, true);
    }
    if (e.not_finite) add("dd", `${e.not_finite} of ${e.inputs.toLocaleString("en")} results are not finite`);
    add("dd", `operations as written: ${e.operations}`);
    add("dd", "measure again:");
    add("dd", e.again, true);
    add("dd", `${e.lanes > 1 ? `${e.lanes} work items at once` : e.lanes === 1 ? "one work item at a time" : "work items at once: not known"}, ${e.vectorised}`);
    return one;
  }));
  const open = group.open[`${state.driver} ${state.mode}`] ?? [];
  if (open.length) {
    const text = `Not decided which is faster, or another in each visit: ${open.map((pair) => pair.join(" or ")).join("; ")}.`;
    holder.prepend(Object.assign(document.createElement("p"), { textContent: text }));
  }
}

/* ---------------------------------------------------------------- state */

const shown = (name) => state.filter.toLowerCase().split(/\s+/).every((word) => name.toLowerCase().includes(word));
const cards = [...document.querySelectorAll(".card")];
const visible = new Set();
let table = null;

function showCards() {
  let count = 0;
  for (const card of cards) {
    card.hidden = !card.dataset.names.trim().split(" ").some(shown);
    count += !card.hidden;
  }
  document.getElementById("nothing").hidden = count > 0;
}

function refresh() {
  const parameters = new URLSearchParams(Object.entries(state).filter(([, v]) => v !== ""));
  if (location.hash.includes("=") || !location.hash) history.replaceState(null, "", `#${parameters}`);
  showCards();
  drawOverview();
  for (const card of cards) card.dataset.drawn = "";
  for (const card of visible) draw(card);
  table?.draw();
}

function draw(card) {
  if (card.hidden || card.dataset.drawn) return;
  card.dataset.drawn = "yes";
  drawCard(card);
}

const watcher = new IntersectionObserver((seen) => {
  for (const { target, isIntersecting } of seen) {
    if (isIntersecting) { visible.add(target); draw(target); } else visible.delete(target);
  }
}, { rootMargin: "400px" });

async function startTable() {
  const text = atob(document.getElementById("tables").textContent);
  const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
  const url = URL.createObjectURL(new Blob([bytes], { type: "text/javascript" }));
  const { default: DataTable } = await import(url);
  URL.revokeObjectURL(url);
  DataTable.ext.search.push((settings, cells, index) => {
    const row = settings.aoData[index].nTr;
    return row.dataset.driver === state.driver && shown(row.cells[0].textContent);
  });
  table = new DataTable("#table", {
    order: [], pageLength: 15, lengthMenu: [15, 50, { label: "all", value: -1 }],
    layout: { topStart: null, topEnd: null, bottomStart: "info", bottom2Start: "pageLength", bottomEnd: "paging" },
    language: { info: "_START_ to _END_ of _TOTAL_", infoEmpty: "none", infoFiltered: "", lengthMenu: "_MENU_ rows", zeroRecords: "No function has this in its name." },
  });
}

function start() {
  for (const [key, value] of new URLSearchParams(location.hash.slice(1))) {
    if (key in state && form.elements[key]) state[key] = value;
  }
  for (const key of Object.keys(state)) form.elements[key].value = state[key];
  for (const key of Object.keys(state)) state[key] = form.elements[key].value || (key === "filter" ? "" : state[key]);
  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("input", () => {
    for (const key of Object.keys(state)) state[key] = form.elements[key].value;
    refresh();
  });
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", refresh);
  refresh();
  for (const card of cards) watcher.observe(card);
}

await startTable();
start();
