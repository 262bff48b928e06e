"""Statements: assignments, branches, bounded loops, returns."""

from __future__ import annotations

import ast
from collections import ChainMap
from dataclasses import replace

from codegen import names
from codegen.frontend import constants
from codegen.frontend.expressions import ExpressionLowering
from codegen.frontend.scope import Names
from codegen.frontend.source import SourceFile, describe
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, I32, TEXTURE, U32, Type

MAX_ITERATIONS = 65536
"""Longest loop the front end accepts; shaders hang a machine long before this is useful."""


def lower_body(
    resolver: Names,
    file: SourceFile,
    node: ast.FunctionDef,
    parameters: tuple[ir.Parameter, ...],
    returns: Type,
) -> tuple[ir.Stmt, ...]:
    """The body of a function; every path must end in a return of the stated type."""
    lowering = StatementLowering(resolver, file, parameters, returns)
    body = node.body
    if body and isinstance(body[0], ast.Expr) and isinstance(body[0].value, ast.Constant):
        body = body[1:]
    lowered = lowering.block(body)
    if not _returns(lowered):
        raise file.error(node, f'not every path of "{node.name}" returns a value')
    return mark_mutable(lowered)


class StatementLowering:
    """Lowers the statements of one function; a local lives from its first assignment to its block's end."""

    def __init__(
        self, resolver: Names, file: SourceFile, parameters: tuple[ir.Parameter, ...], returns: Type
    ) -> None:
        self.resolver = resolver
        self.file = file
        self.returns = returns
        self.parameters = {p.name for p in parameters}
        self.scope: ChainMap[str, Type] = ChainMap({p.name: p.type for p in parameters})
        self.loop_names: set[str] = set()
        self.ended: set[str] = set()

    def block(self, body: list[ast.stmt]) -> tuple[ir.Stmt, ...]:
        """A block with its own scope."""
        outer = self.scope
        self.scope = self.scope.new_child()
        lowered = []
        for position, node in enumerate(body):
            lowered.append(self.statement(node))
            if _returns((lowered[-1],)) and position + 1 < len(body):
                raise self.file.error(body[position + 1], "this is never reached")
        self.ended |= set(self.scope.maps[0])
        self.scope = outer
        return tuple(lowered)

    def expression(self, node: ast.expr, expected: Type | None = None) -> ir.Expr:
        """The typed expression, names looked up in the scope as it is here."""
        return ExpressionLowering(self.resolver, self.file, self.scope, self.ended).lower(node, expected)

    def statement(self, node: ast.stmt) -> ir.Stmt:
        """One statement; raises SourceError for what the subset of Python leaves out."""
        match node:
            case ast.Return(value=ast.expr() as value):
                return ir.Return(self.expression(value, self.returns), node.lineno)
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                return self.assignment(node, name, value)
            case ast.AnnAssign():
                raise self.file.error(node, "types of locals are inferred: write name = value")
            case ast.AugAssign(target=ast.Name(id=name), op=op, value=value):
                joined = ast.BinOp(left=ast.Name(id=name, ctx=ast.Load()), op=op, right=value)
                ast.copy_location(joined, node)
                ast.copy_location(joined.left, node)
                return self.assignment(node, name, joined)
            case ast.Assign():
                raise self.file.error(node, "assign one name at a time; components are read only")
            case ast.If(test=test, body=body, orelse=orelse):
                condition = self.expression(test, BOOL)
                return ir.If(condition, self.block(body), self.block(orelse), node.lineno)
            case ast.For():
                return self.loop(node)
            case ast.While():
                raise self.file.error(node, "loops are bounded: write for i in range(CONSTANT)")
            case ast.Return():
                raise self.file.error(node, "return a value")
            case _:
                raise self.file.error(node, f"{describe(node)} is outside the shader subset of Python")

    def assignment(self, node: ast.stmt, name: str, value: ast.expr) -> ir.Stmt:
        """A new local, or another value of the same type for one."""
        known = self.scope.get(name)
        if name in self.parameters:
            raise self.file.error(node, f'parameter "{name}" is read only; use another name')
        if name in self.loop_names:
            raise self.file.error(node, f'loop variable "{name}" is read only')
        e = self.expression(value, known)
        if e.type == TEXTURE:
            raise self.file.error(node, "a texture is a parameter; pass it on by its own name")
        if known is not None:
            return ir.Assign(name, e, node.lineno)
        if self.resolver.where(name) or self.resolver.find(self.file, name) or name in self.file.imports:
            raise self.file.error(node, f'"{name}" already names something else in this file or the library')
        names.check(name, "local", self.file.place(node))
        self.scope[name] = e.type
        return ir.Let(name, e, False, node.lineno)

    def loop(self, node: ast.For) -> ir.Stmt:
        """A loop over range() with constant bounds, which a parameter may end early."""
        limit: ir.Expr | None = None
        match node:
            case ast.For(
                target=ast.Name(id=name),
                iter=ast.Call(func=ast.Name(id="range"), args=bounds, keywords=[]),
                orelse=[],
            ) if 1 <= len(bounds) <= 2:
                if len(bounds) == 1:
                    bounds, limit = self.limit(bounds[0])
                values = [constants.fold(b, lambda n: self.resolver.constant(self.file, n)) for b in bounds]
            case _:
                raise self.file.error(node, "a loop is written for i in range(CONSTANT)")
        if not all(isinstance(v, int) and not isinstance(v, bool) for v in values):
            raise self.file.error(
                node, "the bounds of range() must be constant whole numbers, or min(PARAMETER, CONSTANT)"
            )
        whole = [int(v) for v in values if v is not None]
        if not all(-(2**31) < v < 2**31 for v in whole):
            raise self.file.error(node, "the bounds of range() must fit into an i32")
        start, stop = (0, whole[0]) if len(whole) == 1 else (whole[0], whole[1])
        if stop - start > MAX_ITERATIONS:
            raise self.file.error(node, f"a loop may run {MAX_ITERATIONS} times at most")
        if name in self.scope:
            raise self.file.error(node, f'"{name}" is already in use')
        names.check(name, "local", self.file.place(node))
        outer = self.scope
        self.scope = self.scope.new_child({name: I32 if limit is None else limit.type})
        self.loop_names.add(name)
        body = self.block(node.body)
        self.loop_names.discard(name)
        self.ended.add(name)
        self.scope = outer
        return ir.For(name, start, stop, body, node.lineno, limit)

    def limit(self, bound: ast.expr) -> tuple[list[ast.expr], ir.Expr | None]:
        """The constant and the parameter of range(min(PARAMETER, CONSTANT)); other bounds as they are."""
        match bound:
            case ast.Call(func=ast.Name(id="min"), args=[ast.Name(id=name) as first, second], keywords=[]):
                value = self.expression(first)
                if name not in self.parameters or value.type not in (I32, U32):
                    raise self.file.error(first, "what ends a loop early is a parameter, i32 or u32")
                return [second], value
            case _:
                return [bound], None


def _returns(body: tuple[ir.Stmt, ...]) -> bool:
    if not body:
        return False
    last = body[-1]
    return isinstance(last, ir.Return) or (
        isinstance(last, ir.If) and _returns(last.then) and _returns(last.orelse)
    )


def mark_mutable(body: tuple[ir.Stmt, ...]) -> tuple[ir.Stmt, ...]:
    """The same statements; locals are mutable where some statement assigns them again, and only there."""
    assigned = {s.name for s in ir.statements(body) if isinstance(s, ir.Assign)}

    def mark(part: tuple[ir.Stmt, ...]) -> tuple[ir.Stmt, ...]:
        marked: list[ir.Stmt] = []
        for s in part:
            if isinstance(s, ir.Let):
                marked.append(replace(s, mutable=s.name in assigned))
            elif isinstance(s, ir.If):
                marked.append(replace(s, then=mark(s.then), orelse=mark(s.orelse)))
            elif isinstance(s, ir.For):
                marked.append(replace(s, body=mark(s.body)))
            else:
                marked.append(s)
        return tuple(marked)

    return mark(body)
