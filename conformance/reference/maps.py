"""References of the library's section maps: projections of the sphere, texel solid angles, sampling
weights.

Directions (N, 3), texture coordinates (N, 2) in [0, 1]^2 unless said otherwise, scalars (N,).
"""

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from conformance.reference.ambiguous import ROUNDING, SMALLEST_NORMAL, Inputs
from conformance.reference.exact import Array, Mask, Reference, Struct, length, real, stack, unit

PARABOLIC_FLOOR = 1e-6
DENSITY_FLOOR = 1e-30


def parabolic_uv(w: Array) -> Array:
    """Image in a paraboloid mirror that looks along +z: w.xy / (1 + w.z), recentred to [0, 1]^2."""
    w = unit(w)
    return _recentred(w[..., :2] / np.maximum(1.0 + w[..., 2:], PARABOLIC_FLOOR))


def parabolic_direction(uv: Array) -> Array:
    """Inverse stereographic projection."""
    return _from_plane(2.0 * real(uv) - 1.0, np.float64(1.0))


def dual_paraboloid_uv(w: Array, border: npt.ArrayLike) -> Struct:
    """The paraboloid of the hemisphere that w is in, shrunk by the border scale; back = 1 for w.z < 0."""
    w = unit(w)
    plane = w[..., :2] / (1.0 + np.abs(w[..., 2:]))
    return {"uv": _recentred(plane / real(border)[..., None]), "back": np.where(w[..., 2] < 0.0, 1.0, 0.0)}


def dual_paraboloid_direction(uv: Array, back: Array, border: Array) -> Array:
    """Direction of a texel; beyond the unit disc the true direction across the equator."""
    sign = np.where(real(back) >= 0.5, -1.0, 1.0)
    return _from_plane((2.0 * real(uv) - 1.0) * real(border)[..., None], sign)


def dual_paraboloid_solid_angle(
    z: Array, width: npt.ArrayLike, height: npt.ArrayLike, border: npt.ArrayLike
) -> Array:
    """Solid angle of the texel that the direction with that z looks up."""
    return 4.0 * real(border) ** 2 * (1.0 + np.abs(real(z))) ** 2 / (real(width) * real(height))


def octahedral_encode(w: Array) -> Array:
    """Sphere to octahedron by the 1-norm, the lower half folded over the diagonals."""
    w = real(w)
    p = w / np.sum(np.abs(w), axis=-1, keepdims=True)
    folded = (1.0 - np.abs(p[..., 1::-1])) * _side(p[..., :2])
    return _recentred(np.where(p[..., 2:] < 0.0, folded, p[..., :2]))


def octahedral_decode(uv: Array) -> Array:
    """Octahedron to sphere."""
    return unit(_octahedron(uv))


def octahedral_solid_angle(uv: Array, size: Array) -> Array:
    """A texel of area 4 / size^2 on the plane, seen from the centre through the octahedron's face."""
    return 4.0 / (real(size) ** 2 * length(_octahedron(uv)) ** 3)


def latlong_uv(w: Array) -> Array:
    """Latitude-longitude with y up, row 0 at the top; u = 0.5 at the poles and 1 on the seam w.x = 0, w.z >
    0."""
    w = real(w)
    x, y, z = w[..., 0], w[..., 1], w[..., 2]
    # adding 0.0 turns a negative zero into a positive one: the sign of zero never decides
    u = 0.5 + np.arctan2(x + 0.0, -z + 0.0) / (2.0 * np.pi)
    u = np.where(x == 0.0, np.where(z > 0.0, 1.0, 0.5), u)
    return stack(u, np.arctan2(np.hypot(x, z), y) / np.pi)


def latlong_direction(uv: Array) -> Array:
    """Inverse of latlong_uv."""
    polar, azimuth = np.pi * real(uv)[..., 1], 2.0 * np.pi * (real(uv)[..., 0] - 0.5)
    ring = np.sin(polar)
    return stack(ring * np.sin(azimuth), np.cos(polar), -ring * np.cos(azimuth))


def latlong_solid_angle(v: Array, width: Array, height: Array) -> Array:
    """Exact area of the texel centred at row coordinate v: width of a band of cosines times its share of
    azimuth."""
    v, rows = real(v), real(height)
    v = np.minimum(v, 1.0 - v)  # exact, and sin(pi) in float64 is not 0
    # cos(pi (v - 1/2H)) - cos(pi (v + 1/2H)) by the product formula, which does not cancel
    band = 2.0 * np.sin(np.pi * v) * np.sin(np.pi / (2.0 * rows))
    return 2.0 * np.pi / real(width) * band


def cube_solid_angle(uv: Array, size: Array) -> Array:
    """Solid angle of a texel of a cube face at distance 1, small texels."""
    p = 2.0 * real(uv) - 1.0
    return 4.0 / (real(size) ** 2 * (1.0 + p[..., 0] ** 2 + p[..., 1] ** 2) ** 1.5)


def lod_from_pdf(
    pdf: Array, samples: npt.ArrayLike, texel_solid_angle: Array, lod_bias: npt.ArrayLike
) -> Array:
    """Level whose texels are as large as the solid angle 1 / (samples pdf) of one sample."""
    texels = np.maximum(real(samples) * real(pdf) * real(texel_solid_angle), DENSITY_FLOOR)
    return np.maximum(0.0, real(lod_bias) - 0.5 * np.log2(texels))


