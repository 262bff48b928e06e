"""The library's functions in mpmath, one point at a time, by other routes than the float64 references.

Vectors are lists of mpf. Sines come from cosines, the strand cosine from the sum of two angles, projections
from plain differences: at 80 digits the cancellation that float64 must avoid does no harm.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from mpmath import mp, mpf

Vector = list[Any]
NOTHING = mpf("1e-30")
"""Float32 vectors that are not parallel form angles above 1e-15; less than this is the rounding of zero."""


def dot(a: Vector, b: Vector) -> Any:
    return sum((x * y for x, y in zip(a, b, strict=True)), mpf(0))


def norm(a: Vector) -> Any:
    return mp.sqrt(dot(a, a))


def times(s: Any, a: Vector) -> Vector:
    return [s * x for x in a]


def plus(a: Vector, b: Vector) -> Vector:
    return [x + y for x, y in zip(a, b, strict=True)]


def unit(a: Vector) -> Vector:
    return times(1 / norm(a), a)


def unit_or(a: Vector, fallback: Vector, threshold: Any = NOTHING) -> Vector:
    return unit(a) if norm(a) > threshold else fallback


def cross(a: Vector, b: Vector) -> Vector:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def cosine(a: Vector, b: Vector) -> Any:
    return min(max(dot(unit(a), unit(b)), mpf(-1)), mpf(1))


def sine(a: Vector, b: Vector) -> Any:
    found = mp.sqrt(abs(1 - cosine(a, b) ** 2))
    return found if found > NOTHING else mpf(0)


def rejected(x: Vector, t: Vector) -> Vector:
    return plus(x, times(-dot(x, unit(t)), unit(t)))


def power(x: Any, y: Any) -> Any:
    if y == 0:
        return mpf(1)
    return mp.exp(y * mp.log(x)) if x > 0 else mpf(0)


def saturating(most: Any) -> Callable[[Any, Any], Any]:
    """A power that stays between 1 / most and most where it is neither 0 nor of exponent 0."""
    return lambda x, y: min(max(power(x, y), 1 / most), most) if x > 0 and y != 0 else power(x, y)


def smoothstep(low: Any, high: Any, x: Any) -> Any:
    if low == high:
        return mpf(0) if x < low else mpf(1)
    s = min(max((x - low) / (high - low), mpf(0)), mpf(1))
    return s**2 * (3 - 2 * s)


def duff(n: Vector) -> dict[str, Vector]:
    x, y, z = unit(n)
    s = 1 if z >= 0 else -1
    a = -1 / (s + z)
    tangent = [1 + s * x * x * a, s * x * y * a, -s * x]
    return {"tangent": tangent, "bitangent": [x * y * a, s + y * y * a, -y], "normal": [x, y, z]}


def half_vector(l: Vector, v: Vector) -> Vector:
    return unit_or(plus(unit(l), unit(v)), duff(l)["tangent"], mpf("1e-6"))


def frame_from_tangent(n: Vector, t: Vector) -> dict[str, Vector]:
    tangent = unit_or(rejected(unit(t), n), duff(n)["tangent"])
    return {"tangent": tangent, "bitangent": cross(unit(n), tangent), "normal": unit(n)}


def strand_cosine(t: Vector, l: Vector, v: Vector) -> Any:
    return -mp.cos(mp.acos(cosine(t, l)) + mp.acos(cosine(t, v)))


def strand_angles(t: Vector, l: Vector, v: Vector) -> dict[str, Any]:
    return {
        "cos_l": cosine(t, l),
        "cos_v": cosine(t, v),
        "sin_l": sine(t, l),
        "sin_v": sine(t, v),
        "defect": 1 - strand_cosine(t, l, v),
    }


def azimuth_cosine(t: Vector, l: Vector, v: Vector) -> Any:
    product = sine(t, l) * sine(t, v)
    return mpf(0) if product == 0 else (cosine(l, v) - cosine(t, l) * cosine(t, v)) / product


def strand_specular(t: Vector, l: Vector, v: Vector, exponent: Any) -> Any:
    return power(strand_cosine(t, l, v), exponent)


def kajiya_kay(
    t: Vector, l: Vector, v: Vector, k_diffuse: Vector, k_specular: Vector, exponent: Any
) -> Vector:
    return plus(times(sine(t, l), k_diffuse), times(strand_specular(t, l, v, exponent), k_specular))


def banks(t: Vector, n: Vector, l: Vector, v: Vector, *rest: Any) -> Vector:
    return times(max(cosine(n, l), mpf(0)), kajiya_kay(t, l, v, *rest))


def tangent_from_map(n: Vector, t: Vector, m: Vector) -> Vector:
    frame = frame_from_tangent(n, t)
    tangent, bitangent, normal = frame["tangent"], frame["bitangent"], frame["normal"]
    vector = plus(plus(times(m[0], tangent), times(m[1], bitangent)), times(m[2], normal))
    return unit_or(rejected(vector, normal), tangent, mpf("1e-45"))


def tangent_shift(t: Vector, n: Vector, shift: Any) -> Vector:
    return unit_or(plus(unit(t), times(shift, unit(n))), unit(t))


def scheuermann(
    t: Vector,
    n: Vector,
    l: Vector,
    v: Vector,
    base: Vector,
    primary: Vector,
    p1: Any,
    shift1: Any,
    *rest: Any,
) -> Vector:
    secondary, p2, shift2, mask = rest
    h = half_vector(l, v)
    diffuse = min(max(mpf("0.25") + mpf("0.75") * cosine(n, l), mpf(0)), mpf(1))

    def lobe(exponent: Any, shift: Any) -> Any:
        shifted = tangent_shift(t, n, shift)
        return smoothstep(mpf(-1), mpf(0), cosine(shifted, h)) * power(sine(shifted, h), exponent)

    highlights = plus(times(lobe(p1, shift1), primary), times(mask * lobe(p2, shift2), secondary))
    return [b * (diffuse + c) for b, c in zip(base, highlights, strict=True)]


def path(depth: Any, divisor: Any) -> Any:
    if depth == 0:
        return mpf(0)
    return min(depth / divisor, mpf(10) ** 18) if divisor > 0 else mpf(10) ** 18


def to_local(frame: dict[str, Vector], w: Vector) -> Vector:
    return [dot(w, unit(frame[name])) for name in ("tangent", "bitangent", "normal")]


def to_world(frame: dict[str, Vector], w: Vector) -> Vector:
    axes = [unit(frame[name]) for name in ("tangent", "bitangent", "normal")]
    return [sum((w[k] * axes[k][c] for k in range(3)), mpf(0)) for c in range(3)]


def mirror(l: Vector, n: Vector) -> Vector:
    return plus(times(2 * cosine(n, l), unit(n)), times(mpf(-1), unit(l)))


FORMS: dict[str, Callable[..., Any]] = {
    "safe_sqrt": lambda x: mp.sqrt(max(x, mpf(0))),
    "safe_pow": saturating(mp.exp(80)),
    "log_one_minus": lambda q: mp.log(1 - q),
    "pow_one_minus": lambda q, p: power(1 - q, p),
    "one_minus_exp_neg": lambda x: 1 - mp.exp(-x),
    "exprel_neg": lambda x: (1 - mp.exp(-x)) / x if x else mpf(1),
    "safe_smoothstep": smoothstep,
    "safe_normalize": lambda x, fallback: unit_or(x, fallback, mpf(0)),
    "bessel_i0e": lambda x: mp.exp(-abs(x)) * mp.besseli(0, x),
    "line_component": lambda x, t: times(dot(x, unit(t)), unit(t)),
    "line_rejection": rejected,
    "sin_angle": sine,
    "sin_angle_half": sine,
    "sin_angle_cross": sine,
    "sin_angle_cosine": sine,
    "half_vector": half_vector,
    "mirror": mirror,
    "frame_from_normal": duff,
    "frame_from_tangent": frame_from_tangent,
    "to_local": to_local,
    "to_world": to_world,
    "strand_angles": strand_angles,
    "strand_diffuse": sine,
    "strand_cosine": strand_cosine,
    "strand_cosine_banks_printed": lambda t, l, v: cosine(t, l) * cosine(t, v) - sine(t, l) * sine(t, v),
    "strand_cosine_kajiya_printed": lambda t, l, v: cosine(t, l) * cosine(t, v) + sine(t, l) * sine(t, v),
    "strand_specular": strand_specular,
    "strand_specular_half": lambda t, h, exponent: power(sine(t, h), exponent),
    "strand_azimuth_cosine": azimuth_cosine,
    "inherited_shadow": lambda n, l: max(cosine(n, l), mpf(0)),
    "banks_shade": banks,
    "kajiya_kay_shade": kajiya_kay,
    "tangent_from_map": tangent_from_map,
    "tangent_shift": tangent_shift,
    "scheuermann_shade": scheuermann,
    "coat_extinction": lambda rho: min(-mp.log(1 - rho), mpf(10) ** 18) if rho < 1 else mpf(10) ** 18,
    "coat_path_banks": lambda depth, t, l: path(depth, sine(t, l)),
    "coat_path_slab": lambda depth, n, l: path(depth, cosine(n, l)),
    "coat_transmittance": lambda extinction, way: mp.exp(-min(extinction * way, mpf(80))),
}
