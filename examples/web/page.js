// The page: loads the plan, opens a backend, and keeps picture, choices and address together.

import { readAddress, writeAddress } from "./address.js";
import { BACKENDS, NothingDraws, openBackend } from "./backends.js";
import { REST } from "./camera.js";
import { compare, sentence } from "./comparing.js";
import { Controls, make } from "./controls.js";
import { Frame } from "./frame.js";
import { KitError, loadKit, readJson } from "./kit.js";
import { showRecorded } from "./measured.js";
import { counted } from "./numbers.js";
import { Pacing } from "./pacing.js";
import { Turning } from "./turning.js";

const FORMAT = 1; // of web.json
const MOST_SIDE = 1024; // pixels along a side of the picture
const MOST_LOSSES = 2; // of a backend, until the other one is tried
const RECENT = 30000; // milliseconds for which a loss is remembered
const RETRY_AFTER = 400; // milliseconds between a lost context and the next one

const at = (id) => document.getElementById(id);

class Page {
  constructor(plan) {
    this.plan = plan;
    this.address = readAddress();
    this.losses = [];
    this.turn = 0; // counts what was asked for; an answer to an older question is dropped
    this.shading = this.find(this.address.get("shading")) ?? plan.shadings[0];
    this.backend = this.address.get("backend") in BACKENDS ? this.address.get("backend") : "webgpu";
    this.pacing = new Pacing((share) => this.draw(share));
    this.frames = new Map();
    this.opened = false;
    this.count = 0; // frames drawn
  }

  find(name) {
    return this.plan.shadings.find((shading) => shading.name === name);
  }

  /** Opens a backend and draws with it; says the sentence, or why another backend draws. */
  async useBackend(name, sentence = "") {
    const turn = ++this.turn;
    this.renderer?.release();
    this.renderer = null;
    this.frames.clear();
    this.opened = false;
    const opened = await openBackend(name, newCanvas);
    if (turn !== this.turn) {
      opened.renderer.release();
      return;
    }
    this.backend = opened.name;
    this.renderer = opened.renderer;
    this.renderer.onLost = () => this.lost(opened.renderer);
    if (opened.sentence) {
      const missing = document.querySelector(`input[name="backend"][value="${name}"]`);
      missing.disabled = true;
    }
    tell(opened.sentence || sentence);
    await this.useShading(this.shading);
  }

  /** Loads a shading function's kit and draws with it. */
  async useShading(shading) {
    const turn = ++this.turn;
    this.shading = shading;
    this.showChoices();
    const frame = await this.frameOf(shading);
    if (turn !== this.turn) {
      return;
    }
    this.frame = frame;
    this.setUp(frame);
    for (const [path, value] of this.controls.differing()) {
      this.set(frame, path, value);
    }
    this.controls.markUnused(shading.unused);
    this.opened = true;
    this.pacing.settled();
  }

  /** The frame of a shading function, ready to be drawn. */
  async frameOf(shading) {
    const { renderer } = this;
    if (!this.frames.has(shading.name)) {
      const kit = await loadKit(shading.kit, renderer.language);
      await renderer.prepare(kit);
      this.frames.set(shading.name, new Frame(kit, renderer.depth));
    }
    return this.frames.get(shading.name);
  }

  /** What needs a first kit: its camera and the values of its scene. */
  setUp(frame) {
    if (this.controls) {
      return;
    }
    this.controls = new Controls(at("parameters"), this.plan, (path) => frame.initial(path), () => this.changed());
    for (const { sets } of this.plan.parameters) {
      const given = this.address.get(sets[0])?.split(",").map(Number);
      if (given?.every(Number.isFinite)) {
        this.controls.set(sets[0], given.length === 1 ? given[0] : given);
      }
    }
    this.turning = new Turning(at("stage"), frame.kit.about.scene.camera, () => this.moved());
    const [yaw, pitch, distance] = ["yaw", "pitch", "distance"].map((key) => Number(this.address.get(key) ?? REST[key]));
    if ([yaw, pitch, distance].every(Number.isFinite)) {
      this.turning.set({ yaw, pitch, distance });
    }
    new ResizeObserver(() => this.pacing.settled()).observe(at("stage"));
    at("compare").disabled = this.shading.name === this.plan.base;
  }

