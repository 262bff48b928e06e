"""Nodes of the IR.

Expressions are immutable typed trees without side effects. Their evaluation order is the tree; nothing may
re-associate, fuse or drop an operation except a pass that says so. `Select` evaluates both sides. Statements
are structured: there is no jump but `Return`, and every path of a function ends in one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from operator import attrgetter, is_
from typing import Any

from codegen.errors import Place
from codegen.ir.domains import Domain
from codegen.ir.once import hashed_once
from codegen.ir.types import I32, TEXTURE, Struct, Type


@hashed_once
@dataclass(frozen=True, eq=False)
class Const:
    """A literal; a float is already rounded to float32."""

    type: Type
    value: float | int | bool


@hashed_once
@dataclass(frozen=True, eq=False)
class Var:
    """A parameter or a local."""

    type: Type
    name: str


@hashed_once
@dataclass(frozen=True, eq=False)
class Unary:
    """`-`, `~` or `not`."""

    type: Type
    op: str
    operand: Expr


@hashed_once
@dataclass(frozen=True, eq=False)
class Binary:
    """An operator of codegen.ops, named as in the source (`+`, `and`, `<`)."""

    type: Type
    op: str
    left: Expr
    right: Expr


@hashed_once
@dataclass(frozen=True, eq=False)
class Builtin:
    """A built-in of the op registry."""

    type: Type
    op: str
    args: tuple[Expr, ...]


@hashed_once
@dataclass(frozen=True, eq=False)
class Call:
    """A call of a library function."""

    type: Type
    function: str
    args: tuple[Expr, ...]


@hashed_once
@dataclass(frozen=True, eq=False)
class Construct:
    """A vector from scalars (one: splat) or shorter vectors, a struct or an array from its parts in order."""

    type: Type
    args: tuple[Expr, ...]


@hashed_once
@dataclass(frozen=True, eq=False)
class Convert:
    """A conversion between scalar number types: exact or rounded; to integers truncating."""

    type: Type
    operand: Expr


@hashed_once
@dataclass(frozen=True, eq=False)
class Member:
    """A field of a struct value."""

    type: Type
    value: Expr
    name: str


@hashed_once
@dataclass(frozen=True, eq=False)
class Swizzle:
    """Components of a vector, read only; one letter gives a scalar."""

    type: Type
    value: Expr
    components: str


@hashed_once
@dataclass(frozen=True, eq=False)
class Index:
    """An element of an array by an i32 or u32 that is one of its numbers."""

    type: Type
    value: Expr
    index: Expr


@hashed_once
@dataclass(frozen=True, eq=False)
class Select:
    """`if_true if condition else if_false`; both sides are evaluated."""

    type: Type
    condition: Expr
    if_true: Expr
    if_false: Expr


Expr = Const | Var | Unary | Binary | Builtin | Call | Construct | Convert | Member | Swizzle | Index | Select


@hashed_once
@dataclass(frozen=True, eq=False)
class Let:
    """The first assignment of a local; `mutable` where it is assigned again."""

    name: str
    value: Expr
    mutable: bool = False
    line: int = field(default=0, compare=False)


@hashed_once
@dataclass(frozen=True, eq=False)
class Assign:
    """A later assignment."""

    name: str
    value: Expr
    line: int = field(default=0, compare=False)


@hashed_once
@dataclass(frozen=True, eq=False)
class If:
    """A branch on a scalar condition."""

    condition: Expr
    then: tuple[Stmt, ...]
    orelse: tuple[Stmt, ...] = ()
    line: int = field(default=0, compare=False)


@hashed_once
@dataclass(frozen=True, eq=False)
class For:
    """`for name in range(start, stop)` with constant bounds; name is an i32.

    limit  of `for name in range(min(limit, stop))`: an i32 or u32 that the body does not change, evaluated
           before the loop; name is of its type
    """

    name: str
    start: int
    stop: int
    body: tuple[Stmt, ...]
    line: int = field(default=0, compare=False)
    limit: Expr | None = None

    @property
    def index_type(self) -> Type:
        return I32 if self.limit is None else self.limit.type


@hashed_once
@dataclass(frozen=True, eq=False)
class Return:
    """The function's value."""

    value: Expr
    line: int = field(default=0, compare=False)


Stmt = Let | Assign | If | For | Return


@dataclass(frozen=True)
class Parameter:
    """A parameter with the domain its signature states (None for structs: their fields state it)."""

    name: str
    type: Type
    domain: Domain | None


@dataclass(frozen=True)
class Doc:
    """A parsed docstring: what it is, and its entries (parameters, returns, degenerate, form, source)."""

    summary: str
    entries: dict[str, str]


@dataclass(frozen=True)
class StructDef:
    """A public struct with its documentation."""

    type: Struct
    module: str
    doc: Doc
    place: Place

    @property
    def name(self) -> str:
        return self.type.name


