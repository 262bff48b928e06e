// Draws a kit with WebGPU and the generated WGSL.

import { KitError, readText } from "./kit.js";

const COLOUR = "rgba16float";
const DEPTH = "depth32float";

/** Why WebGPU cannot draw here. */
export class NoWebgpu extends Error {}

export class WebgpuRenderer {
  language = "wgsl";
  depth = "webgpu";
  onLost = () => {};

  /** Throws NoWebgpu with a sentence where the browser or its driver lacks what is needed. */
  static async open(canvas) {
    if (!navigator.gpu) {
      throw new NoWebgpu("This browser offers no WebGPU.");
    }
    const adapter = await navigator.gpu.requestAdapter().catch(() => null);
    const device = await adapter?.requestDevice().catch(() => null);
    const context = device && canvas.getContext("webgpu");
    if (!context) {
      throw new NoWebgpu("This browser has WebGPU, but no graphics device for it.");
    }
    const format = navigator.gpu.getPreferredCanvasFormat();
    context.configure({ device, format, alphaMode: "opaque" });
    const renderer = new WebgpuRenderer(canvas, device, context, adapter.info);
    const module = await moduleOf(device, "develop", await readText("develop.wgsl"));
    renderer.developing = await device.createRenderPipelineAsync({
      layout: "auto",
      vertex: { module, entryPoint: "develop_vertex" },
      fragment: { module, entryPoint: "develop_fragment", targets: [{ format }] },
    });
    return renderer;
  }

  constructor(canvas, device, context, info) {
    this.canvas = canvas;
    this.gpu = device;
    this.context = context;
    this.device = [info.vendor, info.architecture, info.device, info.description].filter(Boolean).join(" ");
    this.pipelines = new Map();
    this.meshes = new Map();
    this.target = null;
    this.block = null;
    const usage = GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST;
    this.development = device.createBuffer({ size: 32, usage });
    this.layout = device.createBindGroupLayout({
      entries: [
        {
          binding: 0,
          visibility: GPUShaderStage.VERTEX | GPUShaderStage.FRAGMENT,
          buffer: { type: "uniform" },
        },
      ],
    });
    this.released = false;
    device.lost.then(() => {
      if (!this.released) {
        this.onLost();
      }
    });
  }

