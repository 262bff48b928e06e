// Error and time of the chosen variant, as they were recorded: never one without the other, nor without driver,
// domain and method.

import { make } from "./controls.js";
import { brief } from "./numbers.js";

const WIDE = "(min-width: 46rem)"; // where the details do not push everything else away
let open = null; // as the reader left them

/** Fills an element with what is recorded of a shading function for a backend. */
export function showRecorded(element, plan, shading, backend) {
  const found = shading.recorded[backend];
  const record = plan.records[backend];
  element.replaceChildren();
  if (!found || !record) {
    element.append(make("p", { textContent: `Nothing is recorded of ${shading.name} for this backend.` }));
    return;
  }
  const details = make("details", { open: open ?? window.matchMedia(WIDE).matches });
  details.addEventListener("toggle", () => { open = details.open; });
  details.append(make("summary", { textContent: "Domain, driver and method" }), facts(shading, found, record));
  element.append(headline(shading, found, record), details);
}

function headline(shading, found, record) {
  const line = make("p", { className: "headline" });
  const strong = (text) => make("strong", { textContent: text });
  if (shading.name === found.base) {
    line.append(strong(`${brief(found.net_ns)} ns`), ` an evaluation on ${record.short}`);
  } else {
    line.append(strong(`${brief(found.ratio)} ×`), ` the time of ${found.base} on ${record.short}`);
  }
  const against = shading.misprint ? "the right formulas" : "float64";
  line.append(", error at most ", strong(brief(errorShown(shading, found))), ` against ${against}`);
  return line;
}

/** A printed formula is judged by the right one: how well a driver computes it says nothing about it. */
function errorShown(shading, found) {
  return shading.misprint ? shading.misprint.every_light.largest : found.error.max;
}

function facts(shading, found, record) {
  const list = make("dl");
  const add = (term, text) =>
    list.append(make("dt", { textContent: term }), make("dd", { textContent: text }));
  const steps = `${brief(found.error.steps)} of a step of an 8-bit picture`;
  const inputs = `${found.error.inputs} inputs, uniform and hard ones`;
  if (shading.misprint) {
    const { every_light: light, setting, places } = shading.misprint;
    add("Error", `up to ${brief(light.largest)} of the light, ${brief(light.mean)} on average, against ` +
      `fakefur_shade in float64; ${places}. Example: ${setting}`);
    add("As printed", `the driver is within ${brief(found.error.max)} of the printed formula: ${steps}; ${inputs}`);
  } else {
    add("Error", `at most ${brief(found.error.max)} ${found.error.measure}, ${steps}, against float64; ${inputs}`);
  }
  add("Domain", found.error.domain);
  add("Time", timeText(shading, found));
  add("Driver", `${record.driver}, ${record.device}; ${record.cpu}; ${record.date}`);
  add("Method", `${record.clock}, ${record.driver_threads} thread, ${record.chains} chains; ${record.order}; ` +
    `net: ${record.net}. A ratio holds for its driver only`);
  if (!found.current) {
    add("Note", "measured before the function's text last changed");
  }
  return list;
}

function timeText(shading, found) {
  const net = `${brief(found.net_ns, 3)} ns net per evaluation`;
  if (shading.name === found.base) {
    return net;
  }
  const [low, high] = found.ratio_quartiles.map((x) => brief(x));
  return `${brief(found.ratio)} × ${found.base}, quartiles ${low} to ${high}; ${net}`;
}
