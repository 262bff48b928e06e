"""Which operations a function uses, and what an accuracy table promises of them."""

from __future__ import annotations

from codegen.intervals import Table
from codegen.ir import nodes as ir
from codegen.library import Library

LEANS_ON = {
    "sqrt": ("inverse_sqrt", "/"),
    "dot": ("*", "+"),
    "cross": ("*", "-"),
    "length": ("sqrt", "dot"),
    "normalize": ("length", "inverse_sqrt", "dot", "*", "/"),
}
"""Operations in the formulas from which a table may inherit the promise of another."""


def operations(library: Library, name: str) -> frozenset[str]:
    """Operations of the registry on whose promises the intervals of a function may depend."""
    found: set[str] = set()
    for function in library.select([name]).functions:
        for e in ir.expressions(function.body):
            if isinstance(e, ir.Unary | ir.Binary | ir.Builtin):
                found.add(e.op)
            elif isinstance(e, ir.Convert):
                found.add("cast")
    while further := {used for op in found for used in LEANS_ON.get(op, ())} - found:
        found |= further
    return frozenset(found)


def promises(library: Library, name: str, table: Table) -> list[str]:
    """What a function's intervals depend on in a table, a line each: its settings, and rows by operation."""
    settings = f"{table.name} {table.rounding} {table.flush} {table.fused}"
    return [settings, *(f"{op} {table.row(op)!r}" for op in sorted(operations(library, name)))]
