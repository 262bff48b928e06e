"""Forms that are equal as real numbers and cheaper, but lose digits where vectors are nearly parallel.

The library prefers sums and differences of vectors, which keep every digit near the hair. A scene whose
budget does not need those digits may take these back, one by one, each judged by the error that it makes.

before   across = cross(t - l, t + l); sin_l = 0.5 * sqrt(dot(across, across)); dot(t, l + v)
after    c = dot(t, l); sin_l = sqrt(max(1 - c * c, 0)); dot(t, l) + dot(t, v)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from codegen.ir import nodes as ir
from codegen.ir.types import F32, VEC3, Scalar, Vector

Definitions = Mapping[str, ir.Expr]


@dataclass(frozen=True)
class Form:
    """One change of form: its name, what it does in words, and the change of one expression (or None)."""

    name: str
    words: str
    change: Callable[[ir.Expr, Definitions], ir.Expr | None]


def loosened(function: ir.Function, form: Form) -> ir.Function | None:
    """The function with the form wherever it applies; None where it does nowhere."""
    definitions = {
        s.name: s.value for s in ir.statements(function.body) if isinstance(s, ir.Let) and not s.mutable
    }
    changed = 0

    def visit(e: ir.Expr) -> ir.Expr:
        nonlocal changed
        found = form.change(e, definitions)
        if found is None:
            return e
        changed += 1
        return found

    body = ir.map_body(function.body, visit)
    return replace(function, body=body) if changed else None


def _number(value: float) -> ir.Expr:
    return ir.Const(F32, value)


def _looked_up(e: ir.Expr, definitions: Definitions) -> ir.Expr:
    while isinstance(e, ir.Var) and e.name in definitions:
        e = definitions[e.name]
    return e


def _double_cross(e: ir.Expr, definitions: Definitions) -> tuple[ir.Expr, ir.Expr] | None:
    """a and b where the expression is cross(a - b, a + b), which is 2 cross(a, b)."""
    e = _looked_up(e, definitions)
    factors = (e.args[0], e.args[1]) if isinstance(e, ir.Builtin) and e.op == "cross" else _written_out(e)
    return None if factors is None else _apart(*factors, definitions)


def _written_out(e: ir.Expr) -> tuple[ir.Expr, ir.Expr] | None:
    """The factors of a cross product that is written component by component."""
    if not (isinstance(e, ir.Construct) and e.type == VEC3 and len(e.args) == 3):
        return None
    first = e.args[0]
    if not (isinstance(first, ir.Binary) and isinstance(first.left, ir.Binary)):
        return None
    parts = first.left.left, first.left.right
    if not all(isinstance(x, ir.Swizzle) for x in parts):
        return None
    for x, y in (parts, parts[::-1]):
        assert isinstance(x, ir.Swizzle)
        assert isinstance(y, ir.Swizzle)
        if e.args == _components(x.value, y.value):
            return x.value, y.value
    return None


def _components(a: ir.Expr, b: ir.Expr) -> tuple[ir.Expr, ...]:
    def product(i: str, j: str) -> ir.Expr:
        return ir.Binary(F32, "*", ir.Swizzle(F32, a, i), ir.Swizzle(F32, b, j))

    return tuple(ir.Binary(F32, "-", product(i, j), product(j, i)) for i, j in ("yz", "zx", "xy"))


def _apart(minus: ir.Expr, plus: ir.Expr, definitions: Definitions) -> tuple[ir.Expr, ir.Expr] | None:
    """a and b of a - b and a + b."""
    minus, plus = _looked_up(minus, definitions), _looked_up(plus, definitions)
    if not (isinstance(minus, ir.Binary) and isinstance(plus, ir.Binary)):
        return None
    if minus.op != "-" or plus.op != "+":
        return None
    pair = minus.left, minus.right
    return pair if (plus.left, plus.right) in (pair, pair[::-1]) else None


def _sine_of(e: ir.Expr, definitions: Definitions) -> tuple[ir.Expr, ir.Expr] | None:
    """a and b where the expression is sqrt(|a - b|^2 |a + b|^2) or the length of cross(a - b, a + b): twice
    the sine of their angle."""
    if not (isinstance(e, ir.Builtin) and e.op == "sqrt"):
        return None
    square = _looked_up(e.args[0], definitions)
    pair = None
    if isinstance(square, ir.Builtin) and square.op == "dot" and square.args[0] == square.args[1]:
        pair = _double_cross(square.args[0], definitions)
    elif isinstance(square, ir.Binary) and square.op == "*":
        sides = [_self_dot(side, definitions) for side in (square.left, square.right)]
        if sides[0] is not None and sides[1] is not None:
            pair = _apart(sides[0], sides[1], definitions) or _apart(sides[1], sides[0], definitions)
    return pair


def _sine_by_cosine(e: ir.Expr, definitions: Definitions) -> ir.Expr | None:
    """Twice a sine: 2 sqrt(max(1 - (a.b)^2, 0))."""
    pair = _sine_of(e, definitions)
    if pair is None:
        return None
    c = ir.Builtin(F32, "dot", pair)
    left = ir.Binary(F32, "-", _number(1.0), ir.Binary(F32, "*", c, c))
    root = ir.Builtin(F32, "sqrt", (ir.Builtin(F32, "max", (left, _number(0.0))),))
    return ir.Binary(F32, "*", _number(2.0), root)


def _sine_by_cross(e: ir.Expr, definitions: Definitions) -> ir.Expr | None:
    """Twice a sine: 2 |a x b|."""
    pair = _sine_of(e, definitions)
    if pair is None:
        return None
    product = ir.Builtin(VEC3, "cross", pair)
    root = ir.Builtin(F32, "sqrt", (ir.Builtin(F32, "dot", (product, product)),))
    return ir.Binary(F32, "*", _number(2.0), root)


def _sine_by_rejection(e: ir.Expr, definitions: Definitions) -> ir.Expr | None:
    """Twice a sine: 2 |b - (a.b) a|."""
    pair = _sine_of(e, definitions)
    if pair is None:
        return None
    a, b = pair
    rest = ir.Binary(VEC3, "-", b, ir.Binary(VEC3, "*", ir.Builtin(F32, "dot", (a, b)), a))
    root = ir.Builtin(F32, "sqrt", (ir.Builtin(F32, "dot", (rest, rest)),))
    return ir.Binary(F32, "*", _number(2.0), root)


def _self_dot(e: ir.Expr, definitions: Definitions) -> ir.Expr | None:
    e = _looked_up(e, definitions)
    if isinstance(e, ir.Builtin) and e.op == "dot" and e.args[0] == e.args[1]:
        return e.args[0]
    return None


def _plain_cross(e: ir.Expr, definitions: Definitions) -> ir.Expr | None:
    """cross(a - b, a + b): 2 cross(a, b)."""
    pair = None if isinstance(e, ir.Var) else _double_cross(e, definitions)
    if pair is None:
        return None
    return ir.Binary(VEC3, "*", ir.Construct(VEC3, (_number(2.0),)), ir.Builtin(VEC3, "cross", pair))


def _dot_of_sum(e: ir.Expr, definitions: Definitions) -> ir.Expr | None:
    """a.(b + c): a.b + a.c, which other terms may have computed already."""
    if not (isinstance(e, ir.Builtin) and e.op == "dot"):
        return None
    for one, other in (e.args, e.args[::-1]):
        total = _looked_up(other, definitions)
        if (
            isinstance(total, ir.Binary)
            and total.op == "+"
            and total.left.type == total.right.type == one.type
        ):
            parts = (ir.Builtin(F32, "dot", (one, part)) for part in (total.left, total.right))
            return ir.Binary(F32, "+", *parts)
    return None


def _mirror_cosine(e: ir.Expr, definitions: Definitions) -> ir.Expr | None:
    """1 - ((x - y)^2 + (a + b)^2) / 2 with sines x, y and cosines a, b of two angles: x y - a b."""
    if not (isinstance(e, ir.Binary) and e.op == "-" and e.left == _number(1.0)):
        return None
    half = _looked_up(e.right, definitions)
    if not (isinstance(half, ir.Binary) and half.op == "*" and half.left == _number(0.5)):
        return None
    squares = _looked_up(half.right, definitions)
    if not (isinstance(squares, ir.Binary) and squares.op == "+"):
        return None
    found: dict[str, ir.Binary] = {}
    for side in (squares.left, squares.right):
        square = _looked_up(side, definitions)
        if not (isinstance(square, ir.Binary) and square.op == "*" and square.left == square.right):
            return None
        root = _looked_up(square.left, definitions)
        if isinstance(root, ir.Binary) and root.op in "+-":
            found[root.op] = root
    if set(found) != {"+", "-"}:
        return None
    sines, cosines = found["-"], found["+"]
    return ir.Binary(
        F32,
        "-",
        ir.Binary(F32, "*", sines.left, sines.right),
        ir.Binary(F32, "*", cosines.left, cosines.right),
    )


def _factor_inside(e: ir.Expr, definitions: Definitions) -> ir.Expr | None:
    """(a x + h) w with scalars x, h, w, as a (x w) + h w: two products of scalars for one of a vector."""
    if not (isinstance(e, ir.Binary) and e.op == "*" and isinstance(e.type, Vector)):
        return None
    for total, factor in ((e.left, e.right), (e.right, e.left)):
        total = _looked_up(total, definitions)
        if isinstance(total, ir.Binary) and total.op in "+-" and factor.type == F32:
            sides = [_onto_scalar(_looked_up(s, definitions), factor) for s in (total.left, total.right)]
            if sides[0] is not None and sides[1] is not None:
                return replace(total, left=sides[0], right=sides[1])
    return None


def _onto_scalar(e: ir.Expr, factor: ir.Expr) -> ir.Expr | None:
    """A vector that is a multiple by a scalar, or has equal components, times a scalar."""
    if isinstance(e, ir.Construct) and len(e.args) == 1:
        return replace(e, args=(ir.Binary(F32, "*", e.args[0], factor),))
    if isinstance(e, ir.Binary) and e.op == "*":
        if e.right.type == F32:
            return replace(e, right=ir.Binary(F32, "*", e.right, factor))
        if e.left.type == F32:
            return replace(e, left=ir.Binary(F32, "*", e.left, factor))
    return None


def _one_product(e: ir.Expr, definitions: Definitions) -> ir.Expr | None:
    """A vector of equal components times a scalar: one product, then the vector. Exact."""
    if not (isinstance(e, ir.Binary) and e.op == "*" and isinstance(e.type, Vector)):
        return None
    for vector, scalar in ((e.left, e.right), (e.right, e.left)):
        splat = isinstance(vector, ir.Construct) and len(vector.args) == 1
        if splat and isinstance(scalar.type, Scalar) and isinstance(vector, ir.Construct):
            product = ir.Binary(e.type.element, "*", vector.args[0], scalar)
            return ir.Construct(e.type, (product,))
    return None


SPLAT = Form("one product", "equal components by one product", _one_product)
"""Exact: it needs no budget."""
COSINE = Form("sine by cosine", "sines as sqrt(1 - cosine^2)", _sine_by_cosine)
CROSS = Form("sine by cross product", "sines as |a x b|", _sine_by_cross)
REJECTION = Form("sine by rejection", "sines as |b - (a.b) a|", _sine_by_rejection)
PLAIN = Form("plain cross product", "(a - b) x (a + b) as 2 a x b", _plain_cross)
SPLIT = Form("dot of a sum", "a.(b + c) as a.b + a.c", _dot_of_sum)
MIRROR = Form("mirror cosine", "1 - defect as sin sin - cos cos", _mirror_cosine)
INSIDE = Form("factor inside", "(a x + h) w as a (x w) + h w", _factor_inside)
BUNDLES: tuple[tuple[Form, ...], ...] = (
    (COSINE, SPLIT, MIRROR),
    (COSINE, SPLIT),
    (COSINE,),
    (REJECTION, SPLIT, MIRROR),
    (CROSS, SPLIT, MIRROR),
    (REJECTION,),
    (CROSS,),
    (PLAIN,),
    (SPLIT, MIRROR),
    (SPLIT,),
    (INSIDE,),
)
"""What is tried together, cheapest first: a sum of dots pays only where its parts are there already."""
