"""References of the library's section lobes: value, density per steradian and sampler of every lobe.

Parameters as in the library: directions (N, 3) in the local frame (x tangent, z normal), pairs (N, 2),
scalars (N,). Lambert and the modified Phong lobe stand here; half-vector lobes and lobes of fibres have their
own modules.
"""

from collections.abc import Callable

import numpy as np

from conformance.reference import lobes_fibre, lobes_half
from conformance.reference.ambiguous import ROUNDING, Inputs
from conformance.reference.exact import (
    Array,
    Mask,
    Reference,
    column,
    frame_tangent_and_bitangent,
    length,
    power_of_one_minus,
    real,
    total,
    unit,
)
from conformance.reference.lobes_half import around, cosine_direction, lit, radial_defect


def lambert_value(l: Array, v: Array) -> Array:
    """1 / pi."""
    return lit(l, v) / np.pi


def lambert_pdf(l: Array, v: Array) -> Array:
    """max(n.l, 0) / pi."""
    return np.maximum(unit(l)[..., 2], 0.0) / np.pi


def lambert_sample(u: Array, v: Array) -> Array:
    """Malley's method; the rim of the disc, u = (0, 0) among it, goes to the peak: its density is not 0."""
    return cosine_direction(u)


def mirrored(v: Array) -> Array:
    """(-v.x, -v.y, v.z), the direction about which the Phong lobe stands."""
    return np.asarray(unit(v) * np.array([-1.0, -1.0, 1.0]), dtype=np.float64)


def phong_power(l: Array, v: Array, exponent: Array) -> Array:
    """(l.r)^p, 0 for l.r <= 0 also at p = 0; 1 - l.r = |l - r|^2 / 2."""
    q = total((unit(l) - mirrored(v)) ** 2) / 2.0
    return np.where(q < 1.0, power_of_one_minus(q, exponent), 0.0)


def phong_value(l: Array, v: Array, exponent: Array) -> Array:
    """(p + 2) / (2 pi) max(0, l.r)^p (Lafortune and Willems 1994)."""
    return lit(l, v) * (real(exponent) + 2.0) / (2.0 * np.pi) * phong_power(l, v, exponent)


def phong_pdf(l: Array, v: Array, exponent: Array) -> Array:
    """(p + 1) / (2 pi) max(0, l.r)^p over the whole sphere."""
    return (real(exponent) + 1.0) / (2.0 * np.pi) * phong_power(l, v, exponent)


def phong_sample(u: Array, v: Array, exponent: Array) -> Array:
    """A power-cosine lobe about r, azimuth in Duff's frame of r."""
    u, r = real(u), mirrored(v)
    local = around(radial_defect(u[..., 0], real(exponent) + 1.0), 2.0 * np.pi * u[..., 1])
    t, b = frame_tangent_and_bitangent(r)
    return unit(column(local[..., 0]) * t + column(local[..., 1]) * b + column(local[..., 2]) * r)


def punctual_radiance(brdf: Array, light: Array, n_dot_l: Array) -> Array:
    """pi brdf light max(n.l, 0): the light is what a white Lambertian facing it would show."""
    return np.asarray(
        np.pi * real(brdf) * real(light) * column(np.maximum(real(n_dot_l), 0.0)), dtype=np.float64
    )


def undetermined_half(inputs: Inputs) -> Mask:
    """l + v is shorter than a millionth: its direction is rounding noise, and 1 / |v.h| with it."""
    return np.asarray(length(unit(inputs["l"]) + unit(inputs["v"])) <= 1e-6, dtype=np.bool_)


def level_half(inputs: Inputs) -> Mask:
    """l.z + v.z is zero within rounding: whether the half vector points up is undecided."""
    total = np.abs(real(inputs["l"])[..., 2] + real(inputs["v"])[..., 2])
    return np.asarray(total <= 4.0 * ROUNDING * np.abs(real(inputs["v"])[..., 2]), dtype=np.bool_)


def low_power(inputs: Inputs, *exponents: str) -> Mask:
    """The exponent is below 1 and not 0: the power rises from 0 with infinite slope.

    Of two exponents, the one along the half vector counts.
    """
    if len(exponents) == 1:
        found = real(inputs[exponents[0]])
    else:
        half = unit(inputs["l"]) + unit(inputs["v"])
        found = lobes_half.shirley_exponent(half, *(inputs[name] for name in exponents))
    return np.asarray((found > 0.0) & (found < 1.0), dtype=np.bool_)


