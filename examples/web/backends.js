// Which backend draws: the one that is asked for, or the other one and a sentence why.

import { NoWebgl2, Webgl2Renderer } from "./webgl2.js";
import { NoWebgpu, WebgpuRenderer } from "./webgpu.js";

export const BACKENDS = Object.freeze({
  webgpu: { title: "WebGPU", renderer: WebgpuRenderer, refusal: NoWebgpu },
  webgl2: { title: "WebGL2", renderer: Webgl2Renderer, refusal: NoWebgl2 },
});

/** Neither backend can draw; the message says so. */
export class NothingDraws extends Error {}

/**
 * Opens a backend on a canvas of its own, which `newCanvas` makes: a canvas never changes its interface.
 *
 * Returns { name, renderer, sentence }; the sentence is empty where the backend asked for draws.
 * Throws NothingDraws.
 */
export async function openBackend(asked, newCanvas) {
  const refusals = [];
  for (const name of [asked, ...Object.keys(BACKENDS).filter((other) => other !== asked)]) {
    const { renderer, refusal, title } = BACKENDS[name];
    try {
      const opened = await renderer.open(newCanvas());
      const sentence = refusals.length > 0 ? `${refusals[0].replace(/\.$/, "")}; ${title} draws instead.` : "";
      return { name, renderer: opened, sentence };
    } catch (error) {
      if (error instanceof refusal) {
        refusals.push(error.message);
      } else if (error instanceof DOMException) {
        refusals.push(`${title} fails on this device.`);
      } else {
        throw error;
      }
    }
  }
  throw new NothingDraws("This browser offers neither WebGPU nor WebGL2, one of which the picture needs.");
}