@dataclass(frozen=True)
class Function:
    """One function of the library. `kind`: base, variant, printed or helper; `base` names what it varies.

    origins  of a function that was made of others: what line numbers of its statements stand for
    """

    name: str
    module: str
    kind: str
    base: str | None
    parameters: tuple[Parameter, ...]
    returns: Type
    body: tuple[Stmt, ...]
    doc: Doc
    place: Place
    origins: Mapping[int, Place] = field(default_factory=dict, compare=False, repr=False)

    def source_of(self, line: int) -> Place:
        """The place in a source that the line number of a statement stands for."""
        return self.origins.get(line) or Place(self.place.path, line)

    @property
    def public(self) -> bool:
        return self.kind != "helper"

    @property
    def reads_textures(self) -> bool:
        """Whether a parameter is a texture."""
        return any(p.type == TEXTURE for p in self.parameters)


def _none(e: Any) -> tuple[Expr, ...]:
    return ()


_CHILDREN: dict[type, Callable[[Any], tuple[Expr, ...]]] = {
    Unary: lambda e: (e.operand,),
    Binary: attrgetter("left", "right"),
    Builtin: attrgetter("args"),
    Call: attrgetter("args"),
    Construct: attrgetter("args"),
    Convert: lambda e: (e.operand,),
    Member: lambda e: (e.value,),
    Swizzle: lambda e: (e.value,),
    Index: attrgetter("value", "index"),
    Select: attrgetter("condition", "if_true", "if_false"),
}
_OVER: dict[type, Callable[[Any, tuple[Expr, ...]], Expr]] = {
    Unary: lambda e, parts: Unary(e.type, e.op, *parts),
    Binary: lambda e, parts: Binary(e.type, e.op, *parts),
    Builtin: lambda e, parts: Builtin(e.type, e.op, parts),
    Call: lambda e, parts: Call(e.type, e.function, parts),
    Construct: lambda e, parts: Construct(e.type, parts),
    Convert: lambda e, parts: Convert(e.type, *parts),
    Member: lambda e, parts: Member(e.type, parts[0], e.name),
    Swizzle: lambda e, parts: Swizzle(e.type, parts[0], e.components),
    Index: lambda e, parts: Index(e.type, *parts),
    Select: lambda e, parts: Select(e.type, *parts),
}
"""Tables, since these two are what every pass does most."""


class _Operands:
    """The attribute of an expression that holds its operands once they were asked for."""

    def __init__(self, of: Callable[[Any], tuple[Expr, ...]]) -> None:
        self.of = of

    def __get__(self, e: Any, kind: type) -> tuple[Expr, ...]:
        found: tuple[Expr, ...] = self.of(e)
        e.__dict__["operands"] = found
        return found


for _kind in (Const, Var, *_CHILDREN):
    _kind.operands = _Operands(_CHILDREN.get(_kind, _none))  # type: ignore[attr-defined]

children: Callable[[Expr], tuple[Expr, ...]] = attrgetter("operands")
"""The direct operands of an expression, in evaluation order."""


def rebuild(e: Expr, parts: tuple[Expr, ...]) -> Expr:
    """The same expression over other operands; itself where these are its own."""
    old = children(e)
    if len(old) == len(parts) and all(map(is_, old, parts)):
        return e
    return _OVER[type(e)](e, parts)


def map_expr(e: Expr, change: Callable[[Expr], Expr]) -> Expr:
    """The expression with `change` applied to every node, operands first."""
    parts = children(e)
    return change(rebuild(e, tuple([map_expr(c, change) for c in parts])) if parts else e)


def map_body(body: tuple[Stmt, ...], change: Callable[[Expr], Expr]) -> tuple[Stmt, ...]:
    """The statements with `change` applied to every expression node."""
    return map_wholes(body, lambda e: map_expr(e, change))


def map_wholes(body: tuple[Stmt, ...], change: Callable[[Expr], Expr]) -> tuple[Stmt, ...]:
    """The statements, nested ones included, with `change` applied to each of their expressions as a whole."""

    def statement(s: Stmt) -> Stmt:
        match s:
            case If():
                condition = change(s.condition)
                sides = map_wholes(s.then, change), map_wholes(s.orelse, change)
                return replace(s, condition=condition, then=sides[0], orelse=sides[1])
            case For():
                limit = None if s.limit is None else change(s.limit)
                return replace(s, limit=limit, body=map_wholes(s.body, change))
            case _:
                value = change(s.value)
                return s if value is s.value else replace(s, value=value)

    return tuple(statement(s) for s in body)


def walk(e: Expr) -> Iterator[Expr]:
    """Every node of an expression, each before its operands."""
    waiting = [e]
    while waiting:
        node = waiting.pop()
        yield node
        waiting += children(node)[::-1]


def statements(body: tuple[Stmt, ...]) -> Iterator[Stmt]:
    """Every statement of a body, nested ones included."""
    for s in body:
        yield s
        if isinstance(s, If):
            yield from statements(s.then)
            yield from statements(s.orelse)
        elif isinstance(s, For):
            yield from statements(s.body)


def expressions(body: tuple[Stmt, ...]) -> Iterator[Expr]:
    """Every expression node of a body."""
    for s in statements(body):
        if isinstance(s, If):
            yield from walk(s.condition)
        elif not isinstance(s, For):
            yield from walk(s.value)
        elif s.limit is not None:
            yield from walk(s.limit)


def callees(function: Function) -> list[str]:
    """Names of the library functions that a function calls, in order of first call."""
    return list(dict.fromkeys(e.function for e in expressions(function.body) if isinstance(e, Call)))
