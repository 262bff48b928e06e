// The uniform block: members with their offsets as fur.json describes them, values as they are set.

export class Uniforms {
  /** Starts with the values of the scene. */
  constructor(described) {
    this.members = new Map(described.members.map((member) => [member.name, member]));
    this.bytes = new ArrayBuffer(described.bytes);
    this.view = new DataView(this.bytes);
    for (const member of described.members) {
      if (member.value !== undefined) {
        this.set(member.name, member.value);
      }
    }
  }

  has(name) {
    return this.members.has(name);
  }

  /** Sets a member: a number, or numbers in the order of the block; arrays of vectors row by row. */
  set(name, value) {
    const member = this.members.get(name);
    const numbers = [value].flat();
    const perRow = member.count > 1 ? member.stride / 4 : numbers.length;
    numbers.forEach((number, k) => {
      const row = Math.floor(k / perRow);
      const at = member.offset + row * (member.stride ?? 0) + (k % perRow) * 4;
      if (member.type === "u32") {
        this.view.setUint32(at, number, true);
      } else {
        this.view.setFloat32(at, number, true);
      }
    });
  }
}
