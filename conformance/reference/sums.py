"""Sums and rejections of directions that stay precise where the terms nearly cancel."""

from __future__ import annotations

from typing import Any

import numpy as np

from conformance.reference.exact import Array, column, length, real, safe_unit


def dot(a: Array, b: Array) -> Array:
    """Plain scalar product over the last axis, for vectors that are float64 already."""
    return np.asarray((a * b).sum(axis=-1), dtype=np.float64)


def direction_sum(a: Any, s: Any, b: Any) -> Array:
    """a / |a| + s b / |b|.

    With u = s b it equals ((a + u) (|a| + |b|) + (a - u) (|b| - |a|)) / (2 |a| |b|), whose differences of
    given numbers are exact or nearly so; |b| - |a| = (b - a).(b + a) / (|b| + |a|) is small where a and b are
    parallel.
    """
    first, second = real(a), real(b)
    u = column(s) * second
    size_first, size_second = length(first), length(second)
    both = size_first + size_second
    excess = dot(second - first, second + first) / both
    total = column(both) * (first + u) + column(excess) * (first - u)
    return np.asarray(total / column(2.0 * size_first * size_second), dtype=np.float64)


def rejection(x: Any, axis: Any) -> Array:
    """The part of x orthogonal to the axis: axis x (x x axis) / |axis|^2 does not cancel near the axis."""
    wide_x, wide_axis = real(x), real(axis)
    across = np.cross(wide_axis, np.cross(wide_x, wide_axis))
    return np.asarray(across / column(dot(wide_axis, wide_axis)), dtype=np.float64)


def rejection_direction(x: Any, axis: Any, fallback: Array) -> Array:
    """The direction of that part; `fallback` where x and the axis are parallel."""
    return safe_unit(rejection(x, axis), fallback)
