// A kit, the folder that `vair fur` writes: fur.json, stages and buffers, checked before anything is drawn.

export const FORMAT = 1;

/** Something is wrong with the data; the message is one sentence for the reader of the page. */
export class KitError extends Error {}

/** What a renderer needs of one shading function. Texts and buffers lie in memory. */
export class Kit {
  constructor(url, about, texts, data) {
    this.url = url;
    this.about = about;
    this.texts = texts;
    this.data = data;
  }

  /** Names of everything that is drawn, in drawing order. */
  get passes() {
    return this.about.passes;
  }

  text(name) {
    return this.texts.get(name);
  }

  /** Vertices or triangles, ready to be uploaded. */
  buffer(name) {
    const { offset, bytes } = this.about.buffers[name];
    return new Uint8Array(this.data, offset, bytes);
  }

  /** Address of the mesh: kits that share it share the buffers of a renderer. */
  get meshUrl() {
    return new URL(this.about.buffers.file, this.url).href;
  }
}

const AGAIN = "generate the page anew with “vair demo web”.";
const files = new Map();

/** Reads a kit; `language` is "glsl" or "wgsl". Throws KitError. */
export async function loadKit(address, language) {
  const url = new URL(address, document.baseURI).href;
  const about = checked(await readJson(url), address);
  const names = new Set(
    about.passes.flatMap((pass) => (language === "wgsl" ? [pass.wgsl.file] : pass.glsl.es300)),
  );
  const texts = new Map();
  const [data] = await Promise.all([
    read(new URL(about.buffers.file, url).href, "arrayBuffer"),
    ...[...names].map(async (name) => texts.set(name, await read(new URL(name, url).href, "text"))),
  ]);
  checkBuffers(about, data, address);
  return new Kit(url, about, texts, data);
}

/** Reads a JSON file. Throws KitError. */
export async function readJson(address) {
  const text = await read(new URL(address, document.baseURI).href, "text");
  try {
    return JSON.parse(text);
  } catch {
    throw new KitError(`${shown(address)} is not JSON; ${AGAIN}`);
  }
}

/** Reads a text file that lies beside the page. Throws KitError. */
export function readText(address) {
  return read(new URL(address, document.baseURI).href, "text");
}

function read(url, as) {
  const key = `${as} ${url}`;
  if (!files.has(key)) {
    const reading = fetched(url, as);
    reading.catch(() => files.delete(key));
    files.set(key, reading);
  }
  return files.get(key);
}

async function fetched(url, as) {
  let answer;
  try {
    answer = await fetch(url);
  } catch {
    throw new KitError(`${shown(url)} cannot be read: the server gives no answer.`);
  }
  if (!answer.ok) {
    throw new KitError(`${shown(url)} cannot be read: the server answers ${answer.status}.`);
  }
  return answer[as]();
}

function checked(about, address) {
  const where = shown(address);
  if (about === null || typeof about !== "object" || about.format !== FORMAT) {
    throw new KitError(`${where} is not a kit of format ${FORMAT}; ${AGAIN}`);
  }
  for (const key of ["scene", "shading", "passes", "buffers", "uniforms", "view_projection"]) {
    if (typeof about[key] !== "object" || about[key] === null) {
      throw new KitError(`${where} has no “${key}”; ${AGAIN}`);
    }
  }
  for (const pass of about.passes) {
    for (const key of ["vertices", "triangles"]) {
      if (!about.buffers[pass[key]]) {
        throw new KitError(`${where}: pass ${pass.name} draws a buffer “${pass[key]}” that is not there.`);
      }
    }
  }
  for (const member of about.uniforms.members) {
    const known = member.value !== undefined || member.name === "view_projection";
    if (!known || ![member.value ?? 0].flat().every(Number.isFinite)) {
      throw new KitError(`${where}: the uniform ${member.name} has no finite value.`);
    }
  }
  return about;
}

function checkBuffers(about, data, address) {
  for (const [name, part] of Object.entries(about.buffers)) {
    if (typeof part === "object" && part.offset + part.bytes > data.byteLength) {
      throw new KitError(`${shown(address)}: ${name} reaches beyond the end of ${about.buffers.file}.`);
    }
  }
}

function shown(address) {
  const url = new URL(address, document.baseURI);
  const base = new URL(".", document.baseURI);
  return url.href.startsWith(base.href) ? url.href.slice(base.href.length) : url.href;
}
