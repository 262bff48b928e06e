"""An environment as the estimators see it: all texels for quadrature, a dual-paraboloid chain for lookups.

Latitude-longitude texels with their exact solid angles;
256 x 256 x 2 paraboloid texels with border 1.2, plain 2 x 2 means, trilinear lookups clamped to the edge.
"""

from __future__ import annotations

from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

from codegen.maps import bilinear, latlong, mipmap, paraboloid
from codegen.maps.radiance import LUMINANCE, read_radiance
from conformance.reference.maps import dual_paraboloid_solid_angle, dual_paraboloid_uv

Array = npt.NDArray[np.float64]


class Environment:
    """Radiance of every direction; directions (n, 3), energy (n, 3) = radiance times solid angle."""

    def __init__(
        self,
        pixels: npt.NDArray[np.floating],
        size: int = paraboloid.SIZE,
        border: float = paraboloid.BORDER,
        weighted: bool = False,
    ) -> None:
        height, width = pixels.shape[:2]
        self.pixels = np.asarray(pixels, np.float64)
        self.size, self.border = size, border
        self.directions = latlong.directions(height, width).reshape(-1, 3)
        self.energy = (self.pixels * latlong.solid_angles(height, width)[:, None, None]).reshape(-1, 3)
        weights = paraboloid.solid_angles(size, border) if weighted else None
        chains = [mipmap.chain(disc, weights) for disc in paraboloid.from_latlong(pixels, size, border)]
        self.levels = [np.stack(pair) for pair in zip(*chains, strict=True)]

    @cached_property
    def halved(self) -> list[Array]:
        """The latitude-longitude map at every size, weighted by solid angle."""
        return mipmap.by_solid_angle(self.pixels)

    @classmethod
    def read(cls, path: Path, *, weighted: bool = False) -> Environment:
        """The environment of a file; values that are no radiance are mended."""
        return cls(read_radiance(path, clean=True), weighted=weighted)

    def texel_solid_angle(self, z: Array) -> Array:
        """Solid angle of a texel of the largest level where it shows the direction w, z = w.z."""
        return dual_paraboloid_solid_angle(z, self.size, self.size, self.border)

    def radiance(self, w: Array, lod: npt.ArrayLike = 0.0) -> Array:
        """Trilinear lookups of directions (..., 3) at levels of detail (...), (..., 3)."""
        place = dual_paraboloid_uv(w, self.border)
        uv, face = place["uv"], place["back"].astype(np.int64)
        lods = np.broadcast_to(np.clip(lod, 0.0, len(self.levels) - 1.0), face.shape)
        lower = np.minimum(np.floor(lods), max(len(self.levels) - 2, 0)).astype(np.int64)
        upper_share = (lods - lower)[..., None]
        out = np.zeros(w.shape)
        for k in np.unique(lower):
            here = lower == k
            fine = self._bilinear(int(k), face[here], uv[here])
            coarse = self._bilinear(min(int(k) + 1, len(self.levels) - 1), face[here], uv[here])
            out[here] = fine * (1.0 - upper_share[here]) + coarse * upper_share[here]
        return out

    def _bilinear(self, level: int, face: npt.NDArray[np.int64], uv: Array) -> Array:
        out = np.zeros((len(uv), self.levels[level].shape[-1]))
        for k, image in enumerate(self.levels[level]):
            out[face == k] = bilinear.lookup(image, uv[face == k])
        return out


class NearestTexel(Environment):
    """The same map, looked up in its latitude-longitude texels without any filter."""

    def radiance(self, w: Array, lod: npt.ArrayLike = 0.0) -> Array:
        """The texel that each direction (..., 3) lies in, whatever the level."""
        height, width = self.pixels.shape[:2]
        uv = latlong.coordinates(w)
        column = np.minimum((uv[..., 0] * width).astype(np.int64), width - 1)
        row = np.minimum((uv[..., 1] * height).astype(np.int64), height - 1)
        return np.asarray(self.pixels[row, column])


class MapSampler:
    """Directions in proportion to a map's luminance: a texel by inverse distribution, uniform within it."""

    def __init__(self, environment: Environment) -> None:
        luminance = (environment.energy @ LUMINANCE).reshape(environment.pixels.shape[:2])
        total = luminance.sum()
        self.shape = luminance.shape
        self.share = luminance / total if total > 0.0 else np.full(self.shape, 1.0 / luminance.size)
        self.rows = np.cumsum(self.share.sum(axis=1))
        self.columns = np.cumsum(self.share, axis=1)

    def sample(self, u: Array) -> Array:
        """Directions (n, 3) of pairs (n, 2): u.y chooses the row, u.x the column."""
        height, width = self.shape
        target = u[:, 1] * self.rows[-1]
        row = np.minimum(np.searchsorted(self.rows, target, side="right"), height - 1)
        y = row + _within(np.broadcast_to(self.rows, (len(u), height)), row, target)
        columns = self.columns[row]
        aim = u[:, 0] * columns[:, -1]
        column = np.minimum((columns <= aim[:, None]).sum(axis=1), width - 1)
        x = column + _within(columns, column, aim)
        theta, phi = np.pi * y / height, 2.0 * np.pi * (x / width - 0.5)
        return np.stack([np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi)], axis=-1)

    def pdf(self, w: Array) -> Array:
        """Density per steradian of directions (..., 3): P(texel) W H / (2 pi^2 sin(pi v))."""
        height, width = self.shape
        uv = latlong.coordinates(w)
        column = np.minimum((uv[..., 0] * width).astype(np.int64), width - 1)
        row = np.minimum((uv[..., 1] * height).astype(np.int64), height - 1)
        sine = np.maximum(np.sin(np.pi * uv[..., 1]), 1e-9)
        return np.asarray(self.share[row, column] * height * width / (2.0 * np.pi**2 * sine))


def _within(running: Array, index: npt.NDArray[np.int64], target: Array) -> Array:
    """Where between a row's running sums before and at `index` the target lies, in [0, 1)."""
    every = np.arange(len(index))
    before = np.where(index > 0, running[every, np.maximum(index - 1, 0)], 0.0)
    step = running[every, index] - before
    part = (target - before) / np.where(step > 0.0, step, 1.0)
    return np.asarray(np.clip(part, 0.0, 1.0 - 1e-12))