def half_density(*exponents: str) -> Callable[[Inputs], Mask]:
    """The density of a half-vector lobe h.z^p: undetermined at l = -v, a step at h.z = 0 for small p."""

    def predicate(inputs: Inputs) -> Mask:
        step = low_power(inputs, *exponents) if exponents else np.zeros(len(inputs["l"]), np.bool_)
        return np.asarray(undetermined_half(inputs) | (step & level_half(inputs)), dtype=np.bool_)

    return predicate


def phong_edge(inputs: Inputs) -> Mask:
    """l.r is zero within rounding and the exponent below 1: 0 on one side, nearly 1 on the other."""
    cosine = np.abs(total(unit(inputs["l"]) * mirrored(inputs["v"])))
    return np.asarray((real(inputs["exponent"]) < 1.0) & (cosine <= 1e-6), dtype=np.bool_)


def strand_edge(inputs: Inputs) -> Mask:
    """The same for the strand cosine; and both directions so close to the fibre that nothing is left across
    it."""
    defect = lobes_fibre.strand_defect(inputs["l"], inputs["v"])
    edge = (real(inputs["exponent"]) < 1.0) & (np.abs(1.0 - defect) <= 1e-6)
    across = lobes_fibre.elevation(inputs["l"])[1] + lobes_fibre.elevation(inputs["v"])[1]
    return np.asarray(edge | (across <= 1e-7), dtype=np.bool_)


def strand_side(inputs: Inputs) -> Mask:
    """u.y lies on the boundary between the two signs of delta."""
    share = lobes_fibre.strand_sides(inputs["u"], inputs["v"], inputs["exponent"])[-1]
    return np.asarray(np.abs(real(inputs["u"])[..., 1] - share) <= 1e-5, dtype=np.bool_)


def satin_edge(inputs: Inputs) -> Mask:
    """l = -v, or the facet normal is at the end of the arc within the rounding of its angle."""
    h, _ = lobes_half.upper_half(inputs["l"], inputs["v"])
    across = np.hypot(h[..., 1], h[..., 2])
    gap = np.abs(np.abs(np.arctan2(h[..., 1], h[..., 2])) - real(inputs["spread"]))
    blur = 1e-6 / np.maximum(across * length(unit(inputs["l"]) + unit(inputs["v"])), 1e-6)
    return np.asarray(
        (gap <= blur) & (real(inputs["specular"]) > 0.0) | undetermined_half(inputs), dtype=np.bool_
    )


def satin_strategy(inputs: Inputs) -> Mask:
    """u.x on the boundary between the strategies: the end of the one, the beginning of the other."""
    x, diffuse = real(inputs["u"])[..., 0], 1.0 - real(inputs["specular"])
    return np.asarray((np.abs(x - diffuse) <= 1e-6) & ((diffuse > 0.0) | (x > 0.0)), dtype=np.bool_)


def view_below(inputs: Inputs) -> Mask:
    """Visible normals are defined for views above the horizon only."""
    return np.asarray(real(inputs["v"])[..., 2] <= 0.0, dtype=np.bool_)


AMBIGUOUS: dict[str, Callable[[Inputs], Mask]] = {
    "phong_value": phong_edge,
    "phong_pdf": phong_edge,
    "blinn_phong_pdf": half_density("exponent"),
    "ward_pdf": half_density(),
    "ashikhmin_shirley_pdf": half_density("exponent_x", "exponent_y"),
    "ggx_pdf": lambda inputs: undetermined_half(inputs) | level_half(inputs) | view_below(inputs),
    "strand_value": strand_edge,
    "strand_pdf": strand_edge,
    "strand_sample": strand_side,
    "poulin_fournier_pdf": satin_edge,
    "poulin_fournier_sample": satin_strategy,
}

LOBES: dict[str, tuple[str, ...]] = {
    "lambert": (),
    "phong": ("exponent",),
    "blinn_phong": ("exponent",),
    "ward": ("alpha_x", "alpha_y"),
    "ashikhmin_shirley": ("exponent_x", "exponent_y"),
    "ggx": ("alpha_x", "alpha_y"),
    "strand": ("exponent",),
    "poulin_fournier": ("spread", "specular", "exponent"),
}
"""Every lobe with the names of its parameters."""


def reference_of(lobe: str, part: str) -> Reference:
    """The function <lobe>_<part>, part one of value, pdf, sample."""
    name = f"{lobe}_{part}"
    for table in (globals(), vars(lobes_half), vars(lobes_fibre)):
        if name in table:
            found: Reference = table[name]
            return found
    raise KeyError(name)


REFERENCES: dict[str, Reference] = {"punctual_radiance": punctual_radiance} | {
    f"{lobe}_{part}": reference_of(lobe, part) for lobe in LOBES for part in ("value", "pdf", "sample")
}
