"""Checks that IR is well formed; run after lowering and after every pass in tests."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from codegen.ir import nodes as ir
from codegen.ir.types import (
    BOOL,
    F16,
    F32,
    I32,
    TEXTURE,
    U32,
    Array,
    Struct,
    Type,
    Vector,
    element_of,
    vector_of,
)
from codegen.ops import BUILTINS, OPERATORS


class MalformedIRError(Exception):
    """A bug in the front end or in a pass."""


_PYTHON_TYPES: dict[Type, type] = {BOOL: bool, F16: float, F32: float, I32: int, U32: int}
_NUMBERS = (F16, F32, I32, U32)

Signature = Callable[[str], tuple[tuple[Type, ...], Type] | None]


def verify(function: ir.Function, signature: Signature) -> None:
    """Raise MalformedIRError unless every node is typed as the registry says and every path returns.

    `signature` gives the parameter and result types of a called function, or None if there is none.
    """
    scope: dict[str, Type] = {}
    for p in function.parameters:
        if p.name in scope:
            raise MalformedIRError(f'{function.name}: two parameters named "{p.name}"')
        scope[p.name] = p.type
    check = _Checker(function, signature)
    check.block(function.body, scope, frozenset())
    if not check.returns(function.body):
        raise MalformedIRError(f"{function.name}: a path without return")


class _Checker:
    def __init__(self, function: ir.Function, signature: Signature) -> None:
        self.function = function
        self.signature = signature

    def fail(self, what: str) -> MalformedIRError:
        return MalformedIRError(f"{self.function.name}: {what}")

    def returns(self, body: tuple[ir.Stmt, ...]) -> bool:
        last = body[-1] if body else None
        if isinstance(last, ir.If):
            return self.returns(last.then) and self.returns(last.orelse)
        return isinstance(last, ir.Return)

    def block(
        self, body: tuple[ir.Stmt, ...], outer: Mapping[str, Type], outer_mutable: frozenset[str]
    ) -> None:
        scope, mutable = dict(outer), set(outer_mutable)
        for position, s in enumerate(body):
            if position > 0 and self.returns(body[:position]):
                raise self.fail("a statement that is never reached")
            match s:
                case ir.Let():
                    if s.name in scope:
                        raise self.fail(f'"{s.name}" is defined twice')
                    self.expr(s.value, scope)
                    if s.value.type == TEXTURE:
                        raise self.fail(f'"{s.name}" is a local texture')
                    scope[s.name] = s.value.type
                    if s.mutable:
                        mutable.add(s.name)
                case ir.Assign():
                    self.expr(s.value, scope)
                    if s.name not in mutable or scope[s.name] != s.value.type:
                        raise self.fail(f'"{s.name}" is not a mutable local of type {s.value.type.name}')
                case ir.If():
                    self.expr(s.condition, scope)
                    if s.condition.type != BOOL:
                        raise self.fail("a condition that is no truth value")
                    self.block(s.then, scope, frozenset(mutable))
                    self.block(s.orelse, scope, frozenset(mutable))
                case ir.For():
                    if s.name in scope:
                        raise self.fail(f'"{s.name}" is defined twice')
                    self.limit(s, scope)
                    self.block(s.body, {**scope, s.name: s.index_type}, frozenset(mutable))
                case ir.Return():
                    self.expr(s.value, scope)
                    if s.value.type != self.function.returns:
                        raise self.fail(f"returns {s.value.type.name}")

    def limit(self, s: ir.For, scope: Mapping[str, Type]) -> None:
        """What ends a loop early is a whole number that no iteration changes: texts read it every time."""
        if s.limit is None:
            return
        self.expr(s.limit, scope)
        if s.limit.type not in (I32, U32) or s.start != 0:
            raise self.fail(f'the loop over "{s.name}" does not count from 0 to a whole number')
        assigned = {inner.name for inner in ir.statements(s.body) if isinstance(inner, ir.Assign)}
        if any(isinstance(e, ir.Var) and e.name in assigned for e in ir.walk(s.limit)):
            raise self.fail(f'the loop over "{s.name}" changes its own limit')

    def expr(self, e: ir.Expr, scope: Mapping[str, Type]) -> None:
        for child in ir.children(e):
            self.expr(child, scope)
        expected = self.type_of(e, scope)
        if expected != e.type:
            shown = getattr(expected, "name", None)
            raise self.fail(f"{type(e).__name__} is marked {e.type.name} but gives {shown}")

    def type_of(self, e: ir.Expr, scope: Mapping[str, Type]) -> Type | None:
        types = tuple(c.type for c in ir.children(e))
        match e:
            case ir.Const():
                python = _PYTHON_TYPES.get(e.type)
                return e.type if type(e.value) is python else None
            case ir.Var():
                return scope.get(e.name)
            case ir.Unary() | ir.Binary():
                return OPERATORS[e.op].result(types) if e.op in OPERATORS else None
            case ir.Builtin():
                return BUILTINS[e.op].result(types) if e.op in BUILTINS else None
            case ir.Call():
                if any(isinstance(a.type, Array) and not isinstance(a, ir.Var) for a in e.args):
                    raise self.fail("an array that is handed over without a name")
                found = self.signature(e.function)
                return found[1] if found is not None and found[0] == types else None
            case ir.Convert():
                return e.type if self._converts(types[0], e.type) else None
            case ir.Select():
                same = (
                    types[0] == BOOL
                    and types[1] == types[2]
                    and not isinstance(types[1], Struct)
                    and types[1] != TEXTURE
                )
                return types[1] if same else None
            case ir.Member():
                found_field = types[0].field(e.name) if isinstance(types[0], Struct) else None
                return found_field.type if found_field else None
            case ir.Index():
                fits = isinstance(types[0], Array) and types[1] in (I32, U32)
                return types[0].element if fits and isinstance(types[0], Array) else None
            case ir.Swizzle():
                of = types[0]
                inside = isinstance(of, Vector) and set(e.components) <= set("xyzw"[: of.size])
                return vector_of(of.element, len(e.components)) if inside and isinstance(of, Vector) else None
            case ir.Construct():
                return e.type if self._constructs(e.type, types) else None

    @staticmethod
    def _converts(given: Type, wanted: Type) -> bool:
        """Scalar numbers to each other, and float vectors of one size."""
        if isinstance(given, Vector) and isinstance(wanted, Vector):
            return given.size == wanted.size and {element_of(given), element_of(wanted)} <= {F16, F32}
        return given in _NUMBERS and wanted in _NUMBERS

    @staticmethod
    def _constructs(type_: Type, parts: tuple[Type, ...]) -> bool:
        if isinstance(type_, Struct):
            return parts == tuple(f.type for f in type_.fields)
        if not isinstance(type_, Vector):
            return False
        elements = [p.element if isinstance(p, Vector) else p for p in parts]
        size = sum(p.size if isinstance(p, Vector) else 1 for p in parts)
        return all(x == type_.element for x in elements) and size in (type_.size, 1 if len(parts) == 1 else 0)


def verify_selection(functions: tuple[ir.Function, ...]) -> None:
    """Verify functions that stand together, each after what it calls."""
    seen: dict[str, tuple[tuple[Type, ...], Type]] = {}
    for function in functions:
        verify(function, seen.get)
        seen[function.name] = (tuple(p.type for p in function.parameters), function.returns)
