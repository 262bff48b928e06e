"""Values: expressions of which no two are equal, so that one object is one value, however often it is used.

`build` makes an expression over values and simplifies it by the rules that it was given, until none applies.
Operands of commutative operations may stand in either order, which is exact: a + b and b + a are one value.
Every change is logged with what changed, why, and where in the sources.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from codegen.ir import nodes as ir
from codegen.ir.types import F32, I32, Array, Type, Vector
from codegen.passes.ssa.text import show

COMMUTATIVE = frozenset({"+", "*", "min", "max", "dot", "and", "or", "==", "!=", "&", "|", "^"})
MOST_CHANGES = 64
"""Rules that may apply to one expression in a row; more is a cycle among them."""

Value = ir.Expr | dict[str, "Value"]
"""A scalar or vector, or a struct as its fields."""


@dataclass(frozen=True)
class Step:
    """One change: which pass, what it changed into what, why that is sound, function and line."""

    name: str
    what: str
    why: str
    where: str


@dataclass(frozen=True)
class Rewrite:
    """What an expression becomes, and why."""

    value: ir.Expr
    name: str
    why: str


@dataclass(frozen=True)
class Hint:
    """A name from the source for a value; the larger rank wins."""

    rank: int
    name: str


LOCAL, FIELD, PARAMETER, CALL = 4, 3, 2, 1
"""Ranks of hints: a local's name says most, then a field's, a parameter's, a called function's."""

Rule = Callable[["Values", ir.Expr], Rewrite | None]


@dataclass
class Values:
    """All values of one function, the rules that simplify them, and the log.

    rules       tried in order on every new value
    parameters  scalar and vector parameters by their path, with what is known of them
    indices     loop variables by name, with their first and last value
    origins     function and line that were followed when a value came about, by its id
    """

    rules: tuple[Rule, ...] = ()
    parameters: Mapping[str, ir.Parameter] = field(default_factory=dict)
    indices: dict[str, tuple[int, int]] = field(default_factory=dict)
    log: list[Step] = field(default_factory=list)
    hints: dict[int, Hint] = field(default_factory=dict)
    function: str = ""
    line: int = 0
    origins: dict[int, tuple[str, int]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._known: dict[tuple[object, ...], ir.Expr] = {}
        self._simple: dict[int, ir.Expr] = {}
        self._logged: set[Step] = set()

    def simplify_by(self, rules: tuple[Rule, ...]) -> None:
        """From now on, these rules."""
        self.rules = rules
        self._simple.clear()

    def build(self, e: ir.Expr) -> ir.Expr:
        """The value of an expression whose operands are values."""
        given = self.intern(e)
        if id(given) in self._simple:
            return self._simple[id(given)]
        value = given
        for _ in range(MOST_CHANGES):
            for rule in self.rules:
                found = rule(self, value)
                if found is not None:
                    break
            else:
                break
            changed = self.intern(found.value)
            self.note(found.name, f"{self.show(value)} -> {self.show(changed)}", found.why)
            self._keep_hint(value, changed)
            value = self._simple.get(id(changed), changed)
        else:
            raise RuntimeError(f"rules do not end on {self.show(given)}")
        self._simple[id(given)] = value
        self._simple[id(value)] = value
        return value

    def intern(self, e: ir.Expr) -> ir.Expr:
        """The one object that stands for this expression over values."""
        key = _key(e)
        known = self._known.get(key)
        if known is None:
            self._known[key] = known = e
            self.origins[id(e)] = self.function, self.line
        return known

    def rebuild(self, e: ir.Expr) -> ir.Expr:
        """The value of a whole tree."""
        done: dict[int, ir.Expr] = {}

        def visit(x: ir.Expr) -> ir.Expr:
            if id(x) not in done:
                done[id(x)] = self.build(ir.rebuild(x, tuple(map(visit, ir.children(x)))))
            return done[id(x)]

        return visit(e)

    def binary(self, op: str, a: ir.Expr, b: ir.Expr, type_: Type | None = None) -> ir.Expr:
        """The value of an operator; its type is that of the wider operand unless given."""
        wider = type_ or (a.type if isinstance(a.type, Vector) else b.type)
        return self.build(ir.Binary(wider, op, a, b))

    def negative(self, a: ir.Expr) -> ir.Expr:
        """-a."""
        return self.build(ir.Unary(a.type, "negate", a))

    def number(self, value: float | int | bool, type_: Type) -> ir.Expr:
        """A constant of a scalar or vector type, all components alike."""
        if isinstance(type_, Vector):
            return self.build(ir.Construct(type_, (self.number(value, type_.element),)))
        return self.build(ir.Const(type_, float(value) if type_ == F32 else value))

    def component(self, e: ir.Expr, k: int) -> ir.Expr:
        """Component k of a vector; a scalar is every component of itself."""
        if not isinstance(e.type, Vector):
            return e
        return self.build(ir.Swizzle(e.type.element, e, "xyzw"[k]))

    def splat(self, e: ir.Expr, type_: Type) -> ir.Expr:
        """The value in a wider type, all components alike."""
        if isinstance(type_, Vector) and e.type == type_.element:
            return self.build(ir.Construct(type_, (e,)))
        return e

    def hint(self, e: ir.Expr, name: str, rank: int) -> None:
        """Remember a name from the source; parameters and constants need none."""
        if isinstance(e, ir.Var | ir.Const):
            return
        known = self.hints.get(id(e))
        if known is None or rank > known.rank:
            self.hints[id(e)] = Hint(rank, name)

    def _keep_hint(self, old: ir.Expr, new: ir.Expr) -> None:
        if id(old) in self.hints:
            self.hint(new, self.hints[id(old)].name, self.hints[id(old)].rank)

    def note(self, name: str, what: str, why: str) -> None:
        """Add a step to the log, once."""
        step = Step(name, what, why, f"{self.function}:{self.line}")
        if step not in self._logged:
            self._logged.add(step)
            self.log.append(step)

    def show(self, e: ir.Expr) -> str:
        """An expression as a person reads it in a report; named values by their names."""
        return show(e, lambda x: self.hints[id(x)].name if id(x) in self.hints else None)


def _key(e: ir.Expr) -> tuple[object, ...]:
    return _KEYS[type(e)](e)


def _operation_key(e: ir.Unary | ir.Binary | ir.Builtin) -> tuple[object, ...]:
    parts = [id(x) for x in ir.children(e)]
    if e.op in COMMUTATIVE:
        parts.sort()
    return (type(e), e.type.name, e.op, *parts)


def _other_key(e: ir.Expr) -> tuple[object, ...]:
    return (type(e), e.type.name, *map(id, ir.children(e)))


_KEYS: dict[type, Callable[[Any], tuple[object, ...]]] = {
    ir.Const: lambda e: (ir.Const, e.type.name, repr(e.value)),
    ir.Var: lambda e: (ir.Var, e.name),
    ir.Unary: _operation_key,
    ir.Binary: _operation_key,
    ir.Builtin: _operation_key,
    ir.Call: lambda e: (ir.Call, e.function, *map(id, e.args)),
    ir.Construct: _other_key,
    ir.Convert: _other_key,
    ir.Member: lambda e: (ir.Member, e.name, id(e.value)),
    ir.Swizzle: lambda e: (ir.Swizzle, e.components, id(e.value)),
    ir.Index: _other_key,
    ir.Select: _other_key,
}


def any_element(values: Values, array: ir.Expr) -> ir.Expr:
    """An element of an array with a number of its own, which stands for every number in facts."""
    assert isinstance(array.type, Array)
    number = values.intern(ir.Var(I32, "any element"))
    return values.intern(ir.Index(array.type.element, array, number))


def leaves(value: Value) -> Iterable[ir.Expr]:
    """The scalars and vectors of a value, in order."""
    if isinstance(value, dict):
        for part in value.values():
            yield from leaves(part)
    else:
        yield value


def constant_components(e: ir.Expr) -> tuple[float | int | bool, ...] | None:
    """The components of a constant; None for anything else."""
    if isinstance(e, ir.Const):
        return (e.value,)
    if isinstance(e, ir.Construct) and isinstance(e.type, Vector):
        numbers: list[float | int | bool] = []
        for a in e.args:
            if not isinstance(a, ir.Const):
                return None
            numbers.append(a.value)
        return tuple(numbers * e.type.size if len(numbers) == 1 else numbers)
    return None
