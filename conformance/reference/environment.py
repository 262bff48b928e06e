"""References of section environment: lookups in a map, and its light as reflected by each lobe.

A map is a list of levels (h, w, 4), the largest first: the disc around +z in the left half of each, that
around -z in the right half, border 1.2. Directions (N, 3), levels of detail (N,), frames of (N, 3) axes.
"""

from collections.abc import Callable, Sequence

import numpy as np

from conformance.reference.direction import to_local, to_world
from conformance.reference.exact import Array, Reference, Struct, real, unit
from conformance.reference.lobes import LOBES, reference_of
from conformance.reference.maps import latlong_direction, latlong_solid_angle
from conformance.reference.sampling import cranley_patterson, hammersley

Map = Sequence[Array]

BORDER = 1.2
MOST_SAMPLES = 4096
SHARP = 0.5
"""The level of a lobe's peak below which the guarded estimator does not filter."""
WHOLE_SPHERE = ("strand",)
"""Lobes without a cosine."""
DENSITY_FLOOR = 1e-30
BLEND_HEIGHT = 0.18
"""Height above the rim up to which both discs show a direction, at most."""


def env_radiance(env: Map, w: Array, lod: Array) -> Array:
    """Trilinear lookup, clamped to the edges of each disc's square; both discs blended about the rim.

    The blend goes over the width of one texel, or over what the border shows if that is less.
    """
    w = unit(w)
    size = env[0].shape[0]
    held = np.clip(real(lod), 0.0, np.log2(size))
    below = np.floor(held).astype(int)
    out = np.zeros(w.shape)
    for k in np.unique(below):
        here = below == k
        share = (held - k)[here, None]
        out[here] = (1.0 - share) * _level(env, w[here], k) + share * _level(env, w[here], k + 1)
    return out


def env_prefiltered(env: Map, w: Array) -> Array:
    """One bilinear lookup in a map that has been convolved with a lobe."""
    return _level(env, unit(w), 0)


