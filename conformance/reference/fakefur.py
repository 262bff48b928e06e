"""References of the library's section fakefur: Goldman 1997 with the errata of the lecture put right.

Written from the paper's steps (average geometry, opacity, directional and surface attenuation, blend) and
from the slab integral, not from any shader. Scalars (N,), vectors (N, 3), structs as dicts of arrays.
"""

from collections.abc import Callable

import numpy as np

from conformance.reference.ambiguous import (
    ROUNDING,
    SMALLEST_NORMAL,
    Inputs,
    parallel_by_rounding,
    small_power,
)
from conformance.reference.exact import (
    Array,
    Mask,
    Reference,
    Struct,
    column,
    cosine,
    exact_dot,
    hermite_step,
    length,
    power,
    real,
    safe_unit,
    sine,
)

GRAZING_FLOOR = 1e-12
"""Smallest cosine between a direction and the normal that the optical depth divides by (as documented)."""
LARGEST_DEPTH = 1e9
"""Optical depth is clamped here (as documented)."""
GRAZING_NOISE = 2.0**-22
"""The cosine below which float32 cannot tell front from back."""
MEAN_FLOOR = 1e-3
"""Shortest mean tangent of a footprint (as documented)."""


def fur_hair_area(hair_length: Array, radius_base: Array, radius_tip: Array) -> Array:
    """Silhouette of a truncated cone seen from the side: a trapezoid with sides 2 r_b and 2 r_t."""
    return real(hair_length) * (2.0 * real(radius_base) + 2.0 * real(radius_tip)) / 2.0


def fur_hair_area_printed(hair_length: Array, radius_base: Array, radius_tip: Array) -> Array:
    """The lecture's a_h, which is half the silhouette area."""
    return real(hair_length) * (real(radius_base) + real(radius_tip)) / 2.0


def fur_obliquity(t: Array, n: Array, w: Array) -> Array:
    """g = sin(w, t) / (w.n), the divisor held above GRAZING_FLOOR."""
    return sine(w, t) / np.maximum(cosine(w, n), GRAZING_FLOOR)


def fur_optical_depth(density: Array, hair_area: Array, t: Array, n: Array, w: Array) -> Array:
    """Expected number of hairs that a ray along w meets: density * projected area / (w.n), at most
    LARGEST_DEPTH."""
    return np.minimum(real(density) * real(hair_area) * fur_obliquity(t, n, w), LARGEST_DEPTH)


def fur_opacity(optical_depth: Array) -> Array:
    """Probability that a Poisson field of that depth blocks a ray."""
    return -np.expm1(-real(optical_depth))


def fur_directional_attenuation(azimuth_cosine: Array, rho_reflect: Array, rho_transmit: Array) -> Array:
    """Goldman's f_dir: reflected light in front (kappa = 1), transmitted light behind (kappa = -1)."""
    kappa = real(azimuth_cosine)
    front = (1.0 + kappa) / 2.0
    return front * real(rho_reflect) + (1.0 - front) * real(rho_transmit)


def fur_surface_attenuation(n_dot_l: Array, rho_surface: Array, cos_dark: Array, cos_lit: Array) -> Array:
    """Goldman's f_surface, with the two angles given as cosines and the arguments in their right order."""
    return 1.0 + real(rho_surface) * (hermite_step(cos_dark, cos_lit, n_dot_l) - 1.0)


def fur_weights_goldman(depth_view: Array, depth_light: Array, overlap: Array) -> Struct:
    """Visibility along the view times shadow along the light; the hair itself is shadowed by a share of the
    coat."""
    seen, shaded = fur_opacity(depth_view), fur_opacity(depth_light)
    return {
        "hair": seen * (1.0 - real(overlap) * shaded),
        "skin": np.exp(-(real(depth_view) + real(depth_light))),
    }


def fur_weights_slab(depth_view: Array, depth_light: Array) -> Struct:
    """Single scattering in a uniform slab: int_0^1 x_v exp(-(x_v + x_l) s) ds, in closed form."""
    view = real(depth_view)
    both = view + real(depth_light)
    mean = np.where(both > 0.0, -np.expm1(-both) / np.where(both > 0.0, both, 1.0), 1.0)
    return {"hair": view * mean, "skin": np.exp(-both)}


