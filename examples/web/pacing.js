// How many pixels a frame has: all of them at rest, fewer while something moves on a slow device.

const GOAL = 45; // milliseconds of a frame while something moves
const REST_AFTER = 250; // milliseconds without a change until the picture is drawn in full
const COARSEST = 0.25;

export class Pacing {
  /** `draw(share)` draws a frame with that share of the pixels along a side; it resolves to whether it drew. */
  constructor(draw) {
    this.drawFrame = draw;
    this.share = 1;
    this.wanted = null;
    this.busy = false;
    this.running = null;
    this.rest = 0;
    this.milliseconds = 0;
  }

  /** Something changed: draws soon, coarsely if need be, and in full when nothing has changed for a while. */
  moved() {
    this.want(this.share);
    clearTimeout(this.rest);
    if (this.share < 1) {
      this.rest = setTimeout(() => this.want(1), REST_AFTER);
    }
  }

  /** Draws in full, as soon as the frame before it is done. */
  settled() {
    clearTimeout(this.rest);
    this.want(1);
  }

  /** Runs a task while no frame is drawn, then draws in full. */
  async exclusively(task) {
    while (this.busy) {
      await this.running;
    }
    this.busy = true;
    try {
      return await task();
    } finally {
      this.busy = false;
      this.settled();
    }
  }

  want(share) {
    this.wanted = share;
    if (!this.busy) {
      this.busy = true;
      this.running = new Promise((resolve) => requestAnimationFrame(resolve)).then(() => this.run());
    }
  }

  async run() {
    const share = this.wanted;
    this.wanted = null;
    const start = performance.now();
    try {
      if (await this.drawFrame(share)) {
        this.milliseconds = performance.now() - start;
        this.adapt(share);
      }
    } finally {
      this.busy = false;
    }
    if (this.wanted !== null) {
      this.want(this.wanted);
    }
  }

  /** The cost of a frame is about a constant and a part for its pixels; this goes half of the way. */
  adapt(share) {
    const next = share * Math.sqrt(GOAL / Math.max(this.milliseconds, 1));
    this.share = Math.min(Math.max(Math.sqrt(this.share * next), COARSEST), 1);
  }
}
