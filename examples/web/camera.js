// Where the picture is taken from: a turntable in front of a camera, for either graphics interface.

import { add, cross, dot, length, scale, subtract, turned, unit } from "./vectors.js";

const NEAREST = 1e-3; // of the far plane: how near the near plane may come to a camera inside the coat
const STEEPEST = 1.45; // radians between the horizon and the view, so that up is never along it
export const CLOSEST = 0.4; // of the scene's distance
export const FARTHEST = 2.5;

/** Depth at the near plane by interface; at the far plane it is 1. */
export const DEPTH_FROM = { opengl: -1, webgpu: 0 };

/** How the body is turned (radians, yaw about the upright axis) and how far the camera is (1: the scene's). */
export const REST = Object.freeze({ yaw: 0, pitch: 0, distance: 1 });

/** The pose within what can be shown. */
export function limited(pose, camera) {
  const elevation = elevationOf(camera);
  const within = (x, least, most) => Math.min(Math.max(x, least), most);
  const pitch = within(pose.pitch, -STEEPEST - elevation, STEEPEST - elevation);
  return { yaw: pose.yaw, pitch, distance: within(pose.distance, CLOSEST, FARTHEST) };
}

/** The scene's camera for a pose, in the frame of the body: yaw turns the body, so its camera runs back. */
export function posed(camera, pose) {
  const up = unit(camera.up);
  const right = unit(cross(subtract(camera.target, camera.eye), up));
  let back = scale(subtract(camera.eye, camera.target), pose.distance);
  back = turned(back, right, -pose.pitch);
  back = turned(back, up, -pose.yaw);
  return { ...camera, eye: add(camera.target, back) };
}

/** A direction that is fixed in the room, a light's for instance, in the frame of the turned body. */
export function inBody(direction, camera, pose) {
  return turned(direction, unit(camera.up), -pose.yaw);
}

/** From scene units to clip space, column by column; `bounds` is a ball around everything that is drawn. */
export function viewProjection(camera, aspect, bounds, depthFrom) {
  const forward = unit(subtract(camera.target, camera.eye));
  const right = unit(cross(forward, camera.up));
  const up = cross(right, forward);
  const distance = dot(subtract(bounds.centre, camera.eye), forward);
  const far = Math.max(distance + bounds.radius, bounds.radius);
  const near = Math.max(distance - bounds.radius, NEAREST * far);
  const focal = 1 / Math.tan((camera.field_of_view * Math.PI) / 360);
  // Depth is z/w = (a z + b) / -z with depthFrom at z = -near and 1 at z = -far.
  const a = (depthFrom * near - far) / (far - near);
  const rows = [
    [...scale(right, focal / aspect), (-focal / aspect) * dot(right, camera.eye)],
    [...scale(up, focal), -focal * dot(up, camera.eye)],
    [...scale(forward, -a), a * dot(forward, camera.eye) + near * (a + depthFrom)],
    [...forward, -dot(forward, camera.eye)],
  ];
  return [0, 1, 2, 3].flatMap((column) => rows.map((row) => row[column]));
}

/** Centre and radius of a ball around the vertices of a kit, without their coat. */
export function meshBall(kit) {
  const part = kit.about.buffers.vertices;
  const position = part.attributes.find((attribute) => attribute.name === "position");
  const view = new DataView(kit.data, part.offset, part.bytes);
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  const each = (visit) => {
    for (let k = 0; k < part.count; k++) {
      const at = k * part.stride + position.offset;
      visit([0, 4, 8].map((step) => view.getFloat32(at + step, true)));
    }
  };
  each((p) => p.forEach((x, k) => {
    low[k] = Math.min(low[k], x);
    high[k] = Math.max(high[k], x);
  }));
  const centre = scale(add(low, high), 0.5);
  let radius = 0;
  each((p) => { radius = Math.max(radius, length(subtract(p, centre))); });
  return { centre, radius };
}

function elevationOf(camera) {
  return Math.asin(dot(unit(subtract(camera.eye, camera.target)), unit(camera.up)));
}
