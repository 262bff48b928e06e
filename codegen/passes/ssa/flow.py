"""A function as values in single assignment: what is computed, apart from where and under which name.

A branch or loop binds leaves: variables that only it gives. Every other value is an expression over leaves,
so it may be computed anywhere those are known; codegen.passes.placement.schedule decides where.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from codegen.ir import nodes as ir
from codegen.passes.ssa.values import Value


@dataclass
class Merge:
    """A value that depends on the way taken: `leaf` stands for it behind the branch."""

    leaf: ir.Var
    name: str
    then: ir.Expr
    orelse: ir.Expr


@dataclass
class Branch:
    """Two ways, and the values that they leave behind."""

    condition: ir.Expr
    then: list[Item]
    orelse: list[Item]
    merges: list[Merge]


@dataclass
class Carried:
    """A value that an iteration hands to the next: `inside` at its start, `outside` behind the loop."""

    inside: ir.Var
    outside: ir.Var
    name: str
    initial: ir.Expr
    following: ir.Expr


@dataclass
class Loop:
    """A counted loop; `limit` ends it early."""

    index: ir.Var
    name: str
    start: int
    stop: int
    limit: ir.Expr | None
    body: list[Item]
    carried: list[Carried]


Item = Branch | Loop


@dataclass
class Flow:
    """Branches and loops in order, and the function's value."""

    items: list[Item]
    result: Value


def roots(items: list[Item]) -> Iterator[ir.Expr]:
    """Every value that branches and loops use, nested ones included, in the order of the program."""
    for item in items:
        if isinstance(item, Branch):
            yield item.condition
            yield from roots(item.then)
            yield from roots(item.orelse)
            for m in item.merges:
                yield from (m.then, m.orelse)
        else:
            if item.limit is not None:
                yield item.limit
            yield from roots(item.body)
            for c in item.carried:
                yield from (c.initial, c.following)
