"""What a target may return: the one place where results meet the accuracy tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from codegen.evaluate.arrays import Array, Value
from codegen.intervals import DEFAULT_TABLES, Permitted, permitted
from codegen.library import Library

LOOSEST_TABLE = "wgsl"
"""Judges what is computed without a device: float32 arithmetic with numpy's functions."""


@dataclass(frozen=True)
class Verdict:
    """Lane by lane: `wrong` is outside its interval, `open` is where the table promises nothing."""

    wrong: Array
    open: Array

    @property
    def judged(self) -> int:
        """Lanes for which the table promises something."""
        return int((~self.open).sum())


def table_of(target: str) -> str:
    """The accuracy table that judges a target's default dialect."""
    return DEFAULT_TABLES.get(target, LOOSEST_TABLE)


def intervals(library: Library, name: str, inputs: Mapping[str, Any], target: str) -> Permitted:
    """What a target may return for these inputs."""
    return permitted(library, name, inputs, table_of(target))


def judge(allowed: Permitted, value: Value) -> Verdict:
    """The verdict on one value."""
    return Verdict(wrong=~allowed.contains(value), open=~allowed.guaranteed)


def hull(first: Permitted, second: Permitted) -> list[tuple[Array, Array]]:
    """Ends of the union of two results' intervals, one pair (N,) per scalar; whole numbers as float64."""
    columns = zip(
        _columns(first.low), _columns(first.high), _columns(second.low), _columns(second.high), strict=True
    )
    return [(np.minimum(a, c), np.maximum(b, d)) for a, b, c, d in columns]


def distance_within(first: Permitted, second: Permitted, a: Value, b: Value) -> Array:
    """Mask of the lanes in which two values differ by no more than the width of their intervals' union."""
    near = [
        np.abs(x - y) <= high - low
        for (low, high), x, y in zip(hull(first, second), _columns(a), _columns(b), strict=True)
    ]
    return np.asarray(np.logical_and.reduce(near))


def equal(a: Value, b: Value) -> Array:
    """Mask of the lanes in which two values are equal, 0 and -0 too."""
    return np.asarray(np.logical_and.reduce([x == y for x, y in zip(_columns(a), _columns(b), strict=True)]))


def relative_width(allowed: Permitted) -> Array:
    """Width of the widest component relative to its magnitude, per lane; for reports."""
    widths = []
    for low, high in zip(_columns(allowed.low), _columns(allowed.high), strict=True):
        bounded = np.isfinite(low) & np.isfinite(high)
        a, b = np.where(bounded, low, 0.0), np.where(bounded, high, 0.0)
        size = np.maximum(np.maximum(np.abs(a), np.abs(b)), np.finfo(np.float32).tiny)
        widths.append(np.where(bounded, (b - a) / size, np.inf))
    return np.asarray(np.maximum.reduce(widths))


def _columns(value: Value) -> Iterator[Array]:
    """Every scalar of a value as float64 (N,); 32-bit integers fit exactly."""
    if isinstance(value, dict):
        for part in value.values():
            yield from _columns(part)
    elif value.ndim == 2:
        yield from (value[:, k].astype(np.float64) for k in range(value.shape[1]))
    else:
        yield value.astype(np.float64)