  /** Compiles a kit's stages and uploads its mesh, once. Throws KitError. */
  async prepare(kit) {
    if (!this.pipelines.has(kit.url)) {
      const made = new Map();
      for (const pass of kit.passes) {
        const name = `${kit.about.shading.function}, pass ${pass.name}`;
        const module = await moduleOf(this.gpu, name, kit.text(pass.wgsl.file));
        const described = pipelineOf(this.gpu, this.layout, kit, pass, module);
        try {
          made.set(pass.name, await this.gpu.createRenderPipelineAsync(described));
        } catch (error) {
          throw new KitError(`WebGPU does not accept the stages of ${name}: ${firstLine(error.message)}.`);
        }
      }
      this.pipelines.set(kit.url, made);
    }
    if (!this.meshes.has(kit.meshUrl)) {
      this.meshes.set(kit.meshUrl, meshOf(this.gpu, kit));
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
    const { gpu, canvas } = this;
    if (canvas.width !== picture.width || canvas.height !== picture.height) {
      [canvas.width, canvas.height] = [picture.width, picture.height];
    }
    const target = this.samplesOf(picture.width * picture.side, picture.height * picture.side);
    gpu.queue.writeBuffer(this.blockOf(uniforms.byteLength).buffer, 0, uniforms);
    const encoder = gpu.createCommandEncoder();
    const pass = encoder.beginRenderPass({
      colorAttachments: [
        { view: target.colour.createView(), clearValue: [0, 0, 0, 0], loadOp: "clear", storeOp: "store" },
      ],
      depthStencilAttachment: {
        view: target.depth.createView(),
        depthClearValue: 1,
        depthLoadOp: "clear",
        depthStoreOp: "discard",
      },
    });
    pass.setBindGroup(0, this.block.group);
    for (const { name } of kit.passes) {
      const { vertices, triangles, count } = this.meshes.get(kit.meshUrl).get(name);
      pass.setPipeline(this.pipelines.get(kit.url).get(name));
      pass.setVertexBuffer(0, vertices);
      pass.setIndexBuffer(triangles, "uint32");
      pass.drawIndexed(count, instances[name]);
    }
    pass.end();
    this.develop(encoder, target, picture);
    gpu.queue.submit([encoder.finish()]);
  }

  develop(encoder, target, picture) {
    const values = new ArrayBuffer(32);
    new Float32Array(values, 0, 3).set(picture.top);
    new Uint32Array(values, 12, 1)[0] = picture.side;
    new Float32Array(values, 16, 3).set(picture.bottom);
    this.gpu.queue.writeBuffer(this.development, 0, values);
    const pass = encoder.beginRenderPass({
      colorAttachments: [
        { view: this.context.getCurrentTexture().createView(), loadOp: "clear", storeOp: "store" },
      ],
    });
    pass.setPipeline(this.developing);
    pass.setBindGroup(0, target.group);
    pass.draw(3);
    pass.end();
  }

  /** Resolves when everything that was drawn is done. */
  async finished() {
    await this.gpu.queue.onSubmittedWorkDone().catch(() => {});
  }

  release() {
    this.released = true;
    this.context.unconfigure();
    this.gpu.destroy();
  }

  blockOf(size) {
    if (this.block?.buffer.size !== size) {
      const buffer = this.gpu.createBuffer({ size, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
      const entries = [{ binding: 0, resource: { buffer } }];
      this.block = { buffer, group: this.gpu.createBindGroup({ layout: this.layout, entries }) };
    }
    return this.block;
  }

  /** The target of half floats with its depth, of a size in samples. */
  samplesOf(width, height) {
    if (this.target?.colour.width !== width || this.target?.colour.height !== height) {
      this.target?.colour.destroy();
      this.target?.depth.destroy();
      const attached = GPUTextureUsage.RENDER_ATTACHMENT;
      const size = [width, height];
      const usage = attached | GPUTextureUsage.TEXTURE_BINDING;
      const colour = this.gpu.createTexture({ size, format: COLOUR, usage });
      const depth = this.gpu.createTexture({ size, format: DEPTH, usage: attached });
      const entries = [
        { binding: 0, resource: colour.createView() },
        { binding: 1, resource: { buffer: this.development } },
      ];
      const group = this.gpu.createBindGroup({ layout: this.developing.getBindGroupLayout(0), entries });
      this.target = { colour, depth, group };
    }
    return this.target;
  }
}

async function moduleOf(device, name, code) {
  device.pushErrorScope("validation");
  const module = device.createShaderModule({ code, label: name });
  const { messages } = await module.getCompilationInfo();
  await device.popErrorScope();
  const error = messages.find((message) => message.type === "error");
  if (error) {
    const said = `line ${error.lineNum}, ${firstLine(error.message)}`;
    throw new KitError(`WebGPU does not accept the shaders of ${name}: ${said}.`);
  }
  return module;
}

/** What each pass draws, by its name; a buffer that several passes draw is uploaded once. */
function meshOf(device, kit) {
  const uploaded = new Map();
  const upload = (name, use) => {
    if (!uploaded.has(name)) {
      const data = kit.buffer(name);
      const buffer = device.createBuffer({ size: data.byteLength, usage: use | GPUBufferUsage.COPY_DST });
      device.queue.writeBuffer(buffer, 0, data);
      uploaded.set(name, buffer);
    }
    return uploaded.get(name);
  };
  const drawn = (pass) => ({
    vertices: upload(pass.vertices, GPUBufferUsage.VERTEX),
    triangles: upload(pass.triangles, GPUBufferUsage.INDEX),
    count: kit.about.buffers[pass.triangles].count,
  });
  return new Map(kit.passes.map((pass) => [pass.name, drawn(pass)]));
}

function pipelineOf(device, layout, kit, pass, module) {
  const described = kit.about.buffers[pass.vertices];
  const attributes = described.attributes.map(({ location, floats, offset }) => ({
    shaderLocation: location,
    offset,
    format: floats === 1 ? "float32" : `float32x${floats}`,
  }));
  const target = { format: COLOUR };
  if (pass.state.blend) {
    const component = ({ source, destination, operation }) => ({
      srcFactor: source,
      dstFactor: destination,
      operation,
    });
    const { colour, alpha } = pass.state.blend;
    target.blend = { color: component(colour), alpha: component(alpha) };
  }
  return {
    layout: device.createPipelineLayout({ bindGroupLayouts: [layout] }),
    vertex: {
      module,
      entryPoint: pass.wgsl.vertex,
      buffers: [{ arrayStride: described.stride, attributes }],
    },
    fragment: { module, entryPoint: pass.wgsl.fragment, targets: [target] },
    primitive: { topology: "triangle-list", cullMode: pass.state.cull },
    depthStencil: {
      format: DEPTH,
      depthWriteEnabled: pass.state.depth_write,
      depthCompare: pass.state.depth_test,
    },
  };
}

function firstLine(text) {
  return text.trim().split("\n")[0];
}
