// The page: loads the plan, opens a backend, and keeps picture, choices and address together.

import { readAddress, writeAddress } from "./address.js";
import { BACKENDS, NothingDraws, openBackend } from "./backends.js";
import { REST } from "./camera.js";
import { compare, sentence } from "./comparing.js";
import { Controls, make } from "./controls.js";
import { Frame } from "./frame.js";
import { KitError, loadKit, readJson } from "./kit.js";
import { Losses } from "./losses.js";
import { Pacing } from "./pacing.js";
import { at, showChoice, showComparison, showDetails, showMissing, showPicture, tell } from "./showing.js";
import { Turning } from "./turning.js";

const FORMAT = 1; // of web.json
const LEAST_PIXELS = 16; // along a side of the picture
const MOST_PIXELS = 1024;
const MOST_SIDE = 4; // samples along the side of a pixel
const RETRY_AFTER = 400; // milliseconds between a lost context and the next one
const FIXED = ["pixels", "side"]; // kept in the address as they were given

class Page {
  constructor(plan) {
    this.plan = plan;
    this.address = readAddress();
    this.shading = this.find(this.address.get("shading")) ?? plan.shadings[0];
    this.backend = this.address.get("backend") in BACKENDS ? this.address.get("backend") : "webgpu";
    this.pacing = new Pacing((share) => this.draw(share));
    this.losses = new Losses();
    this.frames = new Map(); // by shading function, for the renderer that is open
    this.ready = false; // whether there is something to draw
    this.turn = 0; // counts what was asked for: an answer to an older question is dropped
    this.count = 0; // frames drawn
  }

  find(name) {
    return this.plan.shadings.find((shading) => shading.name === name);
  }

  /** Opens a backend and draws with it; says the sentence, or why another backend draws. */
  async useBackend(name, said = "") {
    const turn = ++this.turn;
    this.ready = false;
    this.renderer?.release();
    this.renderer = null;
    this.frames.clear();
    const opened = await openBackend(name, newCanvas);
    if (turn !== this.turn) {
      opened.renderer.release();
      return;
    }
    this.backend = opened.name;
    this.renderer = opened.renderer;
    this.renderer.onLost = () => this.lost(opened.renderer);
    if (opened.sentence) {
      showMissing(name);
    }
    tell(opened.sentence || said);
    await this.useShading(this.shading);
  }

  /** Loads a shading function's kit and draws with it. */
  async useShading(shading) {
    const turn = ++this.turn;
    this.shading = shading;
    showChoice(this.plan, shading, this.backend);
    const frame = await this.frameOf(shading);
    if (turn !== this.turn) {
      return;
    }
    this.frame = frame;
    this.setUp(frame);
    this.apply(frame);
    this.controls.markUnused(shading.unused);
    this.remember();
    this.ready = !this.renderer.gone;
    this.pacing.settled();
  }

  /** The frame of a shading function, ready to be drawn. */
  async frameOf(shading) {
    const { renderer, frames } = this;
    if (!frames.has(shading.name)) {
      const kit = await loadKit(shading.kit, renderer.language);
      await renderer.prepare(kit);
      frames.set(shading.name, new Frame(kit, renderer.depth));
    }
    return frames.get(shading.name);
  }

  /** What needs a first kit, for the camera and the values of its scene. */
  setUp(frame) {
    if (this.controls) {
      return;
    }
    const initial = (path) => frame.initial(path);
    this.controls = new Controls(at("parameters"), this.plan, initial, () => this.changed());
    for (const { sets } of this.plan.parameters) {
      if (this.address.has(sets[0])) {
        this.controls.set(sets[0], this.address.get(sets[0]).split(",").map(parseFloat));
      }
    }
    this.turning = new Turning(at("stage"), frame.kit.about.scene.camera, () => this.moved());
    const pose = Object.entries(REST).map(([key, value]) => [key, Number(this.address.get(key) ?? value)]);
    if (pose.every(([, value]) => Number.isFinite(value))) {
      this.turning.set(Object.fromEntries(pose));
    }
    new ResizeObserver(() => this.pacing.settled()).observe(at("stage"));
  }

  /** Sets in a frame what was set with the controls. */
  apply(frame) {
    for (const [path, value] of this.controls.differing()) {
      const { sets } = this.plan.parameters.find((entry) => entry.sets[0] === path);
      sets.forEach((member) => frame.set(member, value));
    }
  }

