"""Sums and products as compilers see them: across locals, loops and calls, their constants brought together.

    y = x + 3.0;  z = y + 3.0;  return 0.001 - z      becomes      -x + (0.001 - 3.0 - 3.0)

The function is first made one of single assignments, with loops unrolled and calls inlined; vectors are taken
apart. Each sum and each product of several operations is then one chain, whose constants stand first or last
(`chained`). What else may become of sums: conformance.programs.gathered.
"""

from __future__ import annotations

from collections.abc import Mapping
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

Known = Mapping[str, ir.Expr]
Signed = tuple[bool, ir.Expr]
"""Whether a term or a factor is negated, and the term."""


@dataclass
class Chain:
    """The terms of a sum with their signs, or the factors of a product."""

    constants: list[Signed]
    others: list[Signed]


def straightened(library: Library, name: str) -> Specialised:
    """The function under its own name, with single assignments, loops unrolled and calls inlined."""
    return specialise(library, name, kinds=("exact",), new_name=name, unroll=UNROLLED)


def chained(function: ir.Function, constants_first: bool) -> ir.Function:
    """A straightened function with its chains' constants together, before or behind the other terms."""
    body, known = scalars(function)
    return replace(function, body=ir.map_body(body, partial(_together, constants_first, known)))


def beyond_choices(function: ir.Function) -> ir.Function:
    """A straightened function with (c ? a : b) + x as c ? a + x : b + x."""
    body, known = scalars(function)
    return replace(function, body=ir.map_body(body, partial(_beyond_choices, known)))


def scalars(function: ir.Function) -> tuple[tuple[ir.Stmt, ...], Known]:
    """A straightened function's statements, component by component, and the values of its locals."""
    body = ir.map_body(ir.map_body(componentwise(function).body, without_cross), _settled)
    return body, {s.name: s.value for s in ir.statements(body) if isinstance(s, ir.Let) and not s.mutable}


def adds(e: ir.Expr) -> bool:
    """Whether it is a sum or a difference of floats."""
    return isinstance(e, ir.Binary) and e.type == F32 and e.op in ("+", "-")


def _settled(e: ir.Expr) -> ir.Expr:
    """clamp(x, c, c) is c, and x times -1 is -x."""
    match e:
        case ir.Builtin(op="clamp", args=(_, ir.Const() as low, high)) if low == high:
            return low
        case ir.Binary(op="*", type=type_, left=x, right=ir.Const(value=-1.0)) if type_ == F32:
            return ir.Unary(F32, "negate", x)
        case ir.Binary(op="*", type=type_, left=ir.Const(value=-1.0), right=x) if type_ == F32:
            return ir.Unary(F32, "negate", x)
    return e


def _beyond_choices(known: Known, e: ir.Expr) -> ir.Expr:
    if not adds(e):
        return e
    assert isinstance(e, ir.Binary)
    left, right = meaning(known, e.left), meaning(known, e.right)
    if isinstance(left, ir.Select):
        sides = [replace(e, left=side) for side in (left.if_true, left.if_false)]
        return ir.Select(F32, left.condition, *sides)
    if isinstance(right, ir.Select):
        sides = [replace(e, right=side) for side in (right.if_true, right.if_false)]
        return ir.Select(F32, right.condition, *sides)
    return e


def _together(constants_first: bool, known: Known, e: ir.Expr) -> ir.Expr:
    if e.type != F32 or not isinstance(e, ir.Binary) or e.op not in ("+", "-", "*"):
        return e
    chain = Chain([], [])
    is_sum = e.op != "*"
    collect(known, e, False, is_sum, chain)
    count = len(chain.constants) + len(chain.others)
    if not 3 <= count <= LONGEST or not chain.constants or not chain.others:
        return e
    folded = joined(chain.constants, is_sum)
    rest = joined(chain.others, is_sum)
    if constants_first:
        return joined([(False, folded), *chain.others], is_sum)
    return ir.Binary(F32, "+" if is_sum else "*", rest, folded)


def meaning(known: Known, e: ir.Expr) -> ir.Expr:
    """What an expression stands for, through locals and components: equal meanings are one value."""
    while True:
        if isinstance(e, ir.Var) and e.name in known:
            e = known[e.name]
        elif isinstance(e, ir.Swizzle) and len(e.components) == 1:
            found = _component(known, e.value, "xyzw".index(e.components))
            if isinstance(found, ir.Swizzle):
                return found
            e = found
        else:
            return e


def collect(known: Known, e: ir.Expr, negative: bool, is_sum: bool, chain: Chain) -> None:
    """Add the terms of an expression to the chain, looking through locals and components."""
    if len(chain.constants) + len(chain.others) > LONGEST:
        chain.others.append((negative, e))
        return
    seen = _looked_through(known, e)
    match seen:
        case ir.Binary(op=("+" | "-") as op) if is_sum:
            collect(known, seen.left, negative, is_sum, chain)
            collect(known, seen.right, negative != (op == "-"), is_sum, chain)
        case ir.Binary(op="*") if not is_sum:
            collect(known, seen.left, negative, is_sum, chain)
            collect(known, seen.right, False, is_sum, chain)
        case ir.Unary(op="negate"):
            collect(known, seen.operand, not negative, is_sum, chain)
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
            found = _component(known, e.value, "xyzw".index(e.components))
            found = found if isinstance(found, ir.Swizzle) else _looked_through(known, found)
        case _:
            return e
    is_negated = isinstance(found, ir.Unary) and found.op == "negate"
    return found if is_negated or isinstance(found, ir.Binary | ir.Const) else e


def _component(known: Known, e: ir.Expr, k: int) -> ir.Expr:
    """A vector's component, through locals, swizzles and constructors."""
    assert isinstance(e.type, Vector)
    match e:
        case ir.Var() if e.name in known:
            return _component(known, known[e.name], k)
        case ir.Swizzle():
            return _component(known, e.value, "xyzw".index(e.components[k]))
        case ir.Select():
            a, b = _component(known, e.if_true, k), _component(known, e.if_false, k)
            same = meaning(known, a) == meaning(known, b)
            return a if same else ir.Select(e.type.element, e.condition, a, b)
        case ir.Construct(args=(only,)) if not isinstance(only.type, Vector):
            return only
        case ir.Construct():
            for part in e.args:
                size = part.type.size if isinstance(part.type, Vector) else 1
                if k < size:
                    return _component(known, part, k) if isinstance(part.type, Vector) else part
                k -= size
    return ir.Swizzle(e.type.element, e, "xyzw"[k])


def _is_constant(e: ir.Expr) -> bool:
    """A constant, or an operation on constants alone."""
    operands = tuple(ir.children(e))
    return isinstance(e, ir.Const) or (
        isinstance(e, ir.Binary | ir.Unary) and all(map(_is_constant, operands))
    )


def joined(terms: list[Signed], is_sum: bool) -> ir.Expr:
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
