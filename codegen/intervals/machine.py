"""Runs a program of interval operations over lanes, block by block, without the interpreter.

A program of codegen.intervals.program is a table of instructions over rows of lanes. All of it runs for one
block of lanes before the next: what it works on stays in the nearest cache, and Python does nothing between
two operations, so that threads run side by side. Imported only where numba is installed.
"""

from __future__ import annotations

from typing import Any

from codegen.intervals import loops, small_loops
from codegen.intervals.lanes import compiled, inlined
from codegen.intervals.opcodes import OPCODES

BLOCK = 2048
"""Lanes of a block: the arrays of an operation stay in the nearest caches."""


# Numbers as the compiler takes them.
ADD = OPCODES["add"]
SUBTRACT = OPCODES["subtract"]
MULTIPLY = OPCODES["multiply"]
SQUARE = OPCODES["square"]
ADD_NEAREST = OPCODES["add nearest"]
ADD_POINTS = OPCODES["add points"]
ADD_FUSED = OPCODES["add fused"]
FUSE = OPCODES["fuse"]
MULTIPLY_NEAREST = OPCODES["multiply nearest"]
MULTIPLY_POINTS = OPCODES["multiply points"]
SQUARE_NEAREST = OPCODES["square nearest"]
DIVIDE = OPCODES["divide"]
INVERSE_SQRT = OPCODES["inverse_sqrt"]
SQRT = OPCODES["sqrt"]
SMALLER = OPCODES["smaller"]
LARGER = OPCODES["larger"]
NEGATE = OPCODES["negate"]
SIZE = OPCODES["size"]
ABSOLUTE = OPCODES["absolute"]
FLOOR_POINT = OPCODES["floor point"]
FLOOR = OPCODES["floor"]
CLAMP = OPCODES["clamp"]
LESS = OPCODES["<"]
AT_MOST = OPCODES["<="]
EQUAL = OPCODES["=="]
AND = OPCODES["and"]
OR = OPCODES["or"]
SEEN = OPCODES["seen"]
CHOOSE = OPCODES["choose"]
CHOOSE_POINT = OPCODES["choose point"]


