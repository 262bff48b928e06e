"""Prefiltered maps: the radiance convolved with an isotropic lobe, one lookup per reflection.

Kautz, Vazquez, Heidrich and Seidel 2000. Only lobes around one direction can be prefiltered so: a strand's
lobe is a cone whose width depends on the viewer.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from codegen.maps import latlong, mipmap, paraboloid

Array = npt.NDArray[np.float64]

BLOCK = (128, 2048)
"""Directions and texels that are convolved at once: their products stay in a core's cache."""
TEXELS_ACROSS = 8.0
"""Texels that a lobe is wide, at least, where a smaller level of the map is convolved instead."""


def size_for(exponent: float) -> int:
    """The map size that keeps bilinear lookups within 1 to 2 % (measured): 32 to exponent 10, 64 to 100."""
    return 32 if exponent <= 10.0 else 64 if exponent <= 100.0 else 128


def prefilter(
    pixels: npt.NDArray[np.floating],
    exponent: float,
    size: int | None = None,
    border: float = paraboloid.BORDER,
) -> Array:
    """A dual-paraboloid map of (p + 1) / (2 pi) int L max(0, w.r)^p dw, (2, size, size, channels)."""
    size = size or size_for(exponent)
    s, t = paraboloid.points(size, border)
    discs = [paraboloid.directions(s, t, side) for side in (paraboloid.FRONT, paraboloid.BACK)]
    flat = convolved(pixels, exponent, np.stack(discs).reshape(-1, 3))
    return flat.reshape(2, size, size, -1)


def convolved(pixels: npt.NDArray[np.floating], exponent: float, r: npt.ArrayLike) -> Array:
    """(p + 1) / (2 pi) int L max(0, w.r)^p dw about the directions r, (n, channels): sum over texels."""
    directions = np.asarray(r, np.float64)
    radiance, w = _texels(_reduced(pixels, exponent))
    out = np.zeros((len(directions), pixels.shape[2]))
    raised = _Power(exponent)
    for start in range(0, len(directions), BLOCK[0]):
        block = directions[start : start + BLOCK[0]].astype(np.float32)
        for first in range(0, len(w), BLOCK[1]):
            lobe = raised(block, w[first : first + BLOCK[1]])
            out[start : start + BLOCK[0]] += lobe @ radiance[first : first + BLOCK[1]]
    return out * ((exponent + 1.0) / (2.0 * np.pi))


class _Power:
    """max(0, r.w)^p for blocks of directions and texels, in buffers that are used again."""

    def __init__(self, exponent: float) -> None:
        self.exponent = exponent
        # Powers below 1e-30 weigh nothing, and denormal ones would cost a hundred times more than others.
        self.least = np.float32(1e-30 ** (1.0 / exponent) if exponent > 0.0 else 0.0)
        self.base, self.result = np.empty(BLOCK, np.float32), np.empty(BLOCK, np.float32)

    def __call__(self, r: npt.NDArray[np.float32], w: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        if (len(r), len(w)) != self.base.shape:
            self.base = np.empty((len(r), len(w)), np.float32)
            self.result = np.empty_like(self.base)
        np.matmul(r, w.T, out=self.base)
        if self.exponent == 0.0:  # the hemisphere, without its edge
            return np.greater(self.base, 0.0, out=self.result)
        np.clip(self.base, self.least, 1.0, out=self.base)
        if self.exponent != int(self.exponent):
            return np.power(self.base, np.float32(self.exponent), out=self.result)
        self.result.fill(1.0)
        rest = int(self.exponent)
        while rest:  # by squarings, ten times faster than a power
            if rest & 1:
                np.multiply(self.result, self.base, out=self.result)
            rest >>= 1
            if rest:
                np.multiply(self.base, self.base, out=self.base)
        return self.result


def _reduced(pixels: npt.NDArray[np.floating], exponent: float) -> npt.NDArray[np.floating]:
    """The map at the smallest size of its chain whose texels are small against the lobe.

    A lobe of exponent p is about 1/sqrt(p) wide; the clamped ones below 4 still have an edge at the horizon.
    """
    height = pixels.shape[0]
    wanted = TEXELS_ACROSS * np.pi * np.sqrt(max(exponent, 4.0))
    if height // 2 < wanted:
        return pixels
    fitting = [level for level in mipmap.by_solid_angle(pixels) if level.shape[0] >= wanted]
    return fitting[-1]


def _texels(pixels: npt.NDArray[np.floating]) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
    """Radiance times solid angle (n, channels) and directions (n, 3) of all texels."""
    height, width, channels = pixels.shape
    weighted = pixels * latlong.solid_angles(height, width)[:, None, None]
    flat = latlong.directions(height, width).reshape(-1, 3)
    return weighted.reshape(-1, channels).astype(np.float32), flat.astype(np.float32)
