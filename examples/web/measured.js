// Error and time of the chosen variant, as they were recorded: never one without the other, nor without driver,
// domain and method.

import { make } from "./controls.js";
import { brief } from "./numbers.js";

/** What is recorded of a shading function for a backend: a headline as nodes, and terms with their texts. */
export function recordedFigures(plan, shading, backend) {
  const found = shading.recorded[backend];
  const record = plan.records[backend];
  if (!found || !record) {
    return { headline: [`Nothing is recorded of ${shading.name} for this backend.`], facts: [] };
  }
  return { headline: headline(shading, found, record), facts: facts(shading, found, record) };
}

function headline(shading, found, record) {
  const strong = (text) => make("strong", { textContent: text });
  const time =
    shading.name === found.base
      ? [strong(`${brief(found.net_ns)} ns`), ` an evaluation on ${record.short}`]
      : [strong(`${brief(found.ratio)} ×`), ` the time of ${found.base} on ${record.short}`];
  const against = shading.misprint ? "the right formulas" : "float64";
  return [...time, ", error at most ", strong(brief(errorShown(shading, found))), ` against ${against}`];
}

/** A printed formula is judged by the right one: how well a driver computes it says nothing about it. */
function errorShown(shading, found) {
  return shading.misprint ? shading.misprint.every_light.largest : found.error.max;
}

function facts(shading, found, record) {
  const steps = `${brief(found.error.steps)} of a step of an 8-bit picture`;
  const inputs = `${found.error.inputs} inputs, uniform and hard ones`;
  const { max, measure, domain } = found.error;
  const rows = [];
  if (shading.misprint) {
    const { every_light: light, setting, places } = shading.misprint;
    const sizes = `up to ${brief(light.largest)} of the light, ${brief(light.mean)} on average`;
    rows.push(
      ["Error", `${sizes}, against ${found.base} in float64; ${places}. Example: ${setting}`],
      ["As printed", `the driver is within ${brief(max)} of the printed formula: ${steps}; ${inputs}`],
    );
  } else {
    rows.push(["Error", `at most ${brief(max)} ${measure}, ${steps}, against float64; ${inputs}`]);
  }
  const how = `${record.clock}, ${record.driver_threads} thread, ${record.chains} chains; ${record.order}`;
  rows.push(
    ["Domain", domain],
    ["Time", timeText(shading, found)],
    ["Driver", `${record.driver}, ${record.device}; ${record.cpu}; ${record.date}`],
    ["Method", `${how}; net: ${record.net}. A ratio holds for its driver only`],
  );
  if (!found.current) {
    rows.push(["Note", "measured before the function's text last changed"]);
  }
  return rows;
}

function timeText(shading, found) {
  const net = `${brief(found.net_ns, 3)} ns net per evaluation`;
  if (shading.name === found.base) {
    return net;
  }
  const [low, high] = found.ratio_quartiles.map((x) => brief(x));
  return `${brief(found.ratio)} × ${found.base}, quartiles ${low} to ${high}; ${net}`;
}