  changed() {
    if (this.controls.differing().length === 0) {
      this.frames.clear(); // they hold what was set before
      this.useShading(this.shading).catch(report);
    } else {
      this.apply(this.frame);
      this.moved();
    }
  }

  moved() {
    this.remember();
    this.pacing.moved();
  }

  remember() {
    const pose = Object.entries(this.turning.pose).filter(([key, value]) => value !== REST[key]);
    const short = (value, digits) => [value].flat().map((x) => Number(x.toPrecision(digits))).join(",");
    writeAddress({
      backend: this.backend,
      shading: this.shading.name,
      ...Object.fromEntries(this.controls.differing().map(([path, value]) => [path, short(value, 6)])),
      ...Object.fromEntries(pose.map(([key, value]) => [key, short(value, 4)])),
      ...Object.fromEntries(FIXED.map((key) => [key, this.address.get(key)])),
    });
  }

  /** Draws a frame with a share of the pixels along either side; resolves to whether there was one to draw. */
  async draw(share) {
    const { renderer } = this;
    if (!renderer || !this.ready) {
      return false;
    }
    const picture = this.size(share);
    try {
      this.drawn(this.frame, picture);
    } catch (error) {
      if (!(error instanceof DOMException)) {
        throw error;
      }
      this.lost(renderer);
      return false;
    }
    showPicture(this.backend, renderer, picture, this.frame.instances().shell + 1, share < 1);
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
    const density = Math.min(window.devicePixelRatio || 1, 2);
    const shown = Math.min(at("stage").clientWidth * density, MOST_PIXELS);
    const pixels = this.fixed("pixels", 2 * MOST_PIXELS) ?? Math.max(Math.round(shown * share), LEAST_PIXELS);
    const side = this.fixed("side", MOST_SIDE) ?? (share === 1 && density < 1.5 ? 2 : 1);
    return { width: pixels, height: pixels, side, top, bottom };
  }

  /** A whole number that the address fixes; null where it fixes none that can be drawn. */
  fixed(key, most) {
    const given = Number(this.address.get(key));
    return Number.isInteger(given) && given > 0 && given <= most ? given : null;
  }

  /** A renderer's context went away; told once of each. */
  lost(renderer) {
    if (renderer !== this.renderer || renderer.gone) {
      return;
    }
    renderer.gone = true;
    this.ready = false;
    const { next, sentence: said } = this.losses.count(this.backend);
    tell(said);
    setTimeout(() => {
      if (next !== null && renderer === this.renderer) {
        this.useBackend(next, next === this.backend ? "" : said).catch(report);
      }
    }, RETRY_AFTER);
  }

  /** Compares the chosen variant with the base, here and now. */
  async compare() {
    const { plan, shading, renderer, backend } = this;
    showComparison(plan, shading, "Drawing both in turns …");
    at("compare").disabled = true;
    const base = await this.frameOf(this.find(plan.base));
    this.apply(base);
    const picture = this.size(1);
    const draws = [base, this.frame].map((frame) => () => this.drawn(frame, picture));
    const measured = await this.pacing.exclusively(() =>
      compare(draws, () => renderer.finished(), () => captured(renderer.canvas)),
    );
    if (shading === this.shading && renderer === this.renderer) {
      const device = `${BACKENDS[backend].title} on ${renderer.device}`;
      showComparison(plan, shading, sentence(measured, [plan.base, shading.name], device, picture));
    }
  }

  listen() {
    for (const form of ["choices", "parameters"]) {
      at(form).addEventListener("submit", (event) => event.preventDefault());
    }
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
    at("reset").addEventListener("click", () => this.controls?.reset());
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

/** Tells what the reader can do something about; anything else is a fault of the page and goes on its way. */
function report(error) {
  if (!(error instanceof KitError || error instanceof NothingDraws)) {
    throw error;
  }
  tell(error.message);
  at("status").textContent = "";
}

async function start() {
  const plan = await readJson("web.json");
  if (plan?.format !== FORMAT) {
    throw new KitError(`web.json is not of format ${FORMAT}; generate the page anew with “vair demo web”.`);
  }
  showDetails();
  const page = new Page(plan);
  page.listen();
  window.page = page; // for the console, and for tests
  await page.useBackend(page.backend);
}

start().catch(report);
