// Draws a kit with WebGL2 and the generated GLSL ES 3.00.

import { KitError, readText } from "./kit.js";

const BINDING = 0;

/** Why WebGL2 cannot draw here. */
export class NoWebgl2 extends Error {}

export class Webgl2Renderer {
  language = "glsl";
  depth = "opengl";
  onLost = () => {};

  /** Throws NoWebgl2 with a sentence where the browser or its driver lacks what is needed. */
  static async open(canvas) {
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false });
    if (!gl) {
      throw new NoWebgl2("This browser offers no WebGL2.");
    }
    if (!gl.getExtension("EXT_color_buffer_float") && !gl.getExtension("EXT_color_buffer_half_float")) {
      throw new NoWebgl2("WebGL2 cannot draw into half floats on this device.");
    }
    const texts = await Promise.all([readText("develop-es300.vert"), readText("develop-es300.frag")]);
    return new Webgl2Renderer(canvas, gl, texts);
  }

  constructor(canvas, gl, [vertex, fragment]) {
    this.canvas = canvas;
    this.gl = gl;
    this.developing = program(gl, "develop", vertex, fragment);
    this.blank = gl.createVertexArray();
    this.programs = new Map();
    this.meshes = new Map();
    this.block = gl.createBuffer();
    this.target = null;
    this.device = deviceName(gl);
    this.lost = () => this.onLost();
    canvas.addEventListener("webglcontextlost", this.lost);
  }

  /** Compiles a kit's stages and uploads its mesh, once. Throws KitError. */
  async prepare(kit) {
    const { gl } = this;
    if (!this.programs.has(kit.url)) {
      const made = new Map();
      for (const pass of kit.passes) {
        const [vertex, fragment] = pass.glsl.es300.map((name) => kit.text(name));
        const linked = program(gl, `${kit.about.shading.function}, pass ${pass.name}`, vertex, fragment);
        const index = gl.getUniformBlockIndex(linked, kit.about.uniforms.block);
        gl.uniformBlockBinding(linked, index, BINDING);
        made.set(pass.name, linked);
      }
      this.programs.set(kit.url, made);
    }
    if (!this.meshes.has(kit.meshUrl)) {
      this.meshes.set(kit.meshUrl, meshOf(gl, kit));
    }
  }

  /**
   * Draws a frame.
   *
   * uniforms    bytes of the uniform block
   * instances   how often each pass is drawn, by its name
   * picture     width and height in pixels, side (samples along the side of a pixel), top and bottom colour
   */
  draw(kit, uniforms, instances, picture) {
    const { gl, canvas } = this;
    if (gl.isContextLost()) {
      return;
    }
    if (canvas.width !== picture.width || canvas.height !== picture.height) {
      [canvas.width, canvas.height] = [picture.width, picture.height];
    }
    const target = this.samplesOf(picture.width * picture.side, picture.height * picture.side);
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.block);
    gl.bufferData(gl.UNIFORM_BUFFER, uniforms, gl.DYNAMIC_DRAW);
    gl.bindBufferBase(gl.UNIFORM_BUFFER, BINDING, this.block);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
    gl.viewport(0, 0, target.width, target.height);
    gl.depthMask(true);
    gl.clearColor(0, 0, 0, 0);
    gl.clearDepth(1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    for (const pass of kit.passes) {
      const { array, count } = this.meshes.get(kit.meshUrl).get(pass.name);
      gl.useProgram(this.programs.get(kit.url).get(pass.name));
      applyState(gl, pass.state);
      gl.bindVertexArray(array);
      gl.drawElementsInstanced(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0, instances[pass.name]);
    }
    this.develop(target, picture);
  }

  develop(target, picture) {
    const { gl, developing } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, picture.width, picture.height);
    gl.disable(gl.BLEND);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.CULL_FACE);
    gl.useProgram(developing);
    gl.bindTexture(gl.TEXTURE_2D, target.colour);
    gl.uniform1i(gl.getUniformLocation(developing, "samples"), 0);
    gl.uniform1i(gl.getUniformLocation(developing, "side"), picture.side);
    gl.uniform3fv(gl.getUniformLocation(developing, "top"), picture.top);
    gl.uniform3fv(gl.getUniformLocation(developing, "bottom"), picture.bottom);
    gl.bindVertexArray(this.blank);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  /** Resolves when everything that was drawn is done. */
  finished() {
    const { gl } = this;
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    return new Promise((resolve) => {
      const look = () => {
        const answer = gl.isContextLost() ? gl.WAIT_FAILED : gl.clientWaitSync(fence, 0, 0);
        if (answer === gl.TIMEOUT_EXPIRED) {
          setTimeout(look, 1);
        } else {
          gl.deleteSync(fence);
          resolve();
        }
      };
      look();
    });
  }

  release() {
    this.canvas.removeEventListener("webglcontextlost", this.lost);
    if (!this.gl.isContextLost()) {
      this.gl.getExtension("WEBGL_lose_context")?.loseContext();
    }
  }

  /** The target of half floats with its depth, of a size in samples. */
  samplesOf(width, height) {
    const { gl } = this;
    if (this.target?.width !== width || this.target?.height !== height) {
      if (this.target) {
        gl.deleteTexture(this.target.colour);
        gl.deleteRenderbuffer(this.target.depth);
        gl.deleteFramebuffer(this.target.frame);
      }
      this.target = samplesTarget(gl, width, height);
    }
    return this.target;
  }
}

