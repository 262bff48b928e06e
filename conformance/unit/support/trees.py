"""Random typed expressions over everything the registry and the IR offer.

The generator asks `choose` for every decision: a seeded generator for batches, Hypothesis for properties.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, TypeVar

from codegen.ir import nodes as ir
from codegen.ir.types import (
    BOOL,
    F32,
    I32,
    TEXTURE,
    U32,
    VALUE_TYPES,
    VEC3,
    Field,
    Struct,
    Type,
    Vector,
    vector_of,
)
from codegen.ops import BUILTINS, OPERATORS

T = TypeVar("T")
Choose = Callable[[Sequence[Any]], Any]

AXIS = Struct("Axis", (Field("angle", F32), Field("direction", VEC3)))
"""A struct, so that fields and constructors occur."""

PARAMETERS = (
    *(ir.Parameter(f"{type_.name}_{k}", type_, None) for type_ in VALUE_TYPES.values() for k in range(3)),
    *(ir.Parameter(f"axis_{k}", AXIS, None) for k in range(2)),
)

NUMBERS: dict[Type, tuple[float | int | bool, ...]] = {
    F32: (
        0.0,
        1.0,
        -1.0,
        0.5,
        -0.0,
        0.10000000149011612,
        16777216.0,
        3.4028234663852886e38,
        -1.1754943508222875e-38,
    ),
    U32: (0, 1, 7, 31, 255, 0x55555555, 0xFFFFFFFF),
    I32: (0, 1, -1, 41, 2147483647, -2147483647),
    BOOL: (True, False),
}


def expression(choose: Choose, type_: Type, depth: int) -> ir.Expr:
    """A random expression of a type; `depth` bounds its height."""
    if depth <= 0 or choose((False, False, False, True)):
        return _leaf(choose, type_)
    makers: list[Callable[[], ir.Expr]] = [
        lambda: _operation(choose, type_, depth),
        lambda: _operation(choose, type_, depth),
    ]
    if type_ in (F32, VEC3):
        makers.append(lambda: _member(choose, type_, depth))
    if isinstance(type_, Vector) or type_ in (F32, U32):
        makers.append(lambda: _swizzle(choose, type_, depth))
    if isinstance(type_, Vector | Struct):
        makers.append(lambda: _construct(choose, type_, depth))
    if not isinstance(type_, Struct):
        makers.append(lambda: _select(choose, type_, depth))
    if type_ in (F32, I32, U32):
        makers.append(lambda: _convert(choose, type_, depth))
    maker: Callable[[], ir.Expr] = choose(makers)
    return maker()


def _leaf(choose: Choose, type_: Type) -> ir.Expr:
    numbers = NUMBERS.get(type_)
    if numbers and choose((False, True)):
        return ir.Const(type_, choose(numbers))
    return choose([ir.Var(p.type, p.name) for p in PARAMETERS if p.type == type_])  # type: ignore[no-any-return]


def _operation(choose: Choose, type_: Type, depth: int) -> ir.Expr:
    rows = [
        (op, types)
        for op in (*OPERATORS.values(), *BUILTINS.values())
        for types, result in op.rule
        if result == type_ and TEXTURE not in types
    ]
    if not rows:
        return _leaf(choose, type_)
    op, types = choose(rows)
    args = tuple(expression(choose, t, depth - 1) for t in types)
    if op.name in BUILTINS:
        return ir.Builtin(type_, op.name, args)
    return ir.Unary(type_, op.name, *args) if len(args) == 1 else ir.Binary(type_, op.name, *args)


def _member(choose: Choose, type_: Type, depth: int) -> ir.Expr:
    field = next(f for f in AXIS.fields if f.type == type_)
    return ir.Member(type_, expression(choose, AXIS, depth - 1), field.name)


def _swizzle(choose: Choose, type_: Type, depth: int) -> ir.Expr:
    element, count = (type_.element, type_.size) if isinstance(type_, Vector) else (type_, 1)
    of: Vector = choose([v for v in VALUE_TYPES.values() if isinstance(v, Vector) and v.element == element])
    letters = "".join(choose("xyzw"[: of.size]) for _ in range(count))
    return ir.Swizzle(type_, expression(choose, of, depth - 1), letters)


def _construct(choose: Choose, type_: Vector | Struct, depth: int) -> ir.Expr:
    if isinstance(type_, Struct):
        parts: list[Type] = [f.type for f in type_.fields]
    else:
        splits = {
            2: [[1], [1, 1]],
            3: [[1], [1, 1, 1], [2, 1], [1, 2]],
            4: [[1], [1, 1, 1, 1], [2, 2], [3, 1], [1, 2, 1]],
        }
        parts = [t for n in choose(splits[type_.size]) if (t := vector_of(type_.element, n)) is not None]
    return ir.Construct(type_, tuple(expression(choose, part, depth - 1) for part in parts))


def _select(choose: Choose, type_: Type, depth: int) -> ir.Expr:
    condition, if_true, if_false = (expression(choose, t, depth - 1) for t in (BOOL, type_, type_))
    return ir.Select(type_, condition, if_true, if_false)


def _convert(choose: Choose, type_: Type, depth: int) -> ir.Expr:
    source = choose([t for t in (F32, I32, U32) if t != type_])
    return ir.Convert(type_, expression(choose, source, depth - 1))


def runnable(e: ir.Expr) -> ir.Expr:
    """The same tree with what a compiler evaluates, and may refuse, made variable.

    WGSL evaluates constant expressions and refuses overflow, division by zero and far shifts in them.
    """
    parts = [runnable(part) for part in ir.children(e)]
    if isinstance(e, ir.Binary) and isinstance(parts[1], ir.Const) and e.op in ("<<", ">>", "//", "%"):
        parts[1] = ir.Const(U32, 1 + int(parts[1].value) % 31)
    computes = isinstance(e, ir.Unary | ir.Binary | ir.Builtin | ir.Convert | ir.Select)
    if computes and not any(isinstance(part, ir.Var) for child in parts for part in ir.walk(child)):
        parts[0] = _variable(parts[0].type)
    return ir.rebuild(e, tuple(parts))


def _variable(type_: Type) -> ir.Var:
    parameter = next(p for p in PARAMETERS if p.type == type_)
    return ir.Var(type_, parameter.name)


def no_function(name: str) -> None:
    """The signatures of called functions where nothing may be called."""


def function_of(e: ir.Expr, name: str, place: Any) -> ir.Function:
    """A function of the variables that occur, returning the expression."""
    used = {part.name for part in ir.walk(e) if isinstance(part, ir.Var)}
    parameters = tuple(p for p in PARAMETERS if p.name in used) or PARAMETERS[:1]
    body = (ir.Return(e),)
    blank = ir.Function(name, "", "base", None, parameters, e.type, body, ir.Doc("", {}), place)
    return replace(blank)
