// The chosen variant against the base in this browser: frame times in turns, and how the pictures differ.

import { brief, counted, quartiles } from "./numbers.js";

const BATCH = 60; // milliseconds that a timing should last at least
const MOST_FRAMES = 64; // of one timing
const BUDGET = 6000; // milliseconds for all rounds
const ROUNDS = { least: 3, most: 9 };

/**
 * Measures two ways to draw a frame, in turns: A B B A in every round.
 *
 * draws      two functions that draw a frame each
 * finished   resolves when everything drawn is done
 * capture    bytes of the canvas, right after a frame was drawn
 * Returns { ratio: quartiles of B over A, rounds, frames, steps: { mean, largest, equal } }.
 */
export async function compare(draws, finished, capture) {
  const pictures = [];
  for (const draw of draws) {
    draw();
    pictures.push(capture());
    await finished();
  }
  const once = await timed(draws[0], finished, 1);
  const frames = Math.min(Math.max(Math.ceil(BATCH / Math.max(once, 0.1)), 1), MOST_FRAMES);
  const ratios = [];
  const start = performance.now();
  while (ratios.length < ROUNDS.least || (ratios.length < ROUNDS.most && performance.now() - start < BUDGET)) {
    const [a, b] = draws;
    const costs = [];
    for (const draw of [a, b, b, a]) {
      costs.push(await timed(draw, finished, frames));
    }
    ratios.push((costs[1] + costs[2]) / (costs[0] + costs[3]));
  }
  return { ratio: quartiles(ratios), rounds: ratios.length, frames, steps: difference(...pictures) };
}

/** The result as a sentence, error first. */
export function sentence(result, names, device, picture) {
  const { ratio, rounds, frames, steps } = result;
  const [low, median, high] = ratio.map((x) => brief(x));
  return (
    `Pictures differ by ${brief(steps.mean)} 8-bit steps on average, ${steps.largest} at most, ` +
    `${brief(100 * steps.equal, 3)} % of the pixels by less than 2. ` +
    `A frame of ${names[1]} takes ${median} × that of ${names[0]} (quartiles ${low} to ${high}). ` +
    `${device}; ${picture.width} × ${picture.height} pixels of ${counted(picture.side ** 2, "sample")}; ` +
    `wall clock, ${rounds} rounds of A B B A, ${counted(frames, "frame")} a timing.`
  );
}

async function timed(draw, finished, frames) {
  const start = performance.now();
  for (let k = 0; k < frames; k++) {
    draw();
  }
  await finished();
  return performance.now() - start;
}

function difference(a, b) {
  let sum = 0;
  let largest = 0;
  let equal = 0;
  for (let k = 0; k < a.length; k += 4) {
    let most = 0;
    for (let c = 0; c < 3; c++) {
      const apart = Math.abs(a[k + c] - b[k + c]);
      sum += apart;
      most = Math.max(most, apart);
    }
    largest = Math.max(largest, most);
    equal += most < 2 ? 1 : 0;
  }
  const pixels = a.length / 4;
  return { mean: sum / (3 * pixels), largest, equal: equal / pixels };
}
