"""Interpolations as Mesa's softpipe computes them: (1 - c) a + c b as a + c (b - a).

Mesa 22.3.6 recognises an interpolation, and drivers without an instruction for it get the second form, which
loses a small c's complement. GLSL allows factoring without `precise`, and names it (4.7.1 of GLSL 4.60).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from codegen.ir import nodes as ir


def interpolated(function: ir.Function) -> ir.Function:
    """The function with every such sum in its second form."""
    return replace(function, body=ir.map_body(function.body, _second_form))


def _second_form(e: ir.Expr) -> ir.Expr:
    if not (isinstance(e, ir.Binary) and e.op == "+"):
        return e
    for first, second in ((e.left, e.right), (e.right, e.left)):
        for share, a in _factors(first):
            for c, b in _factors(second):
                if _is_complement(share, c) and a.type == b.type == e.type:
                    slope = ir.Binary(e.type, "-", b, a)
                    return ir.Binary(e.type, "+", a, ir.Binary(e.type, "*", c, slope))
    return e


def _factors(e: ir.Expr) -> Iterator[tuple[ir.Expr, ir.Expr]]:
    """Both ways to read a product as a share of something."""
    if isinstance(e, ir.Binary) and e.op == "*":
        yield e.left, e.right
        yield e.right, e.left


def _is_complement(share: ir.Expr, c: ir.Expr) -> bool:
    """Whether one expression is 1 minus the other."""
    return (
        isinstance(share, ir.Binary)
        and share.op == "-"
        and isinstance(share.left, ir.Const)
        and share.left.value == 1.0
        and share.right == c
    )
