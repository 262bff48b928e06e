"""References of the library's section `strand`: lit curves after Banks 1994 and Kajiya and Kay 1989.

Angles are those of the given vectors, exactly: sines come from cross products of the raw inputs. Powers are
exp(p log1p(-q)) with the small quantity q formed first, because p up to 1e5 multiplies the rounding of 1 - q.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from conformance.reference.dark_side import small_powers
from conformance.reference.direction import frame_from_normal, half_vector
from conformance.reference.exact import Array, Struct, column, cosine, real, safe_unit, sine, unit
from conformance.reference.numeric import pow_one_minus, safe_smoothstep
from conformance.reference.sums import direction_sum, dot, rejection_direction

LARGEST_PATH = 1e18
"""Longest path and largest extinction that the domains admit."""
LARGEST_EXPONENT = 80.0
"""Where coat_transmittance clamps its argument (as documented)."""


def strand_angles(t: Any, l: Any, v: Any) -> Struct:
    """Cosines and sines against the tangent; 1 - strand cosine as half a sum of squares."""
    cos_l, cos_v, sin_l, sin_v = cosine(t, l), cosine(t, v), sine(t, l), sine(t, v)
    defect = 0.5 * ((sin_l - sin_v) ** 2 + (cos_l + cos_v) ** 2)
    return {"cos_l": cos_l, "cos_v": cos_v, "sin_l": sin_l, "sin_v": sin_v, "defect": defect}


def strand_diffuse(t: Any, l: Any) -> Array:
    """Sine of the angle between tangent and light."""
    return sine(t, l)


def strand_cosine(t: Any, l: Any, v: Any) -> Array:
    """Closed form of the maximum of v.r over the unit normals: sin sin - cos cos."""
    return sine(t, l) * sine(t, v) - cosine(t, l) * cosine(t, v)


def strand_cosine_banks_printed(t: Any, l: Any, v: Any) -> Array:
    """As on the lecture's slide: cos cos - sin sin."""
    return cosine(t, l) * cosine(t, v) - sine(t, l) * sine(t, v)


def strand_cosine_kajiya_printed(t: Any, l: Any, v: Any) -> Array:
    """As on the lecture's slide: cos cos + sin sin."""
    return cosine(t, l) * cosine(t, v) + sine(t, l) * sine(t, v)


def strand_cosine_brute(t: Any, l: Any, v: Any, steps: int = 64, rounds: int = 60) -> Array:
    """The definition itself: the largest v.r, r = 2 (n.l) n - l, over unit normals n orthogonal to t.

    A grid of `steps` normals over half a revolution (n and -n mirror alike), then golden-section search
    around the best of them. Slow; it exists to check the closed form.
    """
    tangent, light, view = unit(t), unit(l), unit(v)
    basis = frame_from_normal(tangent)
    first, second = basis["tangent"], basis["bitangent"]

    def mirrored(turn: Array) -> Array:
        normal = column(np.cos(turn)) * first + column(np.sin(turn)) * second
        reflected = column(2.0 * dot(normal, light)) * normal - light
        return dot(view, reflected)

    grid = np.arange(steps) * (np.pi / steps)
    values = np.stack([mirrored(np.broadcast_to(turn, tangent.shape[:-1])) for turn in grid])
    best = grid[values.argmax(axis=0)]
    low, high = best - np.pi / steps, best + np.pi / steps
    ratio = (np.sqrt(5.0) - 1.0) / 2.0
    for _ in range(rounds):
        left, right = high - ratio * (high - low), low + ratio * (high - low)
        keep_left = mirrored(left) > mirrored(right)
        low, high = np.where(keep_left, low, left), np.where(keep_left, right, high)
    return np.asarray(np.maximum(mirrored(0.5 * (low + high)), values.max(axis=0)), dtype=np.float64)


def strand_specular(t: Any, l: Any, v: Any, exponent: Any) -> Array:
    """max(0, strand cosine)^exponent; 1 everywhere for exponent 0."""
    defect = strand_angles(t, l, v)["defect"]
    value = pow_one_minus(defect, exponent)
    return small_powers(t, l, v, exponent, strand_cosine(t, l, v), value)


def strand_specular_half(t: Any, h: Any, exponent: Any) -> Array:
    """sin(t, h)^exponent (Scheuermann 2004); 1 everywhere for exponent 0, also where the sine is 0.

    Near the ridge the logarithm of the sine is half that of 1 - cos^2; away from it the sine serves better.
    """
    c, s, power = np.broadcast_arrays(cosine(t, h), sine(t, h), real(exponent))
    near_ridge = c * c < 0.5
    logarithm = np.where(
        near_ridge, 0.5 * np.log1p(-np.where(near_ridge, c * c, 0.0)), np.log(np.where(s > 0.0, s, 1.0))
    )
    with np.errstate(under="ignore"):
        value = np.exp(power * logarithm)
    return np.where(power == 0.0, 1.0, np.where(s > 0.0, value, 0.0))


def strand_azimuth_cosine(t: Any, l: Any, v: Any) -> Array:
    """Cosine of the angle between the parts of l and v orthogonal to t; 0 where l or v is parallel to t."""
    across_l, across_v = np.cross(real(t), real(l)), np.cross(real(t), real(v))
    # unit() leaves the zero vector as it is, and the product with it is the documented 0.
    return np.clip(dot(unit(across_l), unit(across_v)), -1.0, 1.0)


def inherited_shadow(n: Any, l: Any) -> Array:
    """max(n.l, 0)."""
    return np.maximum(cosine(n, l), 0.0)


