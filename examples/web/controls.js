// Sliders and colours for the parameters, as web.json lists them; what is set is kept by the parameter's path.

import { hexOf, linearOf } from "./colours.js";
import { brief } from "./numbers.js";

const STEPS = 1000; // of a slider whose parameter is not a whole number

export class Controls {
  /**
   * Builds the controls into an element.
   *
   * plan      web.json
   * initial   value of a parameter in the scene, by its path
   * changed   called after a value has changed
   */
  constructor(element, plan, initial, changed) {
    this.values = new Map();
    this.shown = new Map();
    this.initial = initial;
    this.changed = changed;
    const groups = new Map();
    const groupOf = (name) => {
      if (!groups.has(name)) {
        const group = make("fieldset");
        group.append(make("legend", { textContent: name }));
        groups.set(name, group);
        element.append(group);
      }
      return groups.get(name);
    };
    for (const entry of plan.parameters) {
      const row = entry.kind === "colour" ? this.colour(entry) : this.slider(entry);
      groupOf(entry.group).append(row);
    }
  }

  /** Sets a parameter to the numbers of an address, or to an end of its range; leaves out what is none. */
  set(path, numbers) {
    const { set, components } = this.shown.get(path);
    if (numbers.length === components && numbers.every(Number.isFinite)) {
      set(components === 1 ? numbers[0] : numbers);
    }
  }

  /** The keys and values that differ from the scene's. */
  differing() {
    return [...this.values];
  }

  reset() {
    for (const [path, shown] of this.shown) {
      shown.set(this.initial(path));
      this.values.delete(path);
    }
    this.changed();
  }

  /** Marks the parameters that a variant does not read. */
  markUnused(paths) {
    for (const [path, { row, input }] of this.shown) {
      const unused = paths.includes(path);
      row.classList.toggle("unused", unused);
      input.disabled = unused;
      row.title = unused ? "This variant does not read it." : "";
    }
  }

  keep(entry, value) {
    this.values.set(entry.sets[0], value);
    this.changed();
  }

  slider(entry) {
    const scale = scaleOf(entry);
    const input = make("input", { type: "range", min: 0, max: scale.steps, step: 1 });
    const output = make("output");
    const row = rowOf(entry, input, output);
    output.htmlFor = input.id;
    const path = entry.sets[0];
    const show = (value) => {
      output.textContent = brief(value, 3);
      input.setAttribute("aria-valuetext", output.textContent);
    };
    const set = (value) => {
      const near = entry.kind === "whole" ? Math.round(value) : value;
      const inside = Math.min(Math.max(near, entry.least), entry.most);
      input.value = scale.toStep(inside);
      show(inside);
      this.values.set(path, inside);
    };
    input.addEventListener("input", () => {
      const value = scale.toValue(Number(input.value));
      show(value);
      this.keep(entry, value);
    });
    this.shown.set(path, { row, input, set, components: 1 });
    set(this.initial(path));
    this.values.delete(path);
    return row;
  }

  colour(entry) {
    const input = make("input", { type: "color" });
    const row = rowOf(entry, input);
    const path = entry.sets[0];
    const set = (linear) => {
      const inside = linear.map((x) => Math.min(Math.max(x, 0), 1));
      input.value = hexOf(inside);
      this.values.set(path, inside);
    };
    input.addEventListener("input", () => this.keep(entry, linearOf(input.value)));
    this.shown.set(path, { row, input, set, components: 3 });
    set(this.initial(path));
    this.values.delete(path);
    return row;
  }
}

function rowOf(entry, input, ...others) {
  const row = make("div", { className: `parameter ${entry.kind}` });
  input.id = `parameter-${entry.sets[0].replaceAll(".", "-")}`;
  const label = make("label", { htmlFor: input.id, textContent: entry.label });
  row.append(label, input, ...others);
  return row;
}

function scaleOf(entry) {
  const { least, most } = entry;
  if (entry.kind === "whole") {
    return { steps: most - least, toStep: (x) => x - least, toValue: (s) => least + s };
  }
  if (entry.kind === "logarithmic") {
    const span = Math.log(most / least);
    return {
      steps: STEPS,
      toStep: (x) => Math.round((STEPS * Math.log(x / least)) / span),
      toValue: (s) => (s === STEPS ? most : least * Math.exp((s / STEPS) * span)),
    };
  }
  return {
    steps: STEPS,
    toStep: (x) => Math.round((STEPS * (x - least)) / (most - least)),
    toValue: (s) => (s === STEPS ? most : least + ((most - least) * s) / STEPS),
  };
}

/** An element with properties. */
export function make(name, properties = {}) {
  return Object.assign(document.createElement(name), properties);
}
