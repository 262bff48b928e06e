"""References of the library's section `numeric`. Scalars are arrays (N,), vectors (N, 3); all float64."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.special import i0e

from conformance.reference.exact import Array, hermite_step, power, power_of_one_minus, real, safe_unit


def safe_sqrt(x: Any) -> Array:
    """sqrt(max(x, 0))."""
    return np.sqrt(np.maximum(real(x), 0.0))


def safe_pow(x: Any, y: Any) -> Array:
    """1 where y = 0; else 0 where x <= 0; else x^y between e^-80 and e^80, where it saturates."""
    return _saturated(x, y, float(np.exp(80.0)))


def safe_pow_exp2(x: Any, y: Any) -> Array:
    """The same, saturated at 2^-115 and 2^115."""
    return _saturated(x, y, 2.0**115)


def _saturated(x: Any, y: Any, most: float) -> Array:
    with np.errstate(over="ignore", under="ignore"):
        raised = power(x, y)
    decided = (real(y) == 0.0) | (real(x) <= 0.0)
    return np.where(decided, raised, np.clip(raised, 1.0 / most, most))


def log_one_minus(q: Any) -> Array:
    """log(1 - q) for q < 1."""
    return np.log1p(-real(q))


def pow_one_minus(q: Any, p: Any) -> Array:
    """(1 - q)^p for 0 <= q <= 2: 1 where p = 0, else 0 where q >= 1."""
    with np.errstate(under="ignore"):
        return power_of_one_minus(q, p)


def one_minus_exp_neg(x: Any) -> Array:
    """1 - e^-x."""
    return -np.expm1(-real(x))


def exprel_neg(x: Any) -> Array:
    """(1 - e^-x) / x, and 1 at 0."""
    value = real(x)
    divisor = np.where(value == 0.0, 1.0, value)
    return np.where(value == 0.0, 1.0, -np.expm1(-value) / divisor)


def safe_smoothstep(edge0: Any, edge1: Any, x: Any) -> Array:
    """3 s^2 - 2 s^3 with s = (x - edge0) / (edge1 - edge0) clamped to [0, 1].

    Equal edges: 0 where x < edge0, 1 at and above. Reversed edges give the descending step.
    """
    return hermite_step(edge0, edge1, x)


def safe_normalize(x: Any, fallback: Any) -> Array:
    """The direction of `x`; for the zero vector `fallback`, as it is given."""
    return safe_unit(x, fallback)


def bessel_i0e(x: Any) -> Array:
    """e^-|x| I0(x)."""
    return np.asarray(i0e(real(x)), dtype=np.float64)


REFERENCES: dict[str, Callable[..., Any]] = {
    "safe_sqrt": safe_sqrt,
    "safe_pow": safe_pow,
    "safe_pow_exp2": safe_pow_exp2,
    "log_one_minus": log_one_minus,
    "pow_one_minus": pow_one_minus,
    "one_minus_exp_neg": one_minus_exp_neg,
    "exprel_neg": exprel_neg,
    "safe_smoothstep": safe_smoothstep,
    "safe_normalize": safe_normalize,
    "bessel_i0e": bessel_i0e,
}
