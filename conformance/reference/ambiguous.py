"""Inputs at which the documented value is discontinuous and float32 rounding decides on which side one lands.

There a float32 evaluation may be right and still far from the reference, so the suite asks only for a finite
result. Each predicate takes the function's inputs by parameter name (float32 arrays) and returns a mask (N,).
The masks are as narrow as the rounding that they stand for; what is merely badly conditioned is not in them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from conformance.reference.direction import OPPOSITE, half_vector
from conformance.reference.exact import Mask, length, real, sine
from conformance.reference.strand import strand_cosine, tangent_from_map, tangent_shift
from conformance.reference.sums import direction_sum, dot

Inputs = Mapping[str, Any]

ROUNDING = 2.0**-24
"""Half a unit in the last place of float32, relative."""
SMALLEST_NORMAL = 2.0**-126
"""Smallest magnitude that no target may flush to zero."""


def parallel_by_rounding(a: Any, b: Any) -> Mask:
    """Parallel to within rounding, yet not the same or the opposite three numbers.

    a - b and a + b then both lie along a (the vectors differ in length by some 1e-7), and their cross product
    is zero or the rounding error of its terms, about 4 * 2^-24 of the difference in length; a factor 4 is
    allowed for. For the same or opposite numbers one factor is exactly zero, and so is the product.
    """
    wide_a, wide_b = real(a), real(b)
    same = (wide_a == wide_b).all(axis=-1) | (wide_a == -wide_b).all(axis=-1)
    # Along one axis all terms but one are zero, and differences of zeros do not round.
    single = ((wide_a != 0.0) | (wide_b != 0.0)).sum(axis=-1) <= 1
    noise = 16.0 * ROUNDING * np.abs(length(wide_a) - length(wide_b))
    return np.asarray(~same & ~single & (sine(a, b) <= noise), dtype=np.bool_)


def grazing(n: Any, w: Any) -> Mask:
    """The sign of n.w is lost in the rounding of its products (sums of zeros do not round)."""
    terms = real(n) * real(w)
    size = np.abs(terms).sum(axis=-1)
    return np.asarray((size > 0.0) & (np.abs(terms.sum(axis=-1)) <= 4.0 * ROUNDING * size), dtype=np.bool_)


def nearly_opposite(l: Any, v: Any) -> Mask:
    """|l + v|^2 on different sides of 1e-12, or within one part in a million of it.

    A program adds the vectors as given, the reference their directions; the lengths differ by rounding.
    """
    given, exact = real(l) + real(v), direction_sum(l, 1.0, v)
    below = (dot(given, given) < OPPOSITE * (1.0 - 1e-6)) & (dot(exact, exact) < OPPOSITE * (1.0 - 1e-6))
    above = (dot(given, given) > OPPOSITE * (1.0 + 1e-6)) & (dot(exact, exact) > OPPOSITE * (1.0 + 1e-6))
    return np.asarray(~below & ~above, dtype=np.bool_)


def cancelled_shift(t: Any, n: Any, shift: Any) -> Mask:
    """t + shift n is zero (no documented value) or only the rounding of its terms (any direction)."""
    left = length(direction_sum(t, shift, n))
    return np.asarray(left <= 8.0 * ROUNDING * (1.0 + np.abs(real(shift))), dtype=np.bool_)


def small_power(exponent: Any) -> Mask:
    """Exponents in (0, 1): x^p rises from 0 with infinite slope, in the limit as the step of exponent 0."""
    power = real(exponent)
    return np.asarray((power > 0.0) & (power < 1.0), dtype=np.bool_)


def step_at_dark_side(t: Any, l: Any, v: Any, exponent: Any) -> Mask:
    """A small power of a strand cosine whose sign float32 cannot tell (an error of 4e-7 is 8 roundings)."""
    return np.asarray(small_power(exponent) & (np.abs(strand_cosine(t, l, v)) <= 1e-6), dtype=np.bool_)


def smoothstep_edges(inputs: Inputs) -> Mask:
    """Different edges whose difference is a denormal: a target may flush it and see equal edges."""
    gap = np.abs(real(inputs["edge1"]) - real(inputs["edge0"]))
    return np.asarray((gap > 0.0) & (gap < SMALLEST_NORMAL), dtype=np.bool_)


def grazing_slab(inputs: Inputs) -> Mask:
    """The jump from depth / (n.l) to 1e18 at n.l = 0."""
    lost = grazing(inputs["n"], inputs["l"]) & (real(inputs["depth"]) > 0.0)
    return np.asarray(lost, dtype=np.bool_)


def parallel_path(inputs: Inputs) -> Mask:
    """A sine that is zero or rounding noise: the path is 1e18 or depth / 1e-14."""
    found = parallel_by_rounding(inputs["t"], inputs["l"]) & (real(inputs["depth"]) > 0.0)
    return np.asarray(found, dtype=np.bool_)


def azimuth_at_pole(inputs: Inputs) -> Mask:
    """Zero (0 by definition) or noise of any direction (any value in [-1, 1])."""
    t = inputs["t"]
    return parallel_by_rounding(t, inputs["l"]) | parallel_by_rounding(t, inputs["v"])


def tangent_along_normal(inputs: Inputs) -> Mask:
    """The part of t orthogonal to n is zero (fallback) or noise of any direction."""
    return parallel_by_rounding(inputs["n"], inputs["t"])


def specular_step(inputs: Inputs) -> Mask:
    """See step_at_dark_side."""
    return step_at_dark_side(inputs["t"], inputs["l"], inputs["v"], inputs["exponent"])


def half_specular_step(inputs: Inputs) -> Mask:
    """A small power of a sine that is zero or rounding noise."""
    return small_power(inputs["exponent"]) & parallel_by_rounding(inputs["t"], inputs["h"])


def scheuermann_steps(inputs: Inputs) -> Mask:
    """Everything its parts are ambiguous at; the half vector is rounded, by 2^-23 / |l + v| radians."""
    t, n, l, v = (inputs[name] for name in "tnlv")
    found = nearly_opposite(l, v)
    h = half_vector(l, v)
    blur = 8.0 * ROUNDING / np.maximum(length(direction_sum(l, 1.0, v)), 1e-6)
    for lobe in ("primary", "secondary"):
        shift, exponent = inputs[f"{lobe}_shift"], inputs[f"{lobe}_exponent"]
        along = sine(tangent_shift(t, n, shift), h) <= blur
        found = found | cancelled_shift(t, n, shift) | (small_power(exponent) & along)
    return np.asarray(found, dtype=np.bool_)


def vanishing_texel(inputs: Inputs) -> Mask:
    """No tangent on the surface, or a texel whose part in it is within a factor 100 of the denormals.

    Times a component of the frame that part may be flushed, and the texel counts as empty.
    """
    size = np.abs(real(inputs["map_tangent"])[:, :2]).max(axis=-1)
    empty = (size > 0.0) & (size < 100.0 * SMALLEST_NORMAL)
    return np.asarray(tangent_along_normal(inputs) | empty)


def brushed_steps(inputs: Inputs) -> Mask:
    """A vanishing texel, or a step of the highlight of the tangent that the map gives."""
    tangent = tangent_from_map(inputs["n"], inputs["t"], inputs["map_tangent"])
    return np.asarray(vanishing_texel(inputs) | specular_step({**inputs, "t": tangent}))


AMBIGUOUS: dict[str, Callable[[Inputs], Mask]] = {
    "safe_smoothstep": smoothstep_edges,
    "half_vector": lambda inputs: nearly_opposite(inputs["l"], inputs["v"]),
    "frame_from_tangent": tangent_along_normal,
    "strand_specular": specular_step,
    "banks_shade": specular_step,
    "brushed_shade": brushed_steps,
    "kajiya_kay_shade": specular_step,
    "strand_specular_half": half_specular_step,
    "strand_azimuth_cosine": azimuth_at_pole,
    "tangent_from_map": vanishing_texel,
    "tangent_shift": lambda inputs: cancelled_shift(inputs["t"], inputs["n"], inputs["shift"]),
    "scheuermann_shade": scheuermann_steps,
    "coat_path_banks": parallel_path,
    "coat_path_slab": grazing_slab,
}