@inlined
def _step(
    c: Any, p: Any, rows: Any, truths: Any, first: Any, width: Any,
    seen: Any, begin: Any, end: Any,
) -> Any:  # fmt: skip
    """One instruction `c` with parameters `p` for one block; not 0 where a lane needs a closer look."""
    op = c[0]
    if op == ADD:
        return loops.add(
            rows[c[5], begin:end],
            rows[c[6], begin:end],
            rows[c[7], begin:end],
            rows[c[8], begin:end],
            rows[c[3], begin:end],
            rows[c[4], begin:end],
        )
    elif op == SUBTRACT:
        return loops.subtract(
            rows[c[5], begin:end],
            rows[c[6], begin:end],
            rows[c[7], begin:end],
            rows[c[8], begin:end],
            rows[c[3], begin:end],
            rows[c[4], begin:end],
        )
    elif op == MULTIPLY:
        return loops.multiply(
            rows[c[5], begin:end],
            rows[c[6], begin:end],
            rows[c[7], begin:end],
            rows[c[8], begin:end],
            rows[c[3], begin:end],
            rows[c[4], begin:end],
        )
    elif op == SQUARE:
        return loops.square(
            rows[c[5], begin:end], rows[c[6], begin:end], rows[c[3], begin:end], rows[c[4], begin:end]
        )
    elif op == ADD_NEAREST:
        return loops.add_nearest(
            rows[c[5], begin:end],
            rows[c[6], begin:end],
            rows[c[7], begin:end],
            rows[c[8], begin:end],
            rows[c[3], begin:end],
            rows[c[4], begin:end],
        )
    elif op == ADD_POINTS:
        return loops.add_points(rows[c[4], begin:end], rows[c[5], begin:end], rows[c[3], begin:end])
    elif op == ADD_FUSED:
        return loops.add_fused(
            rows[c[5], begin:end],
            rows[c[6], begin:end],
            rows[c[7], begin:end],
            rows[c[8], begin:end],
            rows[c[9], begin:end],
            rows[c[10], begin:end],
            rows[c[3], begin:end],
            rows[c[4], begin:end],
        )
    elif op == FUSE:
        return loops.fuse(
            rows[c[3], begin:end],
            rows[c[4], begin:end],
            rows[c[5], begin:end],
            rows[c[6], begin:end],
            rows[c[7], begin:end],
            rows[c[8], begin:end],
        )
    elif op == MULTIPLY_NEAREST:
        return loops.multiply_nearest(
            rows[c[7], begin:end],
            rows[c[8], begin:end],
            rows[c[9], begin:end],
            rows[c[10], begin:end],
            rows[c[3], begin:end],
            rows[c[4], begin:end],
            rows[c[5], begin:end],
            rows[c[6], begin:end],
        )
    elif op == MULTIPLY_POINTS:
        return loops.multiply_points(
            rows[c[5], begin:end], rows[c[6], begin:end], rows[c[3], begin:end], rows[c[4], begin:end]
        )
    elif op == SQUARE_NEAREST:
        return small_loops.square_nearest(
            rows[c[7], begin:end],
            rows[c[8], begin:end],
            rows[c[3], begin:end],
            rows[c[4], begin:end],
            rows[c[5], begin:end],
            rows[c[6], begin:end],
        )
    elif op == DIVIDE:
        return loops.divide(
            rows[c[5], begin:end],
            rows[c[6], begin:end],
            rows[c[7], begin:end],
            rows[c[8], begin:end],
            p[0],
            p[1],
            p[2],
            rows[c[3], begin:end],
            rows[c[4], begin:end],
        )
    elif op == INVERSE_SQRT:
        return loops.inverse_square_root(
            rows[c[5], begin:end], rows[c[6], begin:end], p[0], rows[c[3], begin:end], rows[c[4], begin:end]
        )
    elif op == SQRT:
        return loops.square_root(
            rows[c[5], begin:end],
            rows[c[6], begin:end],
            p[0],
            p[1],
            p[2],
            p[3],
            rows[c[3], begin:end],
            rows[c[4], begin:end],
        )
    elif op == SMALLER:
        small_loops.smaller(rows[c[4], begin:end], rows[c[5], begin:end], rows[c[3], begin:end])
    elif op == LARGER:
        small_loops.larger(rows[c[4], begin:end], rows[c[5], begin:end], rows[c[3], begin:end])
    elif op == NEGATE:
        small_loops.negate(rows[c[4], begin:end], rows[c[3], begin:end])
    elif op == SIZE:
        small_loops.size(rows[c[4], begin:end], rows[c[3], begin:end])
    elif op == ABSOLUTE:
        small_loops.absolute(
            rows[c[5], begin:end], rows[c[6], begin:end], rows[c[3], begin:end], rows[c[4], begin:end]
        )
    elif op == FLOOR_POINT:
        small_loops.floor_point(rows[c[4], begin:end], rows[c[3], begin:end])
    elif op == FLOOR:
        small_loops.floor(
            rows[c[5], begin:end],
            rows[c[6], begin:end],
            rows[c[3], begin:end],
            rows[c[4], begin:end],
            p[0],
            c[2],
            first[begin:end],
            width[begin:end],
        )
    elif op == CLAMP:
        small_loops.clamp(
            rows[c[5], begin:end],
            rows[c[6], begin:end],
            rows[c[7], begin:end],
            rows[c[8], begin:end],
            rows[c[9], begin:end],
            rows[c[10], begin:end],
            rows[c[3], begin:end],
            rows[c[4], begin:end],
        )
    elif op == LESS:
        true, false = (truths[c[3], begin:end], truths[c[4], begin:end])
        if loops.less(
            rows[c[5], begin:end],
            rows[c[6], begin:end],
            rows[c[7], begin:end],
            rows[c[8], begin:end],
            true,
            false,
        ):
            small_loops.note(true, false, c[2], first[begin:end], width[begin:end])
    elif op == AT_MOST:
        true, false = (truths[c[3], begin:end], truths[c[4], begin:end])
        if loops.at_most(
            rows[c[5], begin:end],
            rows[c[6], begin:end],
            rows[c[7], begin:end],
            rows[c[8], begin:end],
            true,
            false,
        ):
            small_loops.note(true, false, c[2], first[begin:end], width[begin:end])
    elif op == EQUAL:
        true, false = (truths[c[3], begin:end], truths[c[4], begin:end])
        if small_loops.equal(
            rows[c[5], begin:end],
            rows[c[6], begin:end],
            rows[c[7], begin:end],
            rows[c[8], begin:end],
            true,
            false,
        ):
            small_loops.note(true, false, c[2], first[begin:end], width[begin:end])
    elif op == AND:
        small_loops.conjunction(truths[c[5], begin:end], truths[c[7], begin:end], truths[c[3], begin:end])
        small_loops.disjunction(truths[c[6], begin:end], truths[c[8], begin:end], truths[c[4], begin:end])
    elif op == OR:
        small_loops.disjunction(truths[c[5], begin:end], truths[c[7], begin:end], truths[c[3], begin:end])
        small_loops.conjunction(truths[c[6], begin:end], truths[c[8], begin:end], truths[c[4], begin:end])
    elif op == SEEN:
        seen[c[2]] |= small_loops.seen(truths[c[3], begin:end], truths[c[4], begin:end])
    elif op == CHOOSE:
        loops.choose(
            truths[c[5], begin:end],
            truths[c[6], begin:end],
            rows[c[7], begin:end],
            rows[c[8], begin:end],
            rows[c[9], begin:end],
            rows[c[10], begin:end],
            rows[c[3], begin:end],
            rows[c[4], begin:end],
        )
    elif op == CHOOSE_POINT:
        return small_loops.choose_point(
            truths[c[4], begin:end],
            truths[c[5], begin:end],
            rows[c[6], begin:end],
            rows[c[7], begin:end],
            rows[c[3], begin:end],
        )
    return 0


@compiled
def run(
    code: Any, parameters: Any, rows: Any, truths: Any, first: Any,
    width: Any, seen: Any, count: int,
) -> int:  # fmt: skip
    """Run a table of instructions (K, WIDTH) over the lanes; not 0 as soon as one needs a closer look.

    rows, truths       float64 (R, N) and bool (T, N), read and written
    first, width       int32 (N,): first fork of a lane, -1: none, and its number of ways
    seen               int64 (G,): whether a condition may hold (1) and fail (2) anywhere
    """
    for begin in range(0, count, BLOCK):
        end = min(begin + BLOCK, count)
        for k in range(len(code)):
            if _step(
                code[k],
                parameters[k],
                rows,
                truths,
                first,
                width,
                seen,
                begin,
                end,
            ):
                return 1
    return 0
