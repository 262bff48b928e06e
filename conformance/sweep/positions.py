"""The numbers of a domain in order: place 0 is the smallest, neighbours are one apart, -0 comes before +0."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.ir.domains import Finite, Interval
from codegen.ir.nodes import Function
from codegen.ir.types import F32, U32
from codegen.library import Library
from conformance.cases.domains import integer_range, inward
from conformance.check.engine import find_reference

LARGEST = 3.4028234663852886e38
SMALLEST_NORMAL = 2.0**-126


@dataclass(frozen=True)
class Positions:
    """All numbers from `first` to `last` (order numbers, both included) of one type."""

    floats: bool
    first: int
    last: int

    @property
    def count(self) -> int:
        return self.last - self.first + 1

    def values(self, start: int, stop: int, step: int = 1) -> npt.NDArray[Any]:
        """The numbers at places start, start + step, ... below stop, as float32 or uint32."""
        count = max(-(-(min(stop, self.count) - start) // step), 0)
        offsets = np.arange(count, dtype=np.uint32) * np.uint32(step)
        order = self.first + start
        if not self.floats:
            return np.uint32(order) + offsets
        below = min(max(-(order // step), 0), count)  # so many of them are negative
        offsets[:below] = np.uint32(0x7FFFFFFF - order if below else 0) - offsets[:below]
        if below < count:
            offsets[below:] += np.uint32(order % 2**32)
        return offsets.view(np.float32)

    def place(self, value: float) -> int:
        """The place of a number, or of the nearest end of the domain; of +0 for 0."""
        return min(max(order_of(value) if self.floats else int(value), self.first), self.last) - self.first


def order_of(value: float) -> int:
    """A float's number in the order of all floats: -0 is -1, +0 is 0."""
    word = int(np.float32(value).view(np.uint32))
    return word if word < 0x80000000 else -1 - (word & 0x7FFFFFFF)


def positions(function: Function) -> Positions | None:
    """The numbers of the only parameter's domain; None for a function that is not of one scalar."""
    if len(function.parameters) != 1:
        return None
    parameter = function.parameters[0]
    domain = parameter.domain
    if parameter.type == U32:
        low, high = integer_range(domain, signed=False)
        return Positions(False, low, high)
    if parameter.type != F32:
        return None
    if isinstance(domain, Interval):
        first, last = inward(domain.low, domain.high)
    elif isinstance(domain, Finite):
        first, last = -np.float32(LARGEST), np.float32(LARGEST)
    else:
        return None
    start = order_of(float(first))
    return Positions(True, -1 if start == 0 else start, order_of(float(last)))


def sweepable(library: Library) -> dict[str, Positions]:
    """The public functions of one scalar that have a reference, with their positions."""
    found = {name: positions(f) for name, f in library.public.items()}
    return {
        name: p
        for name, p in found.items()
        if p is not None and find_reference(library, library.function(name))
    }
