"""Sums and products as compilers see them: across locals, loops and calls, their constants brought together.

    y = x + 3.0;  z = y + 3.0;  return 0.001 - z      becomes      -x + (0.001 - 3.0 - 3.0)

    y = 1.5 * f;  return y - g - f                    becomes      (y - f) - g, or f * (1.5 - 1.0) - g

The function is first made one of single assignments, with loops unrolled and calls inlined; vectors are taken
apart. Each sum and each product of several operations is then one chain, whose constants stand first or last
(`chained`); or a short sum is taken in any order (`reordered`), its multiples of one value gathered into one
first (`gathered`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

from codegen.ir import nodes as ir
from codegen.ir.types import F32, Vector
from codegen.library import Library
from codegen.passes.specialise import Specialised, specialise
from conformance.programs.components import componentwise, without_cross

UNROLLED = 16
"""Turns of a loop that compilers write out."""
LONGEST = 64
"""Terms of a chain that is looked at."""
MOST_ORDERED = 5
"""Terms of a sum that is taken in any order: n terms have about 3^n partial sums."""

Known = Mapping[str, ir.Expr]


@dataclass
class _Chain:
    """The terms of a sum with their signs, or the factors of a product."""

    constants: list[tuple[bool, ir.Expr]]
    others: list[tuple[bool, ir.Expr]]


@dataclass
class _Multiple:
    """A term of a sum with its sign, and its factors, whose signs hold that of the term."""

    negative: bool
    term: ir.Expr
    factors: _Chain


def straightened(library: Library, name: str) -> Specialised:
    """The function under its own name, with single assignments, loops unrolled and calls inlined."""
    return specialise(library, name, kinds=(), new_name=name, unroll=UNROLLED)


def chained(function: ir.Function, constants_first: bool) -> ir.Function:
    """A straightened function with its chains' constants together, before or behind the other terms."""
    return _changed(function, partial(_together, constants_first))


def reordered(function: ir.Function) -> ir.Function:
    """A straightened function with short sums in any order, written as `dot` where a table says so of it."""
    return _changed(function, _reordered)


def gathered(function: ir.Function) -> ir.Function:
    """The same with multiples of one value in a sum gathered: a x + b x becomes x (a + b)."""
    return _changed(function, _gathered)


def _changed(function: ir.Function, change: Callable[[Known, ir.Expr], ir.Expr]) -> ir.Function:
    body = ir.map_body(componentwise(function).body, without_cross)
    known = {s.name: s.value for s in ir.statements(body) if isinstance(s, ir.Let) and not s.mutable}
    return replace(function, body=ir.map_body(body, partial(change, known)))


def _together(constants_first: bool, known: Known, e: ir.Expr) -> ir.Expr:
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


def _reordered(known: Known, e: ir.Expr) -> ir.Expr:
    if e.type != F32 or not isinstance(e, ir.Binary) or e.op not in ("+", "-"):
        return e
    chain = _Chain([], [])
    _collect(known, e, False, True, chain)
    return _in_any_order([*chain.others, *chain.constants], e)


def _in_any_order(terms: list[tuple[bool, ir.Expr]], otherwise: ir.Expr) -> ir.Expr:
    """The terms' inner product with ones, whose promise is a sum in any order; for few terms."""
    if not 3 <= len(terms) <= MOST_ORDERED:
        return otherwise
    signed = tuple(ir.Unary(F32, "negate", e) if negative else e for negative, e in terms)
    type_ = Vector(f"vec{len(terms)}", F32, len(terms))
    ones = ir.Construct(type_, tuple(ir.Const(F32, 1.0) for _ in terms))
    return ir.Builtin(F32, "dot", (ir.Construct(type_, signed), ones))


def _gathered(known: Known, e: ir.Expr) -> ir.Expr:
    if e.type != F32 or not isinstance(e, ir.Binary) or e.op not in ("+", "-"):
        return e
    chain = _Chain([], [])
    _collect(known, e, False, True, chain)
    if len(chain.others) > LONGEST:
        return e
    multiples: dict[tuple[str, ...], list[_Multiple]] = {}
    for negative, term in chain.others:
        factors = _Chain([], [])
        _collect(known, term, negative, False, factors)
        base = tuple(sorted(repr(_meaning(known, factor)) for _, factor in factors.others))
        multiples.setdefault(base, []).append(_Multiple(negative, term, factors))
    if all(len(of_one) == 1 for of_one in multiples.values()):
        return _in_any_order([*chain.others, *chain.constants], e)
    terms = [*map(_multiple, multiples.values()), *chain.constants]
    return _in_any_order(terms, _joined(terms, True))


def _multiple(of_one: list[_Multiple]) -> tuple[bool, ir.Expr]:
    """One multiple of a value, with its sign, from several."""
    if len(of_one) == 1:
        return of_one[0].negative, of_one[0].term
    base = _joined([(False, factor) for _, factor in of_one[0].factors.others], False)
    parts = []
    for multiple in of_one:
        signs = [negative for negative, _ in (*multiple.factors.constants, *multiple.factors.others)]
        constants = [(False, c) for _, c in multiple.factors.constants]
        parts.append((sum(signs) % 2 == 1, _joined(constants or [(False, ir.Const(F32, 1.0))], False)))
    return False, ir.Binary(F32, "*", base, _joined(parts, True))


def _meaning(known: Known, e: ir.Expr) -> ir.Expr:
    """What an expression stands for, through locals and components: equal meanings are one value."""
    seen = _looked_through(known, e)
    while isinstance(seen, ir.Var) and isinstance(known.get(seen.name), ir.Var):
        seen = known[seen.name]
    return seen


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
        case _ if _is_constant(seen):
            chain.constants.append((negative, seen))
        case _:
            chain.others.append((negative, e))


def _looked_through(known: Known, e: ir.Expr) -> ir.Expr:
    """What a local or a component of a vector stands for, where that is a chain's link; else itself."""
    match e:
        case ir.Var() if e.name in known:
            found = _looked_through(known, known[e.name])
        case ir.Swizzle() if len(e.components) == 1:
            value, k = _component(known, e.value, "xyzw".index(e.components))
            if not isinstance(value, ir.Construct) or any(isinstance(a.type, Vector) for a in value.args):
                return e
            found = _looked_through(known, value.args[k if len(value.args) > 1 else 0])
        case _:
            return e
    is_negated = isinstance(found, ir.Unary) and found.op == "negate"
    return found if is_negated or isinstance(found, ir.Binary | ir.Const) else e


def _component(known: Known, e: ir.Expr, k: int) -> tuple[ir.Expr, int]:
    """What a vector's component is a component of, through locals and swizzles, and its number there."""
    while True:
        if isinstance(e, ir.Var) and e.name in known:
            e = known[e.name]
        elif isinstance(e, ir.Swizzle):
            k = "xyzw".index(e.components[k])
            e = e.value
        else:
            return e, k


def _is_constant(e: ir.Expr) -> bool:
    """A constant, or an operation on constants alone."""
    operands = tuple(ir.children(e))
    return isinstance(e, ir.Const) or (
        isinstance(e, ir.Binary | ir.Unary) and all(map(_is_constant, operands))
    )


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
