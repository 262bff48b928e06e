// Between linear reflectances and the sRGB colours of a colour input.

const encode = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const decode = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);

/** "#rrggbb" of three linear numbers in [0, 1]. */
export function hexOf(linear) {
  const bytes = linear.map((x) => Math.round(255 * encode(Math.min(Math.max(x, 0), 1))));
  return `#${bytes.map((byte) => byte.toString(16).padStart(2, "0")).join("")}`;
}

/** Three linear numbers of "#rrggbb". */
export function linearOf(hex) {
  return [1, 3, 5].map((at) => decode(parseInt(hex.slice(at, at + 2), 16) / 255));
}