  set(frame, path, value) {
    const entry = this.plan.parameters.find(({ sets }) => sets[0] === path);
    entry.sets.forEach((member) => frame.set(member, value));
  }

  changed() {
    if (this.controls.differing().length === 0) {
      this.frames.clear(); // of frames that were changed
      this.useShading(this.shading).catch(report);
    } else {
      this.controls.differing().forEach(([path, value]) => this.set(this.frame, path, value));
    }
    this.moved();
  }

  moved() {
    this.remember();
    this.pacing.moved();
  }

  remember() {
    const given = Object.fromEntries(this.controls.differing().map(([path, value]) => [path, brief(value)]));
    const pose = Object.entries(this.turning.pose).filter(([key, value]) => value !== REST[key]);
    const fixed = ["pixels", "side"].map((key) => [key, this.address.get(key)]);
    writeAddress({
      backend: this.backend,
      shading: this.shading.name,
      ...given,
      ...Object.fromEntries(pose.map(([key, value]) => [key, value.toFixed(4)])),
      ...Object.fromEntries(fixed),
    });
  }

  /** Draws a frame; resolves to whether there was one to draw. */
  async draw(share) {
    const { renderer } = this;
    if (!renderer || !this.opened) {
      return false;
    }
    this.picture = this.size(share);
    try {
      this.drawn(this.frame, this.picture);
    } catch (error) {
      if (error instanceof DOMException) {
        this.lost(renderer);
        return false;
      }
      throw error;
    }
    this.showStatus(share);
    await renderer.finished();
    this.count++;
    return true;
  }

  drawn(frame, picture) {
    const uniforms = frame.at(this.turning.pose, picture.width / picture.height);
    this.renderer.draw(frame.kit, uniforms, frame.instances(), picture);
  }

  /** Pixels and samples of a picture; the address may fix both. */
  size(share) {
    const { top, bottom } = this.frame.kit.about.scene.background;
    const fixed = Number(this.address.get("pixels"));
    const density = Math.min(window.devicePixelRatio || 1, 2);
    const full = fixed > 0 ? fixed : Math.min(at("stage").clientWidth * density, MOST_SIDE);
    const pixels = Math.max(Math.round(fixed > 0 ? full : full * share), 16);
    const side = Number(this.address.get("side")) || (share === 1 && density < 1.5 ? 2 : 1);
    return { width: pixels, height: pixels, side, top, bottom };
  }

  /** The context went away: tries again, then with the other backend, then no more. */
  lost(renderer) {
    if (renderer !== this.renderer) {
      return;
    }
    this.opened = false;
    const now = performance.now();
    const recent = this.losses.filter(({ when }) => now - when < RECENT);
    this.losses = [...recent, { backend: this.backend, when: now }];
    const counted = this.losses.filter(({ backend }) => backend === this.backend).length;
    const [other] = Object.keys(BACKENDS).filter((name) => name !== this.backend);
    let next = this.backend;
    if (counted > MOST_LOSSES) {
      next = this.losses.some(({ backend }) => backend === other) ? null : other;
    }
    if (next === null) {
      tell("The graphics driver keeps taking the picture away; reload the page to try again.");
      return;
    }
    const { title } = BACKENDS[this.backend];
    const sentence =
      next === this.backend
        ? `The graphics driver took the context of ${title} away; it is being set up again.`
        : `The graphics driver keeps taking the context of ${title} away; ${BACKENDS[next].title} draws instead.`;
    tell(sentence);
    const { turn } = this;
    setTimeout(() => {
      if (turn === this.turn) {
        this.useBackend(next, next === this.backend ? "" : sentence).catch(report);
      }
    }, RETRY_AFTER);
  }

