"""References of the library's section shells and fins (Lengyel 2001, Banks' shadow falloff, errata
applied).

Scalars (N,), vectors (N, 3), layer indices as uint32 arrays.
"""

from collections.abc import Callable

import numpy as np

from conformance.reference.ambiguous import ROUNDING, Inputs, parallel_by_rounding, small_power
from conformance.reference.exact import (
    Array,
    Mask,
    Reference,
    Words,
    column,
    cosine,
    frame_tangent_and_bitangent,
    power,
    power_of_one_minus,
    real,
    safe_unit,
    sine,
    unit,
)

VIEW_FLOOR = 1e-5
"""Smallest |n.v| that the slanted opacity divides by (as documented)."""
THRESHOLD_FLOOR = 1e-6
"""Smallest silhouette threshold (as documented)."""

PROPERTY_ONLY: tuple[str, ...] = ("shell_strand_mask",)
"""No paper fixes a formula for these: coverage in [0, 1], falling with height, equal on every target.
"""


def shell_height(layer: Words, layers: Words) -> Array:
    """Height of a layer in the coat: 0 at the skin, 1 at the top; a single layer lies on the skin."""
    last = np.asarray(layers, dtype=np.int64) - 1
    index = np.asarray(layer, dtype=np.int64)
    inner = index / np.maximum(last, 1)
    return np.where(last < 1, 0.0, np.minimum(inner, 1.0))


def shell_offset(
    position: Array, n: Array, coat_length: Array, height: Array, comb: Array, force: Array
) -> Array:
    """Vertex of a shell: along the normal, bent by the comb (linear) and the force (quadratic in height)."""
    n, h = unit(n), column(height)
    direction = safe_unit(n + h * real(comb) + h * h * real(force), n)
    return np.asarray(real(position) + column(coat_length) * h * direction, dtype=np.float64)


def shell_shadow(height: Array, s_min: Array) -> Array:
    """Linear falloff from 1 at the outermost shell to s_min at the skin."""
    h, s = real(height), real(s_min)
    return s + h * (1.0 - s)


def shell_shade(
    n: Array, l: Array, h: Array, k_diffuse: Array, p_diffuse: Array, k_specular: Array, p_specular: Array
) -> Array:
    """Kajiya-Kay with the normal as tangent: k_d sin(n, l)^p_d + k_s sin(n, h)^p_s."""
    diffuse, specular = power(sine(n, l), p_diffuse), power(sine(n, h), p_specular)
    return np.asarray(
        real(k_diffuse) * column(diffuse) + real(k_specular) * column(specular), dtype=np.float64
    )


def shell_shade_printed(
    n: Array, l: Array, h: Array, k_diffuse: Array, p_diffuse: Array, k_specular: Array, p_specular: Array
) -> Array:
    """The slide's identity to the letter: 1 - cos^(p/2), a negative cosine raised by safe_pow."""
    diffuse = 1.0 - power(cosine(n, l), real(p_diffuse) / 2.0)
    specular = 1.0 - power(cosine(n, h), real(p_specular) / 2.0)
    return np.asarray(
        real(k_diffuse) * column(diffuse) + real(k_specular) * column(specular), dtype=np.float64
    )


def shell_alpha_resample(alpha: Array, authored: Array, drawn: Array) -> Array:
    """Opacity of one of `drawn` blended layers that together block as much as `authored` of `alpha`."""
    exponent = real(authored) / np.maximum(real(drawn), 1.0)
    return _one_minus_power_of_one_minus(real(alpha), exponent)


def shell_alpha_view(alpha: Array, n_dot_v: Array) -> Array:
    """Opacity of a layer crossed at a slant: its path is longer by 1 / |n.v|."""
    return _one_minus_power_of_one_minus(real(alpha), 1.0 / np.maximum(np.abs(real(n_dot_v)), VIEW_FLOOR))


def _one_minus_power_of_one_minus(alpha: Array, exponent: Array) -> Array:
    """1 - (1 - alpha)^exponent without cancellation for small alpha."""
    inside = alpha < 1.0
    thin = -np.expm1(exponent * np.log1p(-np.where(inside, alpha, 0.0)))
    return np.where(inside, thin, 1.0 - power_of_one_minus(alpha, exponent))


def fin_position(position: Array, n: Array, w: Array, coat_length: Array) -> Array:
    """Vertex of a fin: the base vertex (w = 0) or the tip (w = 1) along the normal."""
    return np.asarray(real(position) + column(real(w) * real(coat_length)) * unit(n), dtype=np.float64)