/** Chromium and Safari hide the name behind an extension, which Firefox has and frowns upon. */
function deviceName(gl) {
  const name = gl.getParameter(gl.RENDERER);
  const info = name.startsWith("WebKit") && gl.getExtension("WEBGL_debug_renderer_info");
  return info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : name;
}

function samplesTarget(gl, width, height) {
  const colour = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, colour);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA16F, width, height);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  const depth = gl.createRenderbuffer();
  gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
  gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT32F, width, height);
  const frame = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, colour, 0);
  gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
  return { colour, depth, frame, width, height };
}

function program(gl, name, vertex, fragment) {
  const made = gl.createProgram();
  const shaders = [
    [gl.VERTEX_SHADER, vertex],
    [gl.FRAGMENT_SHADER, fragment],
  ].map(([kind, text]) => {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
    return shader;
  });
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) {
    const logs = [...shaders.map((shader) => gl.getShaderInfoLog(shader)), gl.getProgramInfoLog(made)];
    const said = logs.find((log) => log?.trim())?.trim().split("\n")[0] ?? "no reason given";
    throw new KitError(`WebGL2 does not accept the shaders of ${name}: ${said}.`);
  }
  return made;
}

/** What each pass draws, by its name; a buffer that several passes draw is uploaded once. */
function meshOf(gl, kit) {
  const uploaded = new Map();
  const upload = (kind, name) => {
    if (uploaded.has(name)) {
      gl.bindBuffer(kind, uploaded.get(name));
      return;
    }
    uploaded.set(name, gl.createBuffer());
    gl.bindBuffer(kind, uploaded.get(name));
    gl.bufferData(kind, kit.buffer(name), gl.STATIC_DRAW);
  };
  const drawn = (pass) => {
    const described = kit.about.buffers[pass.vertices];
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    upload(gl.ARRAY_BUFFER, pass.vertices);
    for (const { location, floats, offset } of described.attributes) {
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, floats, gl.FLOAT, false, described.stride, offset);
    }
    upload(gl.ELEMENT_ARRAY_BUFFER, pass.triangles);
    gl.bindVertexArray(null);
    return { array, count: kit.about.buffers[pass.triangles].count };
  };
  return new Map(kit.passes.map((pass) => [pass.name, drawn(pass)]));
}

const COMPARE = { "less-equal": "LEQUAL", less: "LESS", always: "ALWAYS" };

function applyState(gl, state) {
  const named = (name) => gl[name.toUpperCase().replaceAll("-", "_")];
  gl.enable(gl.DEPTH_TEST);
  gl.depthFunc(gl[COMPARE[state.depth_test]]);
  gl.depthMask(state.depth_write);
  if (state.cull === "none") {
    gl.disable(gl.CULL_FACE);
  } else {
    gl.enable(gl.CULL_FACE);
    gl.cullFace(named(state.cull));
  }
  if (!state.blend) {
    gl.disable(gl.BLEND);
    return;
  }
  const { colour, alpha } = state.blend;
  gl.enable(gl.BLEND);
  gl.blendEquationSeparate(named(`func-${colour.operation}`), named(`func-${alpha.operation}`));
  gl.blendFuncSeparate(
    named(colour.source), named(colour.destination), named(alpha.source), named(alpha.destination),
  );
}
