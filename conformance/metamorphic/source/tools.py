"""What rewritings share: fresh names, changes of single nodes, statements put before others."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from codegen.ir import nodes as ir
from codegen.ir.domains import Interval
from codegen.ir.types import F32, Type


class Fresh:
    """Names that a function does not use."""

    def __init__(self, function: ir.Function, stem: str = "fresh") -> None:
        self.taken = names_of(function)
        self.stem = stem
        self.count = 0

    def __call__(self) -> str:
        while True:
            self.count += 1
            name = f"{self.stem}_{self.count}"
            if name not in self.taken:
                self.taken.add(name)
                return name


def names_of(function: ir.Function) -> set[str]:
    """Parameters and locals."""
    locals_ = {s.name for s in ir.statements(function.body) if isinstance(s, ir.Let | ir.For)}
    return {p.name for p in function.parameters} | locals_


def with_parameter(function: ir.Function, name: str, value: float) -> ir.Function:
    """The function with one more f32 parameter, which is always given that value."""
    parameter = ir.Parameter(name, F32, Interval(value, value))
    return replace(function, parameters=(*function.parameters, parameter))


def changed_body(function: ir.Function, change: Callable[[ir.Expr], ir.Expr]) -> ir.Function | None:
    """The function with `change` applied to every expression node; None where nothing changes."""
    body = ir.map_body(function.body, change)
    return None if body == function.body else replace(function, body=body)


def variables(e: ir.Expr) -> dict[str, Type]:
    """Names that an expression reads, with their types."""
    return {part.name: part.type for part in ir.walk(e) if isinstance(part, ir.Var)}


def values_of(s: ir.Stmt) -> Iterator[ir.Expr]:
    """Every expression below a statement."""
    return ir.expressions((s,))


Hoist = Callable[[ir.Expr, list[ir.Stmt]], ir.Expr]
"""Gives the expression that replaces one, and appends statements that are to stand before it."""


def hoisted(body: tuple[ir.Stmt, ...], hoist: Hoist) -> tuple[ir.Stmt, ...]:
    """The body with every expression rewritten, new statements before the one it stands in."""
    made: list[ir.Stmt] = []
    for s in body:
        before: list[ir.Stmt] = []
        match s:
            case ir.If():
                condition = hoist(s.condition, before)
                s = replace(
                    s, condition=condition, then=hoisted(s.then, hoist), orelse=hoisted(s.orelse, hoist)
                )
            case ir.For():
                s = replace(s, body=hoisted(s.body, hoist))
            case _:
                s = replace(s, value=hoist(s.value, before))
        made += [*before, s]
    return tuple(made)
