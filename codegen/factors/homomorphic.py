"""Homomorphic factorisation: f(l, v) = scale p(v) q(h) p(l), fitted as a sum of logarithms.

McCool, Ang and Ahmad 2001, Homomorphic Factorization of BRDFs for High-Performance Rendering: sparse linear
least squares minimise the relative error, smoothness fills texels that no sample reaches, and all factors
come out positive. One factor more, r, follows two angles: of light and viewer along the tangent x, for lobes
of a strand, or about it, for cloth whose threads hide each other. Without it no number of texels fits these.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.linalg import lsmr

from codegen.errors import UserError, unknown
from codegen.factors.grids import bends, rows, taps
from codegen.factors.samples import FEWEST, Samples
from codegen.maps.bilinear import lookup

Array = npt.NDArray[np.float64]
SIZES = (2, 512)
ANGLES = ("along", "across")
"""What r follows: asin(w.x), as `strand_table_uv`, or atan2(w.y, w.z), as `factored_satin_shade`."""
ITERATIONS = 250
"""With columns of one length; 600 are not enough without."""


@dataclass(frozen=True)
class Settings:
    """Texels along a side of p, q, r (0: no r), the weight of smoothness, the smallest value that counts.

    floor     relative to the largest value: smaller ones are fitted as this, or the logarithm of what nobody
              sees would rule the fit
    angles    which two angles r follows, one of ANGLES
    emphasis  0: every sample's relative error counts alike; 1: the error of what is seen, value times l.z
    """

    size_p: int = 16
    size_q: int = 32
    size_r: int = 0
    smoothness: float = 0.05
    floor: float = 1e-4
    angles: str = "along"
    emphasis: float = 0.0


@dataclass(frozen=True)
class Factors:
    """scale (channels,), p and q (size, size, channels) over parabolic maps, r over two angles or None.

    The ends of r's axes are the centres of its outermost texels.
    """

    scale: Array
    p: Array
    q: Array
    r: Array | None = None
    angles: str = "along"

    def value(self, l: npt.ArrayLike, v: npt.ArrayLike) -> Array:  # the library's name
        """scale p(v) q(h) p(l) r(angles) of unit directions (n, 3), (n, channels); no cosine."""
        to_light, to_viewer = np.asarray(l, np.float64), np.asarray(v, np.float64)
        found = self.scale * lookup(self.p, parabolic_uv(to_viewer)) * lookup(self.p, parabolic_uv(to_light))
        found = found * lookup(self.q, parabolic_uv(half_vector(to_light, to_viewer)))
        if self.r is not None:
            found = found * lookup(self.r, angles_uv(to_light, to_viewer, self.angles, len(self.r)))
        return np.asarray(found)


@dataclass(frozen=True)
class FitError:
    """Errors against samples, of all channels.

    rms     root of the mean square over the mean
    seen    the same of value times l.z, what a shader adds up
    median, p95, largest  relative errors
    """

    rms: float
    seen: float
    median: float
    p95: float
    largest: float
    samples: int


def parabolic_uv(w: Array) -> Array:
    """Coordinates of directions above the surface, as `parabolic_uv` of the library."""
    return np.asarray(w[..., :2] / np.maximum(1.0 + w[..., 2:], 1e-6) * 0.5 + 0.5)


def half_vector(l: Array, v: Array) -> Array:  # the library's name
    """The direction halfway; above the surface l + v never vanishes unless both graze from opposite sides."""
    h = l + v
    length = np.linalg.norm(h, axis=-1, keepdims=True)
    return np.asarray(np.where(length > 1e-12, h / np.maximum(length, 1e-12), [0.0, 0.0, 1.0]))


def angles_uv(l: Array, v: Array, angles: str, size: int) -> Array:  # the library's name
    """Coordinates of two angles in a table of that size: 0 and 1 are the centres of its outermost texels."""
    w = np.stack([l, v], axis=-2)
    along = angles == "along"
    turn = np.arcsin(np.clip(w[..., 0], -1.0, 1.0)) if along else np.arctan2(w[..., 1], w[..., 2])
    return np.asarray((np.clip(turn / np.pi + 0.5, 0.0, 1.0) * (size - 1) + 0.5) / size)


def factorise(samples: Samples, settings: Settings = Settings()) -> Factors:  # frozen
    """Fit the factors to samples; every channel by itself, missing values left out.

    raises  UserError for settings out of range, or too few values above 0
    """
    _check(settings)
    known = samples.known()
    if len(known) < FEWEST:
        raise UserError(f"{len(known)} samples have a value above 0; a fit needs {FEWEST}")
    matrix, sizes = _matrix(known, settings)
    log = np.log(np.maximum(known.value, settings.floor * known.value.max(axis=0)))
    padded, weight = np.zeros(matrix.shape[0]), np.ones(matrix.shape[0])
    solutions = []
    for channel, weights in zip(log.T, _weights(known, log, settings.emphasis).T, strict=True):
        weight[: len(channel)] = weights
        padded[: len(channel)] = weights * channel
        weighted = sparse.diags_array(weight) @ matrix
        lengths = np.sqrt(np.asarray(weighted.multiply(weighted).sum(axis=0)).ravel())
        lengths[lengths == 0.0] = 1.0  # a texel of a grid of 2 x 2 that no sample reaches
        scaled = weighted @ sparse.diags_array(1.0 / lengths)
        found = lsmr(scaled, padded, atol=1e-8, btol=1e-8, maxiter=ITERATIONS)[0]
        solutions.append(found / lengths)
    images = _images(np.stack(solutions, axis=-1), sizes)
    return _normalised(images, settings.angles)


def error(factors: Factors, samples: Samples, floor: float = Settings.floor) -> FitError:
    """How far the factors are from samples that have a value.

    floor  relative errors are relative to the value, but at least to this part of the largest one
    """
    known = samples.known()
    got = factors.value(known.l, known.v)
    off, cosine = got - known.value, known.l[:, 2:]
    relative = np.abs(off) / np.maximum(known.value, floor * known.value.max())
    return FitError(
        rms=float(np.sqrt((off**2).mean()) / known.value.mean()),
        seen=float(np.sqrt(((off * cosine) ** 2).mean()) / (known.value * cosine).mean()),
        median=float(np.median(relative)),
        p95=float(np.quantile(relative, 0.95)),
        largest=float(relative.max()),
        samples=len(known),
    )


def _check(settings: Settings) -> None:
    for name, size in (("p", settings.size_p), ("q", settings.size_q), ("r", settings.size_r or 2)):
        if not SIZES[0] <= size <= SIZES[1]:
            raise UserError(
                f"factor {name}: {size} texels along a side; there can be {SIZES[0]} to {SIZES[1]}"
            )
    if not settings.smoothness > 0.0:
        raise UserError(
            f"smoothness {settings.smoothness:g}: it must be above 0, or texels without samples float"
        )
    if settings.angles not in ANGLES:
        raise unknown("angles of r", settings.angles, ANGLES)
    if not 0.0 <= settings.emphasis <= 1.0:
        raise UserError(f"emphasis {settings.emphasis:g}: it is in [0, 1], from relative to absolute error")


def _weights(samples: Samples, log: Array, emphasis: float) -> Array:
    """What the rows of the samples count, (n, channels), 1 in the mean of squares."""
    seen = (np.exp(log) * np.maximum(samples.l[:, 2:], 1e-6)) ** emphasis
    return np.asarray(seen / np.sqrt((seen**2).mean(axis=0)))


def _matrix(samples: Samples, settings: Settings) -> tuple[sparse.csr_array, list[int]]:
    """Rows of samples, then of smoothness; columns of p, q and r."""
    sizes = [settings.size_p, settings.size_q] + ([settings.size_r] if settings.size_r else [])
    p = rows(taps(parabolic_uv(samples.v), sizes[0]), sizes[0])
    p = p + rows(taps(parabolic_uv(samples.l), sizes[0]), sizes[0])
    blocks = [p, rows(taps(parabolic_uv(half_vector(samples.l, samples.v)), sizes[1]), sizes[1])]
    if settings.size_r:
        turns = angles_uv(samples.l, samples.v, settings.angles, sizes[2])
        blocks.append(rows(taps(turns, sizes[2]), sizes[2]))
    # One unit of smoothness weighs as much as the samples that a texel has on average.
    smooth = []
    for size in sizes:
        weight = settings.smoothness * np.sqrt(len(samples) / size**2)
        smooth.append(bends(size) * weight)
    smoothness = sparse.block_diag(smooth, format="csr")
    return sparse.csr_array(sparse.vstack([sparse.hstack(blocks), smoothness])), sizes


def _images(solution: Array, sizes: list[int]) -> list[Array]:
    """The logarithms of the factors as images (size, size, channels)."""
    ends = np.cumsum([size**2 for size in sizes])
    parts = np.split(solution, ends[:-1])
    return [part.reshape(size, size, -1) for part, size in zip(parts, sizes, strict=True)]


def _normalised(logs: list[Array], angles: str) -> Factors:
    """Factors whose largest texel is 1 in each channel; p counts twice in the scale."""
    peaks = [image.max(axis=(0, 1)) for image in logs]
    p, q, *r = (np.exp(image - peak) for image, peak in zip(logs, peaks, strict=True))
    scale = np.exp(2.0 * peaks[0] + sum(peaks[1:]))
    return Factors(np.asarray(scale), p, q, r[0] if r else None, angles)
