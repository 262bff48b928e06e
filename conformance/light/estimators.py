"""Estimators of int L f cos dw: quadrature, grid, Monte Carlo, filtered, guarded, with the map's samples.

Each takes an environment, views and a lobe and gives (n, 3) radiances. Samples of density 0 contribute 0 and
count.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from codegen.maps import latlong
from conformance.light.environment import Environment, MapSampler
from conformance.light.lobes import Lobe, View
from conformance.reference.maps import lod_from_pdf, mis_balance, mis_power
from conformance.reference.sampling import hammersley

Array = npt.NDArray[np.float64]
Estimator = Callable[[Environment, View, Lobe, Array], Array]

SHARP = 0.5
"""Level of detail at the peak below which filtering is left out: samples then lie closer than half a texel's
blur, and what filtering adds is error (measured: exponent 1000, 40 samples)."""


def sequence(count: int) -> Array:
    """The first `count` points of the Hammersley set of that size, (count, 2)."""
    return np.asarray(hammersley(np.arange(count, dtype=np.uint32), np.full(count, count, np.uint32)))


def quadrature(environment: Environment, view: View, lobe: Lobe) -> Array:
    """The sum over every texel of the map: what the others estimate."""
    found = []
    for k in range(len(view)):
        local = view.to_local(k, environment.directions)
        found.append(lobe.value(local, view.v[k]) @ environment.energy)
    return np.stack(found)


def grid(environment: Environment, view: View, lobe: Lobe, rows: int, *, weighted: bool = True) -> Array:
    """Fixed directions: the map box-filtered to `rows` rows of latitude, with its solid angles as weights.

    weighted  False leaves the solid angles out, as the lecture does: every direction counts alike
    """
    image = next(level for level in environment.halved if level.shape[0] <= rows)
    directions = latlong.directions(*image.shape[:2]).reshape(-1, 3)
    angles = np.repeat(latlong.solid_angles(*image.shape[:2]), image.shape[1])
    if not weighted:
        angles = np.full(len(angles), 4.0 * np.pi / len(angles))
    energy = image.reshape(-1, 3) * angles[:, None]
    return np.stack([lobe.value(view.to_local(k, directions), view.v[k]) @ energy for k in range(len(view))])


@dataclass(frozen=True)
class Samples:
    """Samples of a lobe at n places: world directions (n, m, 3), densities and values over these (n, m)."""

    world: Array
    pdf: Array
    weight: Array

    @property
    def count(self) -> int:
        """How many at each place."""
        return int(self.pdf.shape[1])


def drawn(view: View, lobe: Lobe, u: Array) -> Samples:
    """The lobe's samples for points u: (m, 2) for every place, or (n, m, 2) for each its own."""
    pairs = np.broadcast_to(u, (len(view), *u.shape[-2:]))
    local = lobe.sample(pairs, view.v[:, None, :])
    pdf, value = lobe.pdf(local, view.v[:, None, :]), lobe.value(local, view.v[:, None, :])
    weight = np.where(pdf > 0.0, value / np.where(pdf > 0.0, pdf, 1.0), 0.0)
    return Samples(view.to_world(local), pdf, weight)


def peak(view: View, lobe: Lobe) -> Samples:
    """The sample at the lobe's peak, where it lies densest."""
    return drawn(view, lobe, np.zeros((1, 2)))


def mean(environment: Environment, samples: Samples, lod: npt.ArrayLike = 0.0) -> Array:
    """The mean of weighted radiance over the samples of each place."""
    return np.asarray((environment.radiance(samples.world, lod) * samples.weight[..., None]).mean(axis=1))


def levels(environment: Environment, samples: Samples, count: int, bias: float = 0.0) -> Array:
    """The level whose texels are as large as a sample's share of the lobe, one of `count` samples."""
    texels = environment.texel_solid_angle(samples.world[..., 2])
    return lod_from_pdf(samples.pdf, count, texels, bias)


def guarded_levels(environment: Environment, samples: Samples, densest: Samples) -> Array:
    """The same, but 0 at places where a sample at the lobe's peak would look up less than level SHARP."""
    lowest = levels(environment, densest, samples.count)
    return np.where(lowest < SHARP, 0.0, levels(environment, samples, samples.count))


def plain(environment: Environment, view: View, lobe: Lobe, u: Array) -> Array:
    """Importance sampling of the lobe at the largest level: unbiased but for the map's resampling."""
    return mean(environment, drawn(view, lobe, u))


def filtered(environment: Environment, view: View, lobe: Lobe, u: Array, bias: float = 0.0) -> Array:
    """Colbert and Krivanek 2007: each sample looks up the level whose texel is as large as its share."""
    samples = drawn(view, lobe, u)
    return mean(environment, samples, levels(environment, samples, samples.count, bias))


def guarded(environment: Environment, view: View, lobe: Lobe, u: Array) -> Array:
    """Filtered, but plain where a sample at the lobe's peak would look up less than level SHARP."""
    samples = drawn(view, lobe, u)
    return mean(environment, samples, guarded_levels(environment, samples, peak(view, lobe)))


def combined(
    environment: Environment,
    view: View,
    lobe: Lobe,
    u: Array,
    others: Array,
    sampler: MapSampler,
    *,
    power: bool = False,
) -> Array:
    """Samples of the lobe and of the map together, by the balance or power heuristic, unfiltered.

    u       (n, 2) points of the lobe's samples, or as many for each view; none: the map's alone
    others  (m, 2) points of the map's samples; none: plain importance sampling of the lobe
    """
    return together(environment, view, lobe, drawn(view, lobe, u), others, sampler, power=power)


def together(
    environment: Environment,
    view: View,
    lobe: Lobe,
    own: Samples,
    others: Array,
    sampler: MapSampler,
    *,
    power: bool = False,
) -> Array:
    """The same with samples of the lobe that are drawn already.

    The map's samples are the same for every view, so an engine can bake them.
    """
    ours, theirs = own.count, len(others)
    share_of = mis_power if power else mis_balance
    total = np.zeros((len(view), 3))
    if ours:
        share = share_of(ours, own.pdf, theirs, sampler.pdf(own.world))
        total += mean(environment, replace(own, weight=own.weight * share))
    if theirs:
        world = sampler.sample(others)
        local = np.stack([view.to_local(k, world) for k in range(len(view))])
        density = np.broadcast_to(sampler.pdf(world), local.shape[:2])
        share = share_of(theirs, density, ours, lobe.pdf(local, view.v[:, None, :]))
        value = lobe.value(local, view.v[:, None, :])
        weight = np.where(density > 0.0, value * share / np.where(density > 0.0, density, 1.0), 0.0)
        total += (environment.radiance(world)[None] * weight[..., None]).mean(axis=1)
    return total


def halves(count: int) -> tuple[Array, Array]:
    """Points for that many samples in all, half of the lobe and half of the map."""
    ours = max(count // 2, 1)
    return sequence(ours), sequence(max(count - ours, 1))


def rms(estimate: Array, truth: Array) -> float:
    """Root of the mean square error over that of the truth, over views and channels."""
    size = float((truth**2).mean())
    return (
        float(np.sqrt(((estimate - truth) ** 2).mean() / size))
        if size > 0.0
        else float(np.abs(estimate).max())
    )
