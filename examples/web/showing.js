// What the page says: the sentence under the picture, the state of the picture, the choices and their figures.

import { BACKENDS } from "./backends.js";
import { make } from "./controls.js";
import { recordedFigures } from "./measured.js";
import { counted } from "./numbers.js";

const WIDE = "(min-width: 46rem)"; // where details do not push everything else away

export const at = (id) => document.getElementById(id);

/** Shows a sentence, or none. */
export function tell(text) {
  at("message").textContent = text;
  at("message").hidden = text === "";
}

/** What is drawn, and by what. */
export function showPicture(backend, renderer, picture, layers, coarse) {
  const { width, height, side } = picture;
  const pixels = `${width} × ${height} pixels of ${counted(side * side, "sample")}`;
  const fewer = coarse ? ", fewer while it moves" : "";
  const drawer = `${BACKENDS[backend].title} on ${renderer.device}`;
  at("status").textContent = `${drawer}: ${pixels}${fewer}; ${layers} layers.`;
}

/** The chosen backend and variant, and what is recorded of them. */
export function showChoice(plan, shading, backend) {
  document.querySelector(`input[name="backend"][value="${backend}"]`).checked = true;
  document.querySelector(`input[name="formulas"][value="${shading.formulas}"]`).checked = true;
  const options = plan.shadings.filter((other) => other.formulas === shading.formulas);
  at("variant").replaceChildren(
    ...options.map((other) => new Option(other.label, other.name, false, other === shading)),
  );
  at("variant").disabled = options.length === 1;
  at("note").replaceChildren(make("code", { textContent: shading.name }), `: ${shading.note}`);
  const { headline, facts } = recordedFigures(plan, shading, backend);
  at("recorded").replaceChildren(...headline);
  const cells = facts.flatMap(([term, text]) => [
    make("dt", { textContent: term }),
    make("dd", { textContent: text }),
  ]);
  at("facts").querySelector("dl").replaceChildren(...cells);
  showComparison(plan, shading, "");
}

/** The result of a comparison, and whether there is something to compare. */
export function showComparison(plan, shading, text) {
  at("compared").textContent = text;
  at("compare").textContent = `Compare with ${plan.base} here`;
  at("compare").disabled = shading.name === plan.base;
}

/** Opens the details where there is room for them. */
export function showDetails() {
  at("facts").open = window.matchMedia(WIDE).matches;
}

/** A backend that does not draw here cannot be chosen. */
export function showMissing(backend) {
  document.querySelector(`input[name="backend"][value="${backend}"]`).disabled = true;
}
