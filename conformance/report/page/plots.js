/* What every plot of the page shares: colours, numbers, axes, layout. */
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
const number = (v) => {
  if (v === null || v === undefined) return "–";
  if (v === 0) return "0";
  const size = Math.abs(v);
  return size >= 1e-3 && size < 1e5 ? Number(v.toPrecision(3)).toLocaleString("en") : v.toExponential(1);
};

function axes(title, extra) {
  const common = {
    gridcolor: colour("line"), linecolor: colour("line"), zeroline: false, fixedrange: true,
    tickfont: { color: colour("soft"), size: 11 }, automargin: true,
  };
  return { ...common, title: { text: title, font: { color: colour("soft"), size: 12 }, standoff: 6 }, ...extra };
}

function logRange(values, pad) {
  const logs = values.map(Math.log10);
  const low = Math.min(...logs), high = Math.max(...logs), room = Math.max((high - low) * pad, 0.12);
  return [low - room, high + room];
}

/* 1, 2 and 5 of every decade, or the decades alone where there are many. */
function ticks([low, high]) {
  const all = [], steps = high - low > 2.6 ? [1] : high - low > 1.4 ? [1, 3] : [1, 2, 3, 5, 7];
  for (let decade = Math.floor(low); decade <= high; decade++) {
    for (const step of steps) all.push(step * 10 ** decade);
  }
  const vals = all.filter((v) => Math.log10(v) >= low && Math.log10(v) <= high);
  return { tickmode: "array", tickvals: vals, ticktext: vals.map((v) => Number(v.toPrecision(2)).toLocaleString("en", { maximumSignificantDigits: 2 })) };
}

const decades = ([low, high]) => Math.max(1, Math.ceil((high - low) / 6));

function layout(x, y) {
  return {
    font: { family: getComputedStyle(document.body).fontFamily, color: colour("ink"), size: 12 },
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", showlegend: false, dragmode: false,
    margin: { l: 56, r: 14, t: 10, b: 44 }, hovermode: "closest", xaxis: x, yaxis: y, shapes: [], annotations: [],
    hoverlabel: { align: "left", bgcolor: colour("raised"), bordercolor: colour("line"), font: { color: colour("ink"), size: 12 } },
  };
}
