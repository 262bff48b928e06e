// What to do when a graphics driver takes its context away: try again, then the other backend, then no more.

import { BACKENDS } from "./backends.js";

const MOST = 2; // losses of a backend until the other one is tried
const RECENT = 30000; // milliseconds for which a loss is remembered

export class Losses {
  constructor() {
    this.remembered = [];
  }

  /** Counts a loss; returns the backend to open next, or null, and the sentence that says so. */
  count(backend, now = performance.now()) {
    this.remembered = this.remembered.filter(({ when }) => now - when < RECENT);
    this.remembered.push({ backend, when: now });
    const { title } = BACKENDS[backend];
    if (this.of(backend) <= MOST) {
      const sentence = `The graphics driver took the context of ${title} away; it is being set up again.`;
      return { next: backend, sentence };
    }
    const other = Object.keys(BACKENDS).find((name) => name !== backend);
    if (this.of(other) === 0) {
      const gone = `The graphics driver keeps taking the context of ${title} away`;
      return { next: other, sentence: `${gone}; ${BACKENDS[other].title} draws instead.` };
    }
    const sentence = "The graphics driver keeps taking the picture away; reload the page to try again.";
    return { next: null, sentence };
  }

  of(backend) {
    return this.remembered.filter((loss) => loss.backend === backend).length;
  }
}