  async compare() {
    const base = this.find(this.plan.base);
    const shading = this.shading;
    const button = at("compare");
    button.disabled = true;
    at("compared").textContent = "Drawing both in turns …";
    const frame = await this.frameOf(base);
    this.controls.differing().forEach(([path, value]) => this.set(frame, path, value));
    const picture = this.size(1);
    const draws = [frame, this.frame].map((each) => () => this.drawn(each, picture));
    const { renderer } = this;
    const result = await this.pacing.exclusively(() =>
      compare(draws, () => renderer.finished(), () => captured(renderer.canvas)),
    );
    button.disabled = false;
    if (shading === this.shading) {
      const device = `${BACKENDS[this.backend].title} on ${renderer.device}`;
      at("compared").textContent = sentence(result, [base.name, shading.name], device, picture);
    }
  }

  showChoices() {
    const { plan, shading, backend } = this;
    document.querySelector(`input[name="backend"][value="${backend}"]`).checked = true;
    document.querySelector(`input[name="formulas"][value="${shading.formulas}"]`).checked = true;
    const options = plan.shadings.filter((other) => other.formulas === shading.formulas);
    at("variant").replaceChildren(
      ...options.map((other) => new Option(`${other.label}: ${other.name}`, other.name, false, other === shading)),
    );
    at("variant").disabled = options.length === 1;
    at("note").textContent = shading.note;
    at("compared").textContent = "";
    at("compare").textContent = `Compare with ${plan.base} in this browser`;
    at("compare").disabled = shading.name === plan.base;
    showRecorded(at("recorded"), plan, shading, backend);
    if (this.turning) {
      this.remember();
    }
  }

  showStatus(share) {
    const { width, height, side } = this.picture;
    const coarse = share < 1 ? ", fewer while it moves" : "";
    at("status").textContent = `${BACKENDS[this.backend].title} on ${this.renderer.device}: ` +
      `${width} × ${height} pixels of ${counted(side * side, "sample")}${coarse}; ${this.frame.instances().shell + 1} layers.`;
  }

  listen() {
    at("choices").addEventListener("submit", (event) => event.preventDefault());
    at("parameters").addEventListener("submit", (event) => event.preventDefault());
    at("choices").addEventListener("change", ({ target }) => {
      if (target.name === "backend") {
        this.useBackend(target.value).catch(report);
      } else if (target.name === "formulas") {
        const first = this.plan.shadings.find((shading) => shading.formulas === target.value);
        this.useShading(first).catch(report);
      } else {
        this.useShading(this.find(target.value)).catch(report);
      }
    });
    at("compare").addEventListener("click", () => this.compare().catch(report));
    at("reset").addEventListener("click", () => this.controls.reset());
  }
}

function newCanvas() {
  const canvas = make("canvas");
  canvas.setAttribute("aria-hidden", "true");
  at("stage").replaceChildren(canvas);
  return canvas;
}

/** Bytes of a canvas that was just drawn, in the same task. */
function captured(canvas) {
  const copy = new OffscreenCanvas(canvas.width, canvas.height);
  const context = copy.getContext("2d", { willReadFrequently: true });
  context.drawImage(canvas, 0, 0);
  return context.getImageData(0, 0, canvas.width, canvas.height).data;
}

const brief = (value) => [value].flat().map((x) => Number(x.toPrecision(6))).join(",");

/** Shows a sentence, or none. */
function tell(text) {
  at("message").textContent = text;
  at("message").hidden = text === "";
}

/** Tells what the reader can do something about; anything else is a fault of the page and goes on its way. */
function report(error) {
  if (error instanceof KitError || error instanceof NothingDraws) {
    tell(error.message);
    at("status").textContent = "";
    return;
  }
  throw error;
}

async function start() {
  const plan = await readJson("web.json");
  if (plan?.format !== FORMAT) {
    throw new KitError(`web.json is not of format ${FORMAT}; generate the page anew with “vair demo web”.`);
  }
  const page = new Page(plan);
  page.listen();
  window.page = page; // for the console, and for tests
  await page.useBackend(page.backend);
}

start().catch(report);