def fur_average(tangent_mean: Array) -> Struct:
    """Direction of the mean tangent, and the variance per axis of a von Mises-Fisher field with that mean
    length."""
    m = np.clip(length(tangent_mean), MEAN_FLOOR, 1.0)
    return {"tangent": safe_unit(tangent_mean, np.array([0.0, 0.0, 1.0])), "variance": (1.0 - m) / m}


def fur_soft_exponent(exponent: Array, variance: Array, azimuth_cosine: Array) -> Array:
    """Variances add: 1/p' = 1/p + 2 (1 + kappa) s^2; a highlight at theta_l + theta_v moves by two
    elevations."""
    p = real(exponent)
    return p / (1.0 + 2.0 * (1.0 + real(azimuth_cosine)) * p * real(variance))


def azimuth_cosine(t: Array, l: Array, v: Array) -> Array:
    """kappa: cosine between t x l and t x v, 0 where either vanishes."""
    a, b = np.cross(real(t), real(l)), np.cross(real(t), real(v))
    scale = length(a) * length(b)
    dot = np.sum(a * b, axis=-1)
    return np.where(scale > 0.0, np.clip(dot / np.where(scale > 0.0, scale, 1.0), -1.0, 1.0), 0.0)


def _hair_radiance(optics: Struct, t: Array, l: Array, v: Array, lobe: Array) -> Array:
    """k_d sin(t, l) + k_s lobe^p, as colours (N, 3)."""
    highlight = power(lobe, optics["exponent"])
    return real(optics["k_diffuse"]) * column(sine(t, l)) + real(optics["k_specular"]) * column(highlight)


def _coat_depths(coat: Struct, t: Array, n: Array, l: Array, v: Array) -> tuple[Array, Array]:
    """Optical depths of the coat along the view and along the light."""
    area = fur_hair_area(coat["hair_length"], coat["radius_base"], coat["radius_tip"])
    density = coat["density"]
    return fur_optical_depth(density, area, t, n, v), fur_optical_depth(density, area, t, n, l)


def _shade(
    weights: Struct, optics: Struct, t: Array, n: Array, l: Array, v: Array, light: Array, skin: Array
) -> Array:
    """Blend of lit hair and lit skin under one light."""
    direction = fur_directional_attenuation(
        azimuth_cosine(t, l, v), optics["rho_reflect"], optics["rho_transmit"]
    )
    surface = fur_surface_attenuation(
        cosine(n, l), optics["rho_surface"], optics["cos_dark"], optics["cos_lit"]
    )
    lobe = sine(t, l) * sine(t, v) - cosine(t, l) * cosine(t, v)
    hair = column(weights["hair"] * direction * surface) * _hair_radiance(optics, t, l, v, lobe)
    return np.asarray(real(light) * (hair + column(weights["skin"]) * real(skin)), dtype=np.float64)


def fakefur_shade(
    coat: Struct, optics: Struct, t: Array, n: Array, l: Array, v: Array, light: Array, skin: Array
) -> Array:
    """One light on a coat with Goldman's weights."""
    depth_view, depth_light = _coat_depths(coat, t, n, l, v)
    weights = fur_weights_goldman(depth_view, depth_light, optics["overlap"])
    return _shade(weights, optics, t, n, l, v, light, skin)


def fakefur_shade_slab(
    coat: Struct, optics: Struct, t: Array, n: Array, l: Array, v: Array, light: Array, skin: Array
) -> Array:
    """One light on a coat with the weights of the exact slab."""
    depth_view, depth_light = _coat_depths(coat, t, n, l, v)
    return _shade(fur_weights_slab(depth_view, depth_light), optics, t, n, l, v, light, skin)


