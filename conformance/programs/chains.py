"""Sums and products as compilers see them: across locals, loops and calls, their constants brought together.

    y = x + 3.0;  z = y + 3.0;  return 0.001 - z      becomes      -x + (0.001 - 3.0 - 3.0)

The function is first made one of single assignments, with loops unrolled and calls inlined; vectors are taken
apart. Each sum and each product of several operations is then one chain, whose constants stand first or last.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial

from codegen.ir import nodes as ir
from codegen.ir.types import F32, Vector
from codegen.library import Library
from codegen.passes.specialise import Specialised, specialise
from conformance.fuzz.choices import Choice
from conformance.metamorphic.source.vectors import RELATIONS

UNROLLED = 16
"""Turns of a loop that compilers write out."""
LONGEST = 64
"""Terms of a chain that is looked at."""
(SCALAR_PATH,) = RELATIONS

Known = Mapping[str, ir.Expr]


@dataclass
class _Chain:
    """The terms of a sum with their signs, or the factors of a product."""

    constants: list[tuple[bool, ir.Expr]]
    others: list[tuple[bool, ir.Expr]]


def straightened(library: Library, name: str) -> Specialised:
    """The function under its own name, with single assignments, loops unrolled and calls inlined."""
    return specialise(library, name, kinds=(), new_name=name, unroll=UNROLLED)


def chained(function: ir.Function, library: Library, constants_first: bool) -> ir.Function:
    """A straightened function with its chains' constants together, before or behind the other terms."""
    apart = SCALAR_PATH.apply(function, library, Choice(0))
    body = (apart.function if apart else function).body
    known = {s.name: s.value for s in ir.statements(body) if isinstance(s, ir.Let) and not s.mutable}
    return replace(function, body=ir.map_body(body, partial(_together, known, constants_first)))


def _together(known: Known, constants_first: bool, e: ir.Expr) -> ir.Expr:
    if e.type != F32 or not isinstance(e, ir.Binary) or e.op not in ("+", "-", "*"):
        return e
    chain = _Chain([], [])
    is_sum = e.op != "*"
    _collect(known, e, False, is_sum, chain)
    count = len(chain.constants) + len(chain.others)
    if not 3 <= count <= LONGEST or not chain.constants or not chain.others:
        return e
    folded = _joined(chain.constants, is_sum)
    rest = _joined(chain.others, is_sum)
    if constants_first:
        return _joined([(False, folded), *chain.others], is_sum)
    return ir.Binary(F32, "+" if is_sum else "*", rest, folded)


def _collect(known: Known, e: ir.Expr, negative: bool, is_sum: bool, chain: _Chain) -> None:
    """Add the terms of an expression to the chain, looking through locals and components."""
    seen = _looked_through(known, e)
    match seen:
        case ir.Binary(op=("+" | "-") as op) if is_sum:
            _collect(known, seen.left, negative, is_sum, chain)
            _collect(known, seen.right, negative != (op == "-"), is_sum, chain)
        case ir.Binary(op="*") if not is_sum:
            _collect(known, seen.left, negative, is_sum, chain)
            _collect(known, seen.right, False, is_sum, chain)
        case ir.Unary(op="negate"):
            _collect(known, seen.operand, not negative, is_sum, chain)
        case ir.Const():
            chain.constants.append((negative, seen))
        case _:
            chain.others.append((negative, e))


def _looked_through(known: Known, e: ir.Expr) -> ir.Expr:
    """What a local or a component of a vector stands for, where that is a chain's link; else itself."""
    match e:
        case ir.Var() if e.name in known:
            found = _looked_through(known, known[e.name])
        case ir.Swizzle(components=("x" | "y" | "z" | "w") as axis):
            value = e.value
            while isinstance(value, ir.Var) and value.name in known:
                value = known[value.name]
            if not isinstance(value, ir.Construct) or any(isinstance(a.type, Vector) for a in value.args):
                return e
            part = value.args["xyzw".index(axis) if len(value.args) > 1 else 0]
            found = _looked_through(known, part)
        case _:
            return e
    is_negated = isinstance(found, ir.Unary) and found.op == "negate"
    return found if is_negated or isinstance(found, ir.Binary | ir.Const) else e


def _joined(terms: list[tuple[bool, ir.Expr]], is_sum: bool) -> ir.Expr:
    """The chain of these terms, from left to right; a product's signs are put before its first factor."""
    if not is_sum:
        odd = sum(negative for negative, _ in terms) % 2 == 1
        terms = [(odd, terms[0][1]), *((False, e) for _, e in terms[1:])]
    negative, total = terms[0]
    if negative:
        total = ir.Unary(F32, "negate", total)
    for negative, e in terms[1:]:
        total = ir.Binary(F32, ("-" if negative else "+") if is_sum else "*", total, e)
    return total