def fin_normal(edge: Array, n: Array) -> Array:
    """Normal of the fin that the edge and the surface normal span; Duff's tangent where they are parallel."""
    return safe_unit(np.cross(real(edge), real(n)), frame_tangent_and_bitangent(n)[0])


def fin_opacity(v: Array, n_fin: Array) -> Array:
    """max(0, 2 |cos(v, n_fin)| - 1)."""
    return np.maximum(0.0, 2.0 * np.abs(cosine(v, n_fin)) - 1.0)


def fin_opacity_surface(v: Array, n: Array) -> Array:
    """max(0, 2 sin(v, n) - 1), the lecture's upper bound of fin_opacity."""
    return np.maximum(0.0, 2.0 * sine(v, n) - 1.0)


def fin_opacity_silhouette(facing_a: Array, facing_b: Array, threshold: Array) -> Array:
    """1 where the two faces turn opposite ways; else fading out as the nearer one turns to the eye."""
    a, b = real(facing_a), real(facing_b)
    fade = 1.0 - np.minimum(np.abs(a), np.abs(b)) / np.maximum(real(threshold), THRESHOLD_FLOOR)
    return np.where(np.sign(a) * np.sign(b) <= 0.0, 1.0, np.clip(fade, 0.0, 1.0))


def blend_over(under: Array, over: Array, alpha: Array) -> Array:
    """Straight-alpha compositing."""
    a = column(alpha)
    return np.asarray(a * real(over) + (1.0 - a) * real(under), dtype=np.float64)


def cancelled_comb(inputs: Inputs) -> Mask:
    """n + height comb + height^2 force is shorter than its own rounding: its direction is undetermined."""
    h = column(inputs["height"])
    comb, force = h * real(inputs["comb"]), h * h * real(inputs["force"])
    left = np.linalg.norm(unit(inputs["n"]) + comb + force, axis=-1)
    size = 1.0 + np.abs(comb).max(axis=-1) + np.abs(force).max(axis=-1)
    return np.asarray((left <= 8.0 * ROUNDING * size) & (real(inputs["height"]) > 0.0), dtype=np.bool_)


def parallel_edge(inputs: Inputs) -> Mask:
    """The plain cross product of an edge along n is rounding noise of any direction, or exactly zero."""
    edge, n = real(inputs["edge"]), real(inputs["n"])
    single = ((edge != 0.0) | (n != 0.0)).sum(axis=-1) <= 1
    given = (edge != 0.0).any(axis=-1)
    return np.asarray(given & ~single & (sine(edge, n) <= 8.0 * ROUNDING), dtype=np.bool_)


def nothing_authored(inputs: Inputs) -> Mask:
    """alpha = 1 of no layers at all is 1 - 0^0."""
    return np.asarray((real(inputs["alpha"]) == 1.0) & (real(inputs["authored"]) == 0.0), dtype=np.bool_)


def shade_steps(inputs: Inputs, printed: bool) -> Mask:
    """A small power of a sine (printed: of a cosine) that is zero or rounding noise."""
    mask = np.zeros(len(inputs["n"]), dtype=np.bool_)
    for direction, exponent in (("l", "p_diffuse"), ("h", "p_specular")):
        if printed:
            noise = np.abs(cosine(inputs["n"], inputs[direction])) <= 8.0 * ROUNDING
            mask |= small_power(real(inputs[exponent]) / 2.0) & noise
        else:
            mask |= small_power(inputs[exponent]) & parallel_by_rounding(inputs["n"], inputs[direction])
    return mask


AMBIGUOUS: dict[str, Callable[[Inputs], Mask]] = {
    "shell_offset": cancelled_comb,
    "fin_normal": parallel_edge,
    "shell_alpha_resample": nothing_authored,
    "shell_shade": lambda inputs: shade_steps(inputs, printed=False),
    "shell_shade_printed": lambda inputs: shade_steps(inputs, printed=True),
}

REFERENCES: dict[str, Reference] = {
    f.__name__: f
    for f in (
        shell_height, shell_offset, shell_shadow, shell_shade, shell_shade_printed, shell_alpha_resample,
        shell_alpha_view, fin_position, fin_normal, fin_opacity, fin_opacity_surface, fin_opacity_silhouette,
        blend_over,
    )
}  # fmt: skip