def _level(env: Map, w: Array, k: int) -> Array:
    """One level; the largest in which one texel is as wide as the disc is the last."""
    texel = 2.0**k / env[0].shape[0]
    level = real(env[min(k, len(env) - 1)])[..., :3]
    width = level.shape[1]
    discs = (level[:, : max(width // 2, 1)], level[:, width // 2 :])
    height = w[:, 2:]
    front = np.clip(0.5 + 0.5 * height / min(BORDER * texel, BLEND_HEIGHT), 0.0, 1.0)
    out = np.zeros(w.shape)
    for disc, side, share in zip(discs, (1.0, -1.0), (front, 1.0 - front), strict=True):
        seen = share[:, 0] > 0.0
        place = w[seen, :2] / (1.0 + side * height[seen]) / BORDER / 2.0 + 0.5
        out[seen] += share[seen] * _bilinear(disc, place)
    return out


def _bilinear(texels: Array, uv: Array) -> Array:
    """Weights 1 - |distance| of the texel centres about a place, which ends with the outer centres."""
    height, width = texels.shape[:2]
    x = np.clip(uv[:, 0] * width - 0.5, 0.0, width - 1.0)
    y = np.clip(uv[:, 1] * height - 0.5, 0.0, height - 1.0)
    total = np.zeros((len(uv), texels.shape[2]))
    for i, j in ((0, 0), (1, 0), (0, 1), (1, 1)):
        column, row = np.floor(x).astype(int) + i, np.floor(y).astype(int) + j
        weight = (1.0 - np.abs(x - column)) * (1.0 - np.abs(y - row))
        total += weight[:, None] * texels[np.minimum(row, height - 1), np.minimum(column, width - 1)]
    return total


def level_of_detail(env: Map, w: Array, pdf: Array, samples: Array) -> Array:
    """Half the binary logarithm of a sample's solid angle over that of the texel there, at least 0."""
    texel = 4.0 * BORDER**2 * (1.0 + np.abs(w[..., 2])) ** 2 / env[0].shape[0] ** 2
    return real(np.maximum(0.0, -0.5 * np.log2(np.maximum(samples * pdf * texel, DENSITY_FLOOR))))


class _Estimate:
    """What the estimators share: a lobe seen from some places, and a sum that becomes a mean."""

    def __init__(
        self, lobe: str, env: Map, frame: Struct, v: Array, samples: Array, parameters: Sequence[Array]
    ) -> None:
        self.lobe, self.env, self.frame, self.parameters = lobe, env, frame, parameters
        self.viewer = to_local(frame, unit(v))
        self.limit = np.minimum(np.asarray(samples, np.int64), MOST_SAMPLES)
        self.count = np.maximum(self.limit, 1)
        self.total = np.zeros(self.viewer.shape)

    def part(self, name: str, first: Array) -> Array:
        """value, pdf or sample of the lobe."""
        return real(reference_of(self.lobe, name)(first, self.viewer, *self.parameters))

    def value(self, l: Array) -> Array:
        """Reflectance, times the cosine on a surface."""
        cosine = 1.0 if self.lobe in WHOLE_SPHERE else np.maximum(l[:, 2], 0.0)
        return real(self.part("value", l) * cosine)

    def add(self, w: Array, lod: Array, weight: Array) -> None:
        """A term of the sum."""
        self.total += weight[:, None] * env_radiance(self.env, w, lod)


def _sampled(
    lobe: str,
    find_lod: Callable[[_Estimate, Array, Array], Array],
    env: Map,
    frame: Struct,
    v: Array,
    samples: Array,
    shift: Array,
    *parameters: Array,
) -> Array:
    """(1/n) sum L f cos / pdf over rotated Hammersley points; those of no density contribute 0 and count."""
    own = _Estimate(lobe, env, frame, v, samples, parameters)
    for i in range(int(own.limit.max(initial=0))):
        u = cranley_patterson(hammersley(np.minimum(i, own.count - 1), own.count), real(shift))
        l = own.part("sample", u)
        pdf = own.part("pdf", l)
        lit = (pdf > DENSITY_FLOOR) & (i < own.limit)
        weight = np.where(lit, own.value(l) / np.where(lit, pdf, 1.0), 0.0)
        w = to_world(frame, l)
        own.add(w, find_lod(own, w, pdf), weight)
    return own.total / own.count[:, None]


def _unfiltered(own: _Estimate, w: Array, pdf: Array) -> Array:
    return np.zeros(len(w))


def _filtered(own: _Estimate, w: Array, pdf: Array) -> Array:
    return level_of_detail(own.env, w, pdf, own.count)


def _guarded(own: _Estimate, w: Array, pdf: Array) -> Array:
    """Filtered, but where the densest sample of all would look up less than level SHARP."""
    return np.where(_sharpest(own) >= SHARP, _filtered(own, w, pdf), 0.0)


def _sharpest(own: _Estimate) -> Array:
    u = np.zeros((len(own.viewer), 2))
    if own.lobe == "poulin_fournier":  # its highlight starts where the diffuse part of the samples ends
        u[:, 0] = np.minimum(1.0 - real(own.parameters[1]), 1.0 - 2.0**-24)
    peak = own.part("sample", u)
    return level_of_detail(own.env, to_world(own.frame, peak), own.part("pdf", peak), own.count)


def sharpest_level(lobe: str, env: Map, frame: Struct, v: Array, samples: Array, *parameters: Array) -> Array:
    """The level at which the densest of a lobe's samples looks up a map."""
    return _sharpest(_Estimate(lobe, env, frame, v, samples, parameters))


def _grid(
    lobe: str, env: Map, frame: Struct, v: Array, samples: Array, shift: Array, *parameters: Array
) -> Array:
    """sum L f cos dw over the centres of latitude-longitude cells, twice as many columns as rows at least.

    L is taken from the level whose texels are as large as a cell.
    """
    own = _Estimate(lobe, env, frame, v, samples, parameters)
    rows = np.maximum(np.floor(np.sqrt(own.count / 2.0)), 1.0)
    columns = np.floor(own.count / rows)
    for i in range(int(own.limit.max(initial=0))):
        row = np.floor(i / columns)
        column = i - row * columns
        inside = (row < rows) & (i < own.limit)
        height = np.where(inside, (row + 0.5) / rows, 0.5)
        w = latlong_direction(
            np.stack([np.mod((column + 0.5 + real(shift)[:, 0]) / columns, 1.0), height], -1)
        )
        angle = latlong_solid_angle(height, columns, rows)
        weight = np.where(inside, own.value(to_local(frame, w)) * angle, 0.0)
        own.add(w, level_of_detail(env, w, 1.0 / angle, np.ones(len(w))), weight)
    return own.total


def _of(lobe: str, find_lod: Callable[[_Estimate, Array, Array], Array] | None) -> Reference:
    """The reference of one lobe's estimator."""

    def estimate(
        env: Map, frame: Struct, v: Array, samples: Array, shift: Array, *parameters: Array
    ) -> Array:
        if find_lod is None:
            return _grid(lobe, env, frame, v, samples, shift, *parameters)
        return _sampled(lobe, find_lod, env, frame, v, samples, shift, *parameters)

    return estimate


ESTIMATORS = {"grid": None, "monte_carlo": _unfiltered, "filtered": _filtered, "guarded": _guarded}

REFERENCES: dict[str, Reference] = {
    "env_radiance": env_radiance,
    "env_prefiltered": env_prefiltered,
    **{f"env_{name}_{lobe}": _of(lobe, find) for name, find in ESTIMATORS.items() for lobe in LOBES},
}