def fakefur_shade_printed(
    coat: Struct, optics: Struct, t: Array, n: Array, l: Array, v: Array, light: Array, skin: Array
) -> Array:
    """The last slide to the letter: half the area, one alpha(v), cl cv + sl sv, cosines against angles."""
    area = fur_hair_area_printed(coat["hair_length"], coat["radius_base"], coat["radius_tip"])
    alpha = fur_opacity(fur_optical_depth(coat["density"], area, t, n, v))
    edges = np.arccos(real(optics["cos_lit"])), np.arccos(real(optics["cos_dark"]))
    surface = 1.0 + real(optics["rho_surface"]) * (hermite_step(*edges, cosine(n, l)) - 1.0)
    direction = fur_directional_attenuation(
        azimuth_cosine(t, l, v), optics["rho_reflect"], optics["rho_transmit"]
    )
    lobe = cosine(t, l) * cosine(t, v) + sine(t, l) * sine(t, v)
    hair = column(direction * surface * (1.0 - alpha / 2.0)) * _hair_radiance(optics, t, l, v, lobe)
    bare = column(1.0 - alpha) * real(skin)
    return np.asarray(real(light) * (column(alpha) * hair + column(1.0 - alpha) * bare), dtype=np.float64)


def grazing(n: Array, w: Array) -> Mask:
    """n.w is not exactly zero term by term, yet so small that the rounding of its terms hides its sign."""
    terms = np.abs(real(n) * real(w)).sum(axis=-1)
    return np.asarray((terms > 0.0) & (np.abs(exact_dot(n, w)) <= 4.0 * ROUNDING * terms), dtype=np.bool_)


def steep_depth(inputs: Inputs) -> Mask:
    """The sign of w.n is lost in rounding: the depth is anything from x / 1e-7 to x / 1e-12."""
    return grazing(inputs["n"], inputs["w"]) & (sine(inputs["t"], inputs["w"]) > 0.0)


def vanishing(sine_to_strand: Array) -> Mask:
    """A sine whose square is below what no target flushes: kappa is 0 there, as along t."""
    return np.asarray((sine_to_strand > 0.0) & (sine_to_strand * sine_to_strand < SMALLEST_NORMAL), np.bool_)


def shade_steps(inputs: Inputs, saturated: float, angles: bool = False) -> Mask:
    """Where a shaded value jumps: kappa on the strand, a small power at 0, a step between equal edges, a
    grazing coat.

    A coat of depth above `saturated` at the grazing cosine that float32 resolves is opaque either way.
    """
    t, n, l, v = (inputs[key] for key in "tnlv")
    coat, optics = inputs["coat"], inputs["optics"]
    coloured = real(optics["rho_reflect"]) != real(optics["rho_transmit"])
    mask = coloured & (parallel_by_rounding(t, l) | parallel_by_rounding(t, v))
    mask |= coloured & (vanishing(sine(t, l)) | vanishing(sine(t, v)))
    product = cosine(t, l) * cosine(t, v)
    lobe = sine(t, l) * sine(t, v) + (product if angles else -product)
    mask |= small_power(optics["exponent"]) & (np.abs(lobe) <= 1e-6)
    low, high = (real(optics[key]) for key in ("cos_dark", "cos_lit"))
    if angles:
        low, high = np.arccos(high), np.arccos(low)
    width, noise = (1e-3, 2e-3) if angles else (1e-6, 1e-6)
    mask |= (np.abs(high - low) < width) & (np.abs(cosine(n, l) - low) < noise)
    area = fur_hair_area(coat["hair_length"], coat["radius_base"], coat["radius_tip"])
    for w in (l, v):
        thickest = real(coat["density"]) * area * sine(t, w) / GRAZING_NOISE
        mask |= grazing(n, w) & (thickest > 0.0) & (thickest < saturated)
    return np.asarray(mask, dtype=np.bool_)


AMBIGUOUS: dict[str, Callable[[Inputs], Mask]] = {
    "fur_obliquity": steep_depth,
    "fur_optical_depth": steep_depth,
    "fakefur_shade": lambda inputs: shade_steps(inputs, 20.0),
    "fakefur_shade_slab": lambda inputs: shade_steps(inputs, np.inf),  # the ratio of two large depths counts
    "fakefur_shade_printed": lambda inputs: shade_steps(inputs, 20.0, angles=True),
}

REFERENCES: dict[str, Reference] = {
    f.__name__: f
    for f in (
        fur_hair_area, fur_hair_area_printed, fur_obliquity, fur_optical_depth, fur_opacity,
        fur_directional_attenuation, fur_surface_attenuation, fur_weights_goldman, fur_weights_slab,
        fur_average, fur_soft_exponent, fakefur_shade, fakefur_shade_slab, fakefur_shade_printed,
    )
}  # fmt: skip
