// One frame: what kit, parameters and pose make of the uniform block and the draw calls.

import { DEPTH_FROM, inBody, meshBall, posed, viewProjection } from "./camera.js";
import { Uniforms } from "./uniforms.js";

export class Frame {
  /** depth: "opengl" or "webgpu", the convention of the backend. */
  constructor(kit, depth) {
    this.kit = kit;
    this.depthFrom = DEPTH_FROM[depth];
    this.uniforms = new Uniforms(kit.about.uniforms);
    this.ball = meshBall(kit);
    this.scene = new Map(kit.about.uniforms.members.map((member) => [member.name, member.value]));
  }

  /** Value of a parameter in the scene: a path of the shading function, or a member of the coat. */
  initial(path) {
    return this.scene.get(this.member(path));
  }

  /** Sets a parameter for all frames to come. */
  set(path, value) {
    const member = this.member(path);
    this.uniforms.set(member, value);
    if (member === "layers") {
      this.layers = value;
    }
    if (member === "coat_length") {
      this.coat = value;
    }
  }

  /** Bytes of the uniform block for a pose and a picture of some aspect. */
  at(pose, aspect) {
    const { camera } = this.kit.about.scene;
    const here = posed(camera, pose);
    const bounds = { ...this.ball, radius: this.ball.radius + (this.coat ?? this.scene.get("coat_length")) };
    this.uniforms.set("view_projection", viewProjection(here, aspect, bounds, this.depthFrom));
    this.uniforms.set("eye", here.eye);
    const lights = this.scene.get("light_direction");
    const turned = [];
    for (let k = 0; k < lights.length; k += 4) {
      turned.push(...inBody(lights.slice(k, k + 3), camera, pose), 0);
    }
    this.uniforms.set("light_direction", turned);
    return this.uniforms.bytes;
  }

  /** How often each pass is drawn, by its name. */
  instances() {
    const shells = (this.layers ?? this.scene.get("layers")) - 1;
    return Object.fromEntries(
      this.kit.passes.map((pass) => [pass.name, pass.name === "shell" ? shells : pass.instances]),
    );
  }

  member(path) {
    return this.kit.about.shading.material[path] ?? path;
  }
}
