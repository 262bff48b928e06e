// Mouse, pen, touch and keys turn the body: each changes the pose and tells who listens.

import { REST, limited } from "./camera.js";

const STEP = Math.PI / 24; // radians of an arrow key
const NEARER = 1.1; // factor of the distance of one key or one notch of the wheel

const KEYS = {
  ArrowLeft: (pose) => ({ ...pose, yaw: pose.yaw - STEP }),
  ArrowRight: (pose) => ({ ...pose, yaw: pose.yaw + STEP }),
  ArrowUp: (pose) => ({ ...pose, pitch: pose.pitch - STEP }),
  ArrowDown: (pose) => ({ ...pose, pitch: pose.pitch + STEP }),
  "+": (pose) => ({ ...pose, distance: pose.distance / NEARER }),
  "=": (pose) => ({ ...pose, distance: pose.distance / NEARER }),
  "-": (pose) => ({ ...pose, distance: pose.distance * NEARER }),
  Home: () => ({ ...REST }),
};

export class Turning {
  /** Listens to an element; calls `changed` after the pose has changed. */
  constructor(element, camera, changed) {
    this.element = element;
    this.camera = camera;
    this.changed = changed;
    this.pose = { ...REST };
    this.pointers = new Map();
    element.addEventListener("keydown", (event) => this.key(event));
    element.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    element.addEventListener("pointerdown", (event) => this.down(event));
    element.addEventListener("pointermove", (event) => this.move(event));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
      element.addEventListener(end, (event) => this.pointers.delete(event.pointerId));
    }
  }

  set(pose) {
    this.pose = limited(pose, this.camera);
    this.changed();
  }

  key(event) {
    const change = KEYS[event.key];
    if (change && !event.ctrlKey && !event.metaKey && !event.altKey) {
      event.preventDefault();
      this.set(change(this.pose));
    }
  }

  wheel(event) {
    if (!event.ctrlKey) {
      event.preventDefault();
      this.set({ ...this.pose, distance: this.pose.distance * NEARER ** Math.sign(event.deltaY) });
    }
  }

  down(event) {
    this.element.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) {
      return;
    }
    const spread = this.spread();
    const now = [event.clientX, event.clientY];
    this.pointers.set(event.pointerId, now);
    if (this.pointers.size === 1) {
      const perPixel = Math.PI / this.element.clientWidth;
      const yaw = this.pose.yaw + perPixel * (now[0] - before[0]);
      this.set({ ...this.pose, yaw, pitch: this.pose.pitch + perPixel * (now[1] - before[1]) });
    } else if (this.pointers.size === 2 && spread > 0) {
      this.set({ ...this.pose, distance: (this.pose.distance * spread) / Math.max(this.spread(), 1) });
    }
  }

  /** Distance between two fingers; 0 with one. */
  spread() {
    const [a, b] = [...this.pointers.values()];
    return a && b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0;
  }
}
