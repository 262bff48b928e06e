"""Smaller versions of a function's IR, one change at a time. Each is typed right; most are nonsense."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, U32, Scalar, Struct, Type, Vector

SIMPLE: dict[Type, float | int | bool] = {F32: 1.0, I32: 1, U32: 1, BOOL: True}
"""The literal that may stand for any expression of a type."""


def size(functions: tuple[ir.Function, ...]) -> int:
    """IR nodes of some functions: expression nodes; statements have at least one each."""
    return sum(sum(1 for _ in ir.expressions(f.body)) for f in functions)


def smaller(function: ir.Function) -> Iterator[ir.Function]:
    """Versions with one statement less, one block opened or one expression replaced; coarse changes first."""
    for body in _bodies(function.body):
        yield replace(function, body=body)
    yield from _results(function)


def _bodies(body: tuple[ir.Stmt, ...]) -> Iterator[tuple[ir.Stmt, ...]]:
    for k, s in enumerate(body):
        before, after = body[:k], body[k + 1 :]
        for replacement in _statement(s):
            yield (*before, *replacement, *after)
            if replacement and isinstance(replacement[-1], ir.Return) and after:
                yield (*before, *replacement)


def _statement(s: ir.Stmt) -> Iterator[tuple[ir.Stmt, ...]]:
    """What may stand for a statement: nothing, its blocks, itself with something smaller inside."""
    if not isinstance(s, ir.Return):
        yield ()
    match s:
        case ir.If():
            yield s.then
            yield s.orelse
            if s.orelse and not (s.then and isinstance(s.then[-1], ir.Return)):
                yield (replace(s, orelse=()),)
            for inner in _bodies(s.then):
                yield (replace(s, then=inner),)
            for inner in _bodies(s.orelse):
                yield (replace(s, orelse=inner),)
            for e in _expressions(s.condition):
                yield (replace(s, condition=e),)
        case ir.For():
            if s.stop - s.start > 1:
                yield (replace(s, stop=s.start + 1),)
            if s.limit is not None and s.limit.type == I32:
                yield (replace(s, limit=None),)
            for inner in _bodies(s.body):
                yield (replace(s, body=inner),)
        case _:
            for e in _expressions(s.value):
                yield (replace(s, value=e),)


def _expressions(e: ir.Expr) -> Iterator[ir.Expr]:
    """Expressions of the same type that are smaller: parts of it, a literal, or it with one smaller part."""
    for part in ir.walk(e):
        if part is not e and part.type == e.type:
            yield part
    simple = _simple(e.type)
    if simple is not None and e != simple and not isinstance(e, ir.Var):
        yield simple
    children = ir.children(e)
    for k, child in enumerate(children):
        for other in _expressions(child):
            yield ir.rebuild(e, (*children[:k], other, *children[k + 1 :]))


def _simple(type_: Type) -> ir.Expr | None:
    if isinstance(type_, Scalar):
        return ir.Const(type_, SIMPLE[type_])
    if isinstance(type_, Vector):
        return ir.Construct(type_, (ir.Const(type_.element, SIMPLE[type_.element]),))
    return None


def _results(function: ir.Function) -> Iterator[ir.Function]:
    """Versions that return one component or field of the result."""

    def returning(type_: Type, part: object) -> ir.Function:
        def change(body: tuple[ir.Stmt, ...]) -> tuple[ir.Stmt, ...]:
            changed: list[ir.Stmt] = []
            for s in body:
                match s:
                    case ir.Return():
                        changed.append(replace(s, value=_part(s.value, part)))
                    case ir.If():
                        changed.append(replace(s, then=change(s.then), orelse=change(s.orelse)))
                    case ir.For():
                        changed.append(replace(s, body=change(s.body)))
                    case _:
                        changed.append(s)
            return tuple(changed)

        return replace(function, returns=type_, body=change(function.body))

    if isinstance(function.returns, Struct):
        for f in function.returns.fields:
            yield returning(f.type, f)
    elif isinstance(function.returns, Vector):
        for k in range(function.returns.size):
            yield returning(function.returns.element, k)


def _part(e: ir.Expr, part: object) -> ir.Expr:
    """A field or component, taken from a constructor where there is one argument for each."""
    if isinstance(e.type, Struct):
        index = e.type.fields.index(part)
        if isinstance(e, ir.Construct):
            return e.args[index]
        return ir.Member(e.type.fields[index].type, e, e.type.fields[index].name)
    assert isinstance(e.type, Vector)
    assert isinstance(part, int)
    if isinstance(e, ir.Construct) and len(e.args) == e.type.size:
        return e.args[part]
    return ir.Swizzle(e.type.element, e, "xyzw"[part])
