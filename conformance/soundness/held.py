"""Which lanes' intervals hold the exact value: surely, surely not, or to be decided in 50 digits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import mpmath
import numpy as np

from codegen.evaluate import evaluate
from codegen.intervals import Permitted, Table
from codegen.library import Library
from conformance.check.sample import rows
from conformance.soundness.enclosure import Array, Enclosure
from conformance.soundness.walk import Value, leaves

DIGITS = 50


@dataclass(frozen=True)
class Held:
    """Masks of lanes: `inside` and `outside` are proven; `open` is where the table promises nothing."""

    inside: Array
    outside: Array
    open: Array

    @property
    def undecided(self) -> Array:
        """Lanes of which the enclosure tells neither."""
        return np.asarray(~(self.inside | self.outside | self.open))


def held(found: Permitted, value: Value, lost: Array) -> Held:
    """Where intervals hold all of an enclosed value, and where they miss all of it in some component."""
    inside, outside = np.ones(len(lost), np.bool_), np.zeros(len(lost), np.bool_)
    for low, high, exact in zip(scalars(found.low), scalars(found.high), leaves(value), strict=True):
        least, most = (exact.low, exact.high) if isinstance(exact, Enclosure) else (exact, exact)
        inside &= (low <= least) & (most <= high)
        outside |= (most < low) | (least > high)
    open_ = ~found.guaranteed
    return Held(inside & ~lost & ~open_, outside & ~lost & ~open_, open_)


def precisely(library: Library, name: str, inputs: Mapping[str, Any], lanes: Array) -> list[Array]:
    """The exact value of some lanes in 50 digits, rounded to float64, scalar by scalar.

    Ends of intervals are float32 numbers, which rounding to float64 cannot cross.
    """
    if not len(lanes):
        return []
    with mpmath.workdps(DIGITS), np.errstate(all="ignore"):
        value = evaluate(library, name, rows(inputs, lanes), "mpmath")
    return [a.astype(np.float64) if a.dtype == object else a for a in scalars(value)]


def holds(found: Permitted, lanes: Array, precise: list[Array]) -> Array:
    """Which of some lanes' intervals hold the precise value."""
    inside = np.ones(len(lanes), np.bool_)
    for low, high, exact in zip(scalars(found.low), scalars(found.high), precise, strict=bool(len(lanes))):
        inside &= (low[lanes] <= exact) & (exact <= high[lanes])
    return inside


def scalars(value: Any) -> Iterator[Array]:
    """Every scalar of arrays, in order, (N,) each."""
    if isinstance(value, dict):
        for part in value.values():
            yield from scalars(part)
    elif value.ndim == 2:
        yield from (value[:, k] for k in range(value.shape[1]))
    else:
        yield value


def either_way(table: Table) -> Table:
    """The table with correct rounding to either neighbour: only then do intervals hold exact values.

    A table that rounds to nearest permits one float32 for 0.1 + 0.2, which is not the exact sum.
    """
    return replace(table, rounding="either")
