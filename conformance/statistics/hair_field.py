"""Opacity of fur by brute force: rays against random fields of truncated cones."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from conformance.statistics.evaluator import Array


@dataclass(frozen=True)
class Hairs:
    """Identical hairs on a plane z = 0: how many per area, how long, how thick at base and tip, and how they
    lean."""

    density: float
    hair_length: float
    radius_base: float
    radius_tip: float
    tangent: Array


@dataclass(frozen=True)
class Opacity:
    """Share of blocked rays, with the standard error between independent fields."""

    mean: float
    standard_error: float


def field_opacity(hairs: Hairs, v: Array, fields: int, rays: int, seed: int, patch: float = 0.5) -> Opacity:
    """Share of rays toward v, from random points of the skin, that meet a hair.

    Rays of one field are correlated, so the error is taken from the spread between fields. Hairs are rooted
    over every place from which they can reach a ray.
    """
    random = np.random.Generator(np.random.Philox(seed))
    height = hairs.hair_length * hairs.tangent[2] + hairs.radius_base
    drift = v[:2] / v[2] * height
    lean = hairs.hair_length * hairs.tangent[:2]
    margin = 4.0 * hairs.radius_base / hairs.tangent[2]
    low = np.minimum(np.minimum(drift, 0.0) - np.maximum(lean, 0.0), 0.0) - margin
    high = patch + np.maximum(np.maximum(drift, 0.0) - np.minimum(lean, 0.0), 0.0) + margin
    shares = []
    for _ in range(fields):
        count = random.poisson(hairs.density * float(np.prod(high - low)))
        roots = np.concatenate([random.uniform(low, high, (count, 2)), np.zeros((count, 1))], axis=1)
        origins = np.concatenate([random.uniform(0.0, patch, (rays, 2)), np.zeros((rays, 1))], axis=1)
        shares.append(float(np.mean(np.any(meets(origins, v, roots, hairs), axis=1))))
    return Opacity(float(np.mean(shares)), float(np.std(shares, ddof=1) / np.sqrt(fields)))


def meets(origins: Array, v: Array, roots: Array, hairs: Hairs) -> npt.NDArray[np.bool_]:
    """Which of the rays (R, 3) toward v pierce the mantle of which hairs (H, 3), as (R, H)."""
    t, slope = hairs.tangent, (hairs.radius_tip - hairs.radius_base) / hairs.hair_length
    # |d + k w|^2 across the axis equals the squared radius there, a quadratic in the ray parameter k
    along_ray = float(v @ t)
    across_ray = v - along_ray * t
    offset = origins[:, None, :] - roots[None, :, :]
    along = offset @ t
    across = offset - along[..., None] * t
    radius = hairs.radius_base + slope * along
    a = float(across_ray @ across_ray) - (slope * along_ray) ** 2
    b = across @ across_ray - slope * along_ray * radius
    c = np.einsum("rhk,rhk->rh", across, across) - radius**2
    discriminant = b * b - a * c
    root = np.sqrt(np.maximum(discriminant, 0.0))
    found = np.zeros(b.shape, dtype=np.bool_)
    for k in ((-b - root) / a, (-b + root) / a):
        place = along + k * along_ray
        found |= (discriminant >= 0.0) & (k >= 0.0) & (place >= 0.0) & (place <= hairs.hair_length)
    return found
