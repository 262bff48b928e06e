"""Many lanes block by block: what a block takes is small, stays in a core's cache, and is used again by the
next one. Every operation is the same on every lane, so values are the same to the bit.
"""

from __future__ import annotations

from collections.abc import Callable

from codegen.evaluate.arrays import Value
from codegen.evaluate.loops import joined, lanes

BLOCK = 8192
"""Lanes of a block: few enough for the cache, enough for what an interpreter spends on an operation."""


def block_by_block(
    run: Callable[[dict[str, Value], int], Value], inputs: dict[str, Value], count: int
) -> Value:
    """The value that `run` gives for inputs and their number of lanes."""
    if count <= BLOCK:
        return run(inputs, count)
    found = []
    for first in range(0, count, BLOCK):
        last = min(first + BLOCK, count)
        some = {name: lanes(value, first, last) for name, value in inputs.items()}
        found.append(run(some, last - first))
    return joined(found)
