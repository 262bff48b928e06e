"""The pieces of a sweep, and of the short one around the critical numbers of every function."""

from __future__ import annotations

from collections.abc import Iterator

from codegen.ir import nodes as ir
from codegen.ir.domains import Interval
from codegen.library import Library
from conformance.executor import Job
from conformance.sweep.positions import LARGEST, SMALLEST_NORMAL, Positions, order_of
from conformance.sweep.task import TASK

PIECE = 1 << 24
"""Numbers per piece: half a minute at the most."""
SHORT_TOTAL = 1 << 24
"""Numbers of the short sweep, over all functions."""
ALWAYS = (0.0, SMALLEST_NORMAL, 1e-30, 2.0**-24, 2.0**-12, 0.5, 1.0, 2.0)
"""Numbers around which something changes in many functions: zero, rounding of 1 + x, binades at 1."""


def pieces(
    function: str, target: str, where: Positions, start: int = 0, stop: int | None = None, step: int = 1
) -> list[Job]:
    """A sweep of places start to stop, every step-th, in pieces."""
    end = where.count if stop is None else min(stop, where.count)
    span = PIECE * step
    return [Job(TASK, function, target, k, min(k + span, end), step) for k in range(start, end, span)]


def short(library: Library, swept: dict[str, Positions], target: str) -> list[Job]:
    """Windows around the critical numbers of every function, SHORT_TOTAL numbers in all."""
    share = SHORT_TOTAL // len(swept)
    jobs = []
    for name, where in swept.items():
        places = sorted({where.place(x) for x in critical(library, name, where)})
        width = share // len(places)
        windows = merged([(max(p - width // 2, 0), min(p + width // 2, where.count)) for p in places])
        jobs += [Job(TASK, name, target, start, stop) for start, stop in windows]
    return jobs


def merged(windows: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Sorted windows without overlaps."""
    found: list[tuple[int, int]] = []
    for start, stop in windows:
        if found and start <= found[-1][1]:
            found[-1] = (found[-1][0], max(stop, found[-1][1]))
        else:
            found.append((start, stop))
    return found


def critical(library: Library, name: str, where: Positions) -> list[float]:
    """Numbers worth a window: ends, the thresholds that the code compares with, ends of its bounds."""
    if not where.floats:
        return [0.0, float(1 << 24), float(1 << 31), float(where.last)]
    function = library.function(name)
    domain = function.parameters[0].domain
    found = {*ALWAYS, *(thresholds(library, function))}
    found |= {end for bound in library.bounds.get(name, ()) for ends in bound.where.values() for end in ends}
    if isinstance(domain, Interval):
        found |= {domain.low, domain.high}
    signed = found | {-x for x in found}
    return sorted(x for x in signed if abs(x) <= LARGEST and where.first <= order_of(x) <= where.last)


def thresholds(library: Library, function: ir.Function) -> Iterator[float]:
    """Constants with which a function, or what it calls, compares, or to which it clamps."""
    for called in library.select([function.name]).functions:
        for e in ir.expressions(called.body):
            parts: tuple[ir.Expr, ...] = ()
            if isinstance(e, ir.Binary) and e.op in ("<", "<=", ">", ">=", "==", "!="):
                parts = (e.left, e.right)
            elif isinstance(e, ir.Builtin) and e.op in ("min", "max", "clamp"):
                parts = e.args
            yield from (float(p.value) for p in parts if isinstance(p, ir.Const))
