"""Interpolations as Mesa computes them: (1 - c) a + c b as a + c (b - a), and the other way round.

Mesa 22.3.6 recognises an interpolation, and drivers without an instruction for it get one of the two forms:
softpipe the second, which loses a small c's complement, llvmpipe the first. GLSL allows factoring and
distribution without `precise`, and names them (4.7.1 of GLSL 4.60).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from codegen.ir import nodes as ir
from codegen.ir.types import F32

ONE = ir.Const(F32, 1.0)


def interpolated(function: ir.Function) -> ir.Function:
    """The function with every such sum in its second form."""
    return replace(function, body=ir.map_body(function.body, _second_form))


def weighted(function: ir.Function) -> ir.Function:
    """The function with every sum of the second form in the first: h + s (1 - h) is one, as (1 - s) h + s."""
    return replace(function, body=ir.map_body(function.body, _first_form))


def _first_form(e: ir.Expr) -> ir.Expr:
    if not (isinstance(e, ir.Binary) and e.op == "+"):
        return e
    for a, product in ((e.left, e.right), (e.right, e.left)):
        for c, slope in _factors(product):
            for b, taken in _differences(slope):
                if taken == a and a.type == b.type == c.type == e.type == F32:
                    share = ir.Binary(F32, "-", ONE, c)
                    first = ir.Binary(F32, "*", share, a)
                    second = c if b == ONE else ir.Binary(F32, "*", c, b)
                    return ir.Binary(F32, "+", first, second)
    return e


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


def _differences(e: ir.Expr) -> Iterator[tuple[ir.Expr, ir.Expr]]:
    """What is taken from what, however the difference is written: b - a, b + -a, -a + b."""
    if isinstance(e, ir.Binary) and e.op == "-":
        yield e.left, e.right
    if isinstance(e, ir.Binary) and e.op == "+":
        for b, negated in ((e.left, e.right), (e.right, e.left)):
            if isinstance(negated, ir.Unary) and negated.op == "negate":
                yield b, negated.operand


def _is_complement(share: ir.Expr, c: ir.Expr) -> bool:
    """Whether one expression is 1 minus the other."""
    return any(isinstance(b, ir.Const) and b.value == 1.0 and taken == c for b, taken in _differences(share))
