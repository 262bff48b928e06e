"""References of factored reflectances and of tables over two angles.

Maps are chains of levels (h, w, 4), of which only the largest is read; texel (i, j) of w by h lies at
((i + 1/2) / w, (j + 1/2) / h), and the outermost texels go on beyond the edges. Directions (N, 3) in the
local frame, cosines (N,).
"""

from collections.abc import Callable, Sequence

import numpy as np

from conformance.reference.ambiguous import SMALLEST_NORMAL, Inputs, nearly_opposite
from conformance.reference.direction import half_vector
from conformance.reference.exact import Array, Mask, Reference, real, stack
from conformance.reference.maps import parabolic_uv


def strand_table_uv(cos_l: Array, cos_v: Array) -> Array:
    """Angles to the plane across the strand, -90 to 90 degrees, as coordinates from 0 to 1."""
    return stack(*(np.arcsin(real(c)) / np.pi + 0.5 for c in (cos_l, cos_v)))


def strand_cosine_table(table: Sequence[Array], cos_l: Array, cos_v: Array) -> Array:
    """The first channel of a table whose outermost texel centres are the ends of the axes."""
    return np.asarray(_from_end_to_end(table, strand_table_uv(cos_l, cos_v))[:, 0])


def factored_shade(p: Sequence[Array], q: Sequence[Array], l: Array, v: Array, scale: Array) -> Array:
    """scale p(v) q(h) p(l) max(l.z, 0) with both factors over the paraboloid of z."""
    factors = [_lookup(p, parabolic_uv(w)) for w in (v, l)] + [_lookup(q, parabolic_uv(half_vector(l, v)))]
    cosine = np.maximum(real(l)[:, 2:], 0.0)
    return np.asarray(real(scale) * factors[0] * factors[1] * factors[2] * cosine)


def factored_strand_shade(
    p: Sequence[Array], q: Sequence[Array], r: Sequence[Array], l: Array, v: Array, scale: Array
) -> Array:
    """The same with a factor of the cosines with the tangent x."""
    along = _from_end_to_end(r, strand_table_uv(real(l)[:, 0], real(v)[:, 0]))
    return np.asarray(factored_shade(p, q, l, v, scale) * along)


def factored_satin_shade(
    p: Sequence[Array], q: Sequence[Array], r: Sequence[Array], l: Array, v: Array, scale: Array
) -> Array:
    """The same with a factor of the angles about the tangent x, from the horizon at -y to that at y."""
    # adding 0.0 turns a negative zero into a positive one: along the tangent the angle is 0
    angles = stack(*(np.arctan2(real(w)[:, 1] + 0.0, real(w)[:, 2] + 0.0) for w in (l, v)))
    around = _from_end_to_end(r, np.clip(angles / np.pi + 0.5, 0.0, 1.0))
    return np.asarray(factored_shade(p, q, l, v, scale) * around)


def _from_end_to_end(table: Sequence[Array], share: Array) -> Array:
    height, width = table[0].shape[:2]
    return _at(table, np.asarray(share) * (width - 1, height - 1))


def _lookup(levels: Sequence[Array], uv: Array) -> Array:
    height, width = levels[0].shape[:2]
    return _at(levels, np.asarray(uv) * (width, height) - 0.5)


def _at(levels: Sequence[Array], place: Array) -> Array:
    """The first three channels at places in texels from the centre of the first one, (N, 3)."""
    texels = real(levels[0])[..., :3]
    height, width = texels.shape[:2]
    total = np.zeros((len(place), 3))
    # A texel counts by how much of a square of its own size about the place covers it.
    for i, j in ((0, 0), (1, 0), (0, 1), (1, 1)):
        column, row = np.floor(place[:, 0]) + i, np.floor(place[:, 1]) + j
        weight = (1.0 - np.abs(place[:, 0] - column)) * (1.0 - np.abs(place[:, 1] - row))
        inside = np.clip(row, 0, height - 1).astype(int), np.clip(column, 0, width - 1).astype(int)
        total += weight[:, None] * texels[inside]
    return total


def opposite(inputs: Inputs) -> Mask:
    """The half vector of opposite directions is one or the other."""
    return nearly_opposite(inputs["l"], inputs["v"])


def opposite_or_below(inputs: Inputs) -> Mask:
    """The same, and viewers straight below the threads, whose side a flushed component decides."""
    v = real(inputs["v"])
    side = np.abs(v[:, 1])
    below = (v[:, 2] < 0.0) & (side > 0.0) & (side < SMALLEST_NORMAL)
    return np.asarray(opposite(inputs) | below, dtype=np.bool_)


AMBIGUOUS: dict[str, Callable[[Inputs], Mask]] = {
    "factored_shade": opposite,
    "factored_strand_shade": opposite,
    "factored_satin_shade": opposite_or_below,
}

REFERENCES: dict[str, Reference] = {
    f.__name__: f
    for f in (
        strand_table_uv, strand_cosine_table, factored_shade, factored_strand_shade, factored_satin_shade,
    )
}  # fmt: skip