def kajiya_kay_shade(
    t: Any,
    l: Any,
    v: Any,
    k_diffuse: Any,
    k_specular: Any,
    exponent: Any,
) -> Array:
    """k_diffuse sin(t, l) + k_specular max(0, strand cosine)^exponent."""
    diffuse = column(strand_diffuse(t, l)) * real(k_diffuse)
    specular = column(strand_specular(t, l, v, exponent)) * real(k_specular)
    return np.asarray(diffuse + specular, dtype=np.float64)


def banks_shade(
    t: Any,
    n: Any,
    l: Any,
    v: Any,
    k_diffuse: Any,
    k_specular: Any,
    exponent: Any,
) -> Array:
    """The same, shadowed by the surface that carries the strands: times max(n.l, 0)."""
    return column(inherited_shadow(n, l)) * kajiya_kay_shade(t, l, v, k_diffuse, k_specular, exponent)


def tangent_from_map(n: Any, t: Any, map_tangent: Any) -> Array:
    """Tangent of a brushed surface: the map's vector in the frame (T, n x T, n), flattened into the surface.

    Orthogonal to n the vector is map.x T + map.y B, whatever map.z; where both are 0 it is T. Where t is
    parallel to n, T is the tangent of frame_from_normal(n), as in frame_from_tangent.
    """
    m = real(map_tangent)
    tangent = rejection_direction(t, n, frame_from_normal(n)["tangent"])
    bitangent = np.cross(unit(n), tangent)
    return safe_unit(m[..., 0:1] * tangent + m[..., 1:2] * bitangent, tangent)


def tangent_shift(t: Any, n: Any, shift: Any) -> Array:
    """The direction of t + shift n; t where the sum is zero."""
    return safe_unit(direction_sum(t, shift, n), unit(t))


def scheuermann_shade(
    t: Any,
    n: Any,
    l: Any,
    v: Any,
    base: Any,
    primary: Any,
    primary_exponent: Any,
    primary_shift: Any,
    secondary: Any,
    secondary_exponent: Any,
    secondary_shift: Any,
    mask: Any,
) -> Array:
    """Two shifted highlights over a wrapped diffuse term (Scheuermann 2004, as public ports agree on it)."""
    h = half_vector(l, v)
    diffuse = np.clip(0.25 + 0.75 * cosine(n, l), 0.0, 1.0)

    def highlight(exponent: Any, shift: Any) -> Array:
        shifted = tangent_shift(t, n, shift)
        attenuation = safe_smoothstep(-1.0, 0.0, cosine(shifted, h))
        return attenuation * strand_specular_half(shifted, h, exponent)

    first = column(highlight(primary_exponent, primary_shift)) * real(primary)
    second = column(real(mask) * highlight(secondary_exponent, secondary_shift)) * real(secondary)
    return np.asarray(real(base) * (column(diffuse) + first + second), dtype=np.float64)


def coat_extinction(rho: Any) -> Array:
    """min(-log(1 - rho), 1e18): 1e18 for rho = 1."""
    share = real(rho)
    opaque = share >= 1.0
    return np.where(opaque, LARGEST_PATH, -np.log1p(-np.where(opaque, 0.0, share)))


def quotient_path(depth: Any, divisor: Array) -> Array:
    """depth / divisor, at most 1e18, which is also the limit for a divisor <= 0; 0 for depth 0."""
    below, through = np.broadcast_arrays(real(depth), divisor)
    blocked = through <= 0.0
    path = np.where(blocked, LARGEST_PATH, below / np.where(blocked, 1.0, through))
    return np.where(below == 0.0, 0.0, np.minimum(path, LARGEST_PATH))


def coat_path_banks(depth: Any, t: Any, l: Any) -> Array:
    """depth / sin(t, l) (Banks' slide), finite."""
    return quotient_path(depth, sine(t, l))


def coat_path_slab(depth: Any, n: Any, l: Any) -> Array:
    """depth / (n.l): the way through a plane-parallel layer, finite."""
    return quotient_path(depth, cosine(n, l))


def coat_transmittance(extinction: Any, path: Any) -> Array:
    """e^-min(extinction path, 80)."""
    return np.exp(-np.minimum(real(extinction) * real(path), LARGEST_EXPONENT))


def brushed_shade(
    n: Any,
    t: Any,
    map_tangent: Any,
    l: Any,
    v: Any,
    k_diffuse: Any,
    k_specular: Any,
    exponent: Any,
) -> Array:
    """Isidoro and Brennan 2002: the surface lit as strands along the tangent that a map gives per texel."""
    tangent = tangent_from_map(n, t, map_tangent)
    return banks_shade(tangent, n, l, v, k_diffuse, k_specular, exponent)


REFERENCES: dict[str, Callable[..., Any]] = {
    "strand_angles": strand_angles,
    "strand_diffuse": strand_diffuse,
    "strand_cosine": strand_cosine,
    "strand_cosine_banks_printed": strand_cosine_banks_printed,
    "strand_cosine_kajiya_printed": strand_cosine_kajiya_printed,
    "strand_specular": strand_specular,
    "strand_specular_half": strand_specular_half,
    "strand_azimuth_cosine": strand_azimuth_cosine,
    "inherited_shadow": inherited_shadow,
    "banks_shade": banks_shade,
    "brushed_shade": brushed_shade,
    "kajiya_kay_shade": kajiya_kay_shade,
    "tangent_from_map": tangent_from_map,
    "tangent_shift": tangent_shift,
    "scheuermann_shade": scheuermann_shade,
    "coat_extinction": coat_extinction,
    "coat_path_banks": coat_path_banks,
    "coat_path_slab": coat_path_slab,
    "coat_transmittance": coat_transmittance,
}
