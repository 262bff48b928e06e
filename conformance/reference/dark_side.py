"""The strand cosine near 0 with full relative precision: a small power magnifies what float64 drops."""

from __future__ import annotations

from typing import Any

import numpy as np
from mpmath import mp, mpf

from conformance.reference.exact import Array, real

DIGITS = 50
SMALL = 1e-4
"""Below this strand cosine its relative error in float64, 1e-16 / SMALL, counts under a small power."""


def precise_cosine(t: Array, l: Array, v: Array) -> float:
    """sin sin - cos cos of one point, rounded once."""

    def dot(a: Array, b: Array) -> Any:
        return sum((mpf(float(x)) * mpf(float(y)) for x, y in zip(a, b, strict=True)), mpf(0))

    with mp.workdps(DIGITS):
        cos_l, cos_v = (dot(t, x) / mp.sqrt(dot(t, t) * dot(x, x)) for x in (l, v))
        sines = mp.sqrt(max(1 - cos_l**2, mpf(0)) * max(1 - cos_v**2, mpf(0)))
        return float(sines - cos_l * cos_v)


def small_powers(t: Any, l: Any, v: Any, exponent: Any, cosine: Array, value: Array) -> Array:
    """`value` = max(0, cosine)^exponent, computed anew where 0 < exponent < 1 and the cosine is near 0."""
    vectors = [np.broadcast_to(real(x), (*value.shape, 3)).reshape(-1, 3) for x in (t, l, v)]
    points = np.concatenate(vectors, axis=1)
    power = np.broadcast_to(real(exponent), value.shape).ravel()
    result = value.ravel().copy()
    near_zero = (np.abs(np.broadcast_to(cosine, value.shape)).ravel() < SMALL) & (power > 0.0) & (power < 1.0)
    # Hard cases repeat the same points with other exponents: each is computed once.
    distinct, which = np.unique(points[near_zero], axis=0, return_inverse=True)
    cosines = np.array([precise_cosine(x[0:3], x[3:6], x[6:9]) for x in distinct])
    if len(cosines):
        base = cosines[which.ravel()]
        result[near_zero] = np.where(base > 0.0, np.abs(base) ** power[near_zero], 0.0)
    return result.reshape(value.shape)
