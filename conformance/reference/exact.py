"""Float64 vector arithmetic that loses nothing to cancellation when its inputs are float32 values.

A product of two float32 numbers is exact in float64, so cross and dot products of the given vectors are
formed BEFORE any normalisation: a component of a cross product then carries one rounding, whatever the angle.
Vectors have shape (N, 3), scalars (N,).
"""

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]
Words = npt.NDArray[np.uint32]
Struct = dict[str, Array]
Reference = Callable[..., Any]


def real(x: npt.ArrayLike) -> Array:
    """The input widened to float64."""
    return np.asarray(x, dtype=np.float64)


def column(x: npt.ArrayLike) -> Array:
    """A scalar per row as a column that multiplies the rows of an (N, 3) array."""
    return real(x)[..., None]


def stack(*components: npt.ArrayLike) -> Array:
    """Components (N,) as vectors (N, k)."""
    return np.stack(np.broadcast_arrays(*(real(c) for c in components)), axis=-1)


def total(x: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Sum of a vector's components, first component first."""
    # NumPy reduces a short last axis several times as slowly, to the same bits.
    return functools.reduce(np.add, (x[..., k] for k in range(x.shape[-1])))


def length(x: npt.ArrayLike) -> Array:
    """Euclidean length; the largest component is factored out, so nothing over- or underflows."""
    x = real(x)
    scale = functools.reduce(np.maximum, (np.abs(x[..., k]) for k in range(x.shape[-1])))
    safe = np.where(scale > 0.0, scale, 1.0)
    y = x / safe[..., None]
    return np.asarray(safe * np.sqrt(total(y * y)) * (scale > 0.0), dtype=np.float64)


def unit(x: npt.ArrayLike) -> Array:
    """The direction of a vector; the zero vector stays zero."""
    x = real(x)
    norm = length(x)
    return x / np.where(norm > 0.0, norm, 1.0)[..., None]


def two_sum(a: Array, b: Array) -> tuple[Array, Array]:
    """a + b as the rounded sum and its rounding error, exactly (Knuth)."""
    s = a + b
    c = s - a
    return s, (a - (s - c)) + (b - c)


def exact_dot(a: npt.ArrayLike, b: npt.ArrayLike) -> Array:
    """Dot product of float32 vectors, as if summed in twice the precision (Ogita, Rump and Oishi 2005)."""
    a, b = real(a), real(b)
    s, e = two_sum(a[..., 0] * b[..., 0], a[..., 1] * b[..., 1])
    total, rest = two_sum(s, a[..., 2] * b[..., 2])
    return np.asarray(total + (e + rest), dtype=np.float64)


def cosine(a: npt.ArrayLike, b: npt.ArrayLike) -> Array:
    """Cosine of the angle between two float32 vectors of any length > 0."""
    return np.asarray(np.clip(exact_dot(a, b) / (length(a) * length(b)), -1.0, 1.0), dtype=np.float64)


def sine(a: npt.ArrayLike, b: npt.ArrayLike) -> Array:
    """Sine of the angle between two float32 vectors, flat in relative error; 0 for a zero vector."""
    sizes = length(a) * length(b)
    return np.minimum(length(np.cross(real(a), real(b))) / np.where(sizes > 0.0, sizes, 1.0), 1.0)


def safe_unit(x: npt.ArrayLike, fallback: npt.ArrayLike) -> Array:
    """Direction of x, or the fallback where x is the zero vector."""
    x = real(x)
    return np.where((length(x) > 0.0)[..., None], unit(x), real(fallback))


def frame_tangent_and_bitangent(n: npt.ArrayLike) -> tuple[Array, Array]:
    """The two axes that Duff et al. 2017 attach to a unit normal, with s = n.z >= 0 ? 1 : -1."""
    n = unit(n)
    x, y, z = n[..., 0], n[..., 1], n[..., 2]
    s = np.where(z >= 0.0, 1.0, -1.0)
    a = -1.0 / (s + z)
    b = x * y * a
    return stack(1.0 + s * x * x * a, s * b, -s * x), stack(b, s + y * y * a, -y)


def mirror(v: Array, h: Array) -> Array:
    """2 (v.h) h - v for float64 directions."""
    return np.asarray(2.0 * column(total(v * h)) * h - v, dtype=np.float64)


def power(base: npt.ArrayLike, exponent: npt.ArrayLike) -> Array:
    """base^exponent as documented: exponent 0 gives 1 everywhere, else base <= 0 gives 0."""
    base, exponent = np.broadcast_arrays(real(base), real(exponent))
    raised = np.power(np.where(base > 0.0, base, 1.0), exponent)
    return np.where(exponent == 0.0, 1.0, np.where(base > 0.0, raised, 0.0))


def power_of_one_minus(q: npt.ArrayLike, exponent: npt.ArrayLike) -> Array:
    """(1 - q)^exponent; q >= 1 gives 0, or 1 where the exponent is 0."""
    q, exponent = np.broadcast_arrays(real(q), real(exponent))
    inside = q < 1.0
    raised = np.exp(exponent * np.log1p(-np.where(inside, q, 0.0)))
    return np.where(exponent == 0.0, 1.0, np.where(inside, raised, 0.0))


def hermite_step(low: npt.ArrayLike, high: npt.ArrayLike, x: npt.ArrayLike) -> Array:
    """Smoothstep from low to high; equal edges: 0 below, 1 at and above; reversed edges descend."""
    low, high, x = np.broadcast_arrays(real(low), real(high), real(x))
    span = high - low
    s = np.clip((x - low) / np.where(span == 0.0, 1.0, span), 0.0, 1.0)
    return np.where(span == 0.0, np.where(x >= low, 1.0, 0.0), s * s * (3.0 - 2.0 * s))