def mis_balance(samples_a: npt.ArrayLike, pdf_a: Array, samples_b: npt.ArrayLike, pdf_b: Array) -> Array:
    """Balance heuristic of strategy a (Veach 1997); 0 where neither strategy reaches the direction."""
    return _share(real(samples_a) * real(pdf_a), real(samples_b) * real(pdf_b), 1)


def mis_power(samples_a: npt.ArrayLike, pdf_a: Array, samples_b: npt.ArrayLike, pdf_b: Array) -> Array:
    """Power heuristic with exponent 2."""
    return _share(real(samples_a) * real(pdf_a), real(samples_b) * real(pdf_b), 2)


def _share(a: Array, b: Array, exponent: int) -> Array:
    """a^k / (a^k + b^k) through the ratio of the smaller to the larger."""
    large = np.maximum(a, b)
    safe = np.where(large > 0.0, large, 1.0)
    a, b = (a / safe) ** exponent, (b / safe) ** exponent
    return np.where(large > 0.0, a / np.where(large > 0.0, a + b, 1.0), 0.0)


def _recentred(plane: Array) -> Array:
    """[-1, 1]^2 to [0, 1]^2."""
    return np.asarray(plane / 2.0 + 0.5, dtype=np.float64)


def _from_plane(plane: Array, sign: Array | np.float64) -> Array:
    """Inverse stereographic projection from the pole opposite to sign * z."""
    square = np.sum(plane * plane, axis=-1)
    scale = 1.0 / (1.0 + square)
    return stack(2.0 * plane[..., 0] * scale, 2.0 * plane[..., 1] * scale, sign * (1.0 - square) * scale)


def _side(x: Array) -> Array:
    """1 for x >= 0, else -1."""
    return np.where(x >= 0.0, 1.0, -1.0)


def _octahedron(uv: Array) -> Array:
    """The point of the octahedron |x| + |y| + |z| = 1 that a texture coordinate folds to."""
    p = 2.0 * real(uv) - 1.0
    z = 1.0 - np.abs(p[..., 0]) - np.abs(p[..., 1])
    folded = (1.0 - np.abs(p[..., ::-1])) * _side(p)
    return stack(*(np.where(z < 0.0, folded[..., k], p[..., k]) for k in (0, 1)), z)


def flushed_component(inputs: Inputs) -> Mask:
    """A subnormal component may be flushed to zero, and its sign chooses the hemisphere or the side of a
    seam."""
    w = np.abs(real(inputs["w"]))
    return np.asarray(np.any((w > 0.0) & (w < SMALLEST_NORMAL), axis=-1), dtype=np.bool_)


def flushed_products(inputs: Inputs) -> Mask:
    """Both samples * density may be flushed to zero, and then neither strategy reaches the direction."""
    products = [real(inputs[f"samples_{k}"]) * real(inputs[f"pdf_{k}"]) for k in "ab"]
    larger = np.maximum(*products)
    return np.asarray((larger > 0.0) & (larger <= 2.0 * SMALLEST_NORMAL), dtype=np.bool_)


def between_faces(inputs: Inputs) -> Mask:
    """`back` at 1/2 names no hemisphere."""
    return np.asarray(np.abs(real(inputs["back"]) - 0.5) <= ROUNDING, dtype=np.bool_)


def environment_latlong(environment: Sequence[Array], w: Array, lod: Array) -> Array:
    """Trilinear lookup of a direction in a latitude-longitude map; its levels are arrays (h, w, 4)."""
    held = np.clip(real(lod), 0.0, len(environment) - 1)
    below = np.floor(held).astype(int)
    above = np.minimum(below + 1, len(environment) - 1)
    uv = latlong_uv(w)
    found = [_bilinear(real(level)[..., :3], uv) for level in environment]
    lanes = np.arange(len(held))
    share = (held - below)[:, None]
    stacked = np.stack(found)
    return real((1.0 - share) * stacked[below, lanes] + share * stacked[above, lanes])


def _bilinear(texels: Array, uv: Array) -> Array:
    """Weights 1 - |distance| of the texel centres about a place; the map repeats in u and ends in v."""
    height, width = texels.shape[:2]
    x, y = uv[..., 0] * width - 0.5, uv[..., 1] * height - 0.5
    total = np.zeros((len(uv), texels.shape[2]))
    for i, j in ((0, 0), (1, 0), (0, 1), (1, 1)):
        column, row = np.floor(x).astype(int) + i, np.floor(y).astype(int) + j
        weight = (1.0 - np.abs(x - column)) * (1.0 - np.abs(y - row))
        total += weight[:, None] * texels[np.clip(row, 0, height - 1), column % width]
    return total


AMBIGUOUS: dict[str, Callable[[Inputs], Mask]] = {
    "dual_paraboloid_uv": flushed_component,
    "octahedral_encode": flushed_component,
    "latlong_uv": flushed_component,
    "dual_paraboloid_direction": between_faces,
    "mis_balance": flushed_products,
    "mis_power": flushed_products,
}

REFERENCES: dict[str, Reference] = {
    f.__name__: f
    for f in (
        parabolic_uv, parabolic_direction, dual_paraboloid_uv, dual_paraboloid_direction,
        dual_paraboloid_solid_angle, octahedral_encode, octahedral_decode, octahedral_solid_angle, latlong_uv,
        latlong_direction, latlong_solid_angle, cube_solid_angle, lod_from_pdf, mis_balance, mis_power,
        environment_latlong,
    )
}  # fmt: skip
