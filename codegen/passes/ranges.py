"""Range analysis: bounds of every value over all parameters in their ranges, on every target.

Each value is followed through the interval arithmetic of codegen.intervals under every table, rounding
outwards, with one lane whose inputs are whole ranges. What a table leaves open is unbounded. A fact narrows
one expression; lengths of vectors narrow products of directions (codegen.passes.norms).
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from codegen.intervals import TABLES, load_table, logic
from codegen.intervals.causes import Cause, CauseBook
from codegen.intervals.context import Context
from codegen.intervals.interpreter import reinterpreted
from codegen.intervals.numbers import LARGEST, SMALLEST
from codegen.intervals.operations import VECTOR_BUILTINS, binary, scalar_builtin, unary
from codegen.intervals.values import Range, Single, Truth, Whole, choose, constant
from codegen.ir import nodes as ir
from codegen.ir.domains import Domain, Finite, Interval, Length, Unit
from codegen.ir.types import BOOL, F32, I32, Array, Scalar, Type, Vector
from codegen.passes.norms import UNIT_SLACK, norm, product
from codegen.passes.values import Values, any_element

FACT_SLACK = 2.0**-19
"""A fact speaks of the exact quantity; a target may be so far off, relative to 1 or to its size."""

Bound = tuple[Single, ...]


@dataclass(frozen=True)
class Bounds:
    """Least and largest value of a component on any target; truth values are 0 and 1."""

    low: float
    high: float

    @property
    def finite(self) -> bool:
        """Whether anything is known."""
        return math.isfinite(self.low) and math.isfinite(self.high)

    def __str__(self) -> str:
        return f"[{self.low:.6g}, {self.high:.6g}]"


class Ranges:
    """Bounds of values; each is computed once."""

    def __init__(self, values: Values, facts: Iterable[tuple[ir.Expr, float, float]] = ()) -> None:
        """`facts` are expressions over values with their least and largest value."""
        self.values = values
        self.facts = {id(e): (low, high) for e, low, high in facts}
        self._tables = [_Table(self, name) for name in TABLES]
        self._known: dict[int, tuple[Bounds, ...]] = {}

    def bounds(self, e: ir.Expr) -> tuple[Bounds, ...]:
        """The bounds of each component."""
        if id(e) not in self._known:
            with np.errstate(all="ignore"):
                found = [table.value(e) for table in self._tables]
            self._known[id(e)] = tuple(_hull(singles) for singles in zip(*found, strict=True))
        return self._known[id(e)]

    def fact(self, e: ir.Expr) -> tuple[float, float] | None:
        """What a fact says of an expression; one of an array speaks of each of its elements."""
        if id(e) in self.facts or not self.facts:
            return self.facts.get(id(e))
        parts = ir.children(e)
        if not any(isinstance(c, ir.Index) for c in parts):
            return None
        parts = tuple(any_element(self.values, c.value) if isinstance(c, ir.Index) else c for c in parts)
        return self.facts.get(id(self.values.intern(ir.rebuild(e, parts))))

    def add_fact(self, e: ir.Expr, low: float, high: float) -> None:
        """One more fact; only before anything is asked."""
        assert not self._known
        self.facts[id(e)] = low, high


def _hull(singles: tuple[Single, ...]) -> Bounds:
    ends = [_ends(s) for s in singles]
    return Bounds(min(low for low, _ in ends), max(high for _, high in ends))


def _ends(s: Single) -> tuple[float, float]:
    if isinstance(s, Truth):
        return (0.0 if s.false.any() else 1.0), (1.0 if s.true.any() else 0.0)
    if s.cause is not None and (s.cause > 0).any():
        return -math.inf, math.inf
    return float(s.low[0]), float(s.high[0])


class _Table:
    """Bounds under one table."""

    def __init__(self, owner: Ranges, name: str) -> None:
        self.owner = owner
        self.context = Context(load_table(name), CauseBook(), 1)
        self.known: dict[int, Bound] = {}
        self.kept: list[ir.Expr] = []

    def value(self, e: ir.Expr) -> Bound:
        """The components' intervals."""
        if id(e) not in self.known:
            for part in _pending(e, self.known):  # operands first, without deep recursion
                self.known[id(part)] = self.narrowed(part, self.computed(part))
                self.kept.append(part)
        return self.known[id(e)]

    def computed(self, e: ir.Expr) -> Bound:
        parts = [self.known[id(c)] for c in ir.children(e)]
        context = self.context
        match e:
            case ir.Const():
                return (constant(e.value, e.type == I32),)
            case ir.Var():
                return self.variable(e)
            case ir.Unary():
                return self.each(e.op, lambda a: unary(context, e.op, a[0]), parts)
            case ir.Binary():
                return self.each(e.op, lambda a: binary(context, e.op, a[0], a[1]), parts)
            case ir.Builtin() if e.op in VECTOR_BUILTINS:
                context.operation = e.op
                found = VECTOR_BUILTINS[e.op](context, *cast(list[tuple[Range, ...]], parts))
                return found if isinstance(found, tuple) else (found,)
            case ir.Builtin():
                return self.each(e.op, lambda a: scalar_builtin(context, e.op, a), parts)
            case ir.Construct() if isinstance(e.type, Array):
                columns = zip(*parts, strict=True)
                return tuple(functools.reduce(_either, column) for column in columns)
            case ir.Index():
                return tuple(_either(s, s) for s in parts[0])  # another number may name another element
            case ir.Construct() if isinstance(e.type, Vector):
                flat = tuple(s for p in parts for s in p)
                return flat * e.type.size if len(flat) == 1 else flat
            case ir.Convert():
                return (self.converted(e.type, parts[0][0]),)
            case ir.Swizzle():
                return tuple(parts[0]["xyzw".index(c)] for c in e.components)
            case ir.Select():
                condition = parts[0][0]
                assert isinstance(condition, Truth)
                return cast(Bound, choose(condition, parts[1], parts[2]))
            case _:
                return self.anything(e.type)

    def each(self, op: str, apply: Callable[[Bound], Single], parts: list[Bound]) -> Bound:
        self.context.operation = op
        size = max(map(len, parts))
        columns = [p * size if len(p) == 1 else p for p in parts]
        return tuple(apply(components) for components in zip(*columns, strict=True))

    def converted(self, type_: Type, a: Single) -> Single:
        if isinstance(a, Range):
            return a if type_ == F32 else logic.to_integer(self.context, a, type_ == I32)
        assert isinstance(a, Whole)
        return logic.to_float(self.context, a) if type_ == F32 else reinterpreted(a, type_ == I32)

    def variable(self, e: ir.Var) -> Bound:
        known = self.owner.values.parameters.get(e.name)
        if e.name in self.owner.values.indices:
            first, last = self.owner.values.indices[e.name]
            return (Whole(np.array([first]), np.array([last]), True),)
        type_ = e.type.element if isinstance(e.type, Array) else e.type
        if known is None or known.domain is None or not _is_float(type_):
            return self.given(type_, known)
        low, high = ends(known.domain)
        if 0.0 < low < SMALLEST:
            low = 0.0
        if -SMALLEST < high < 0.0:
            high = 0.0
        size = type_.size if isinstance(type_, Vector) else 1
        return tuple(_interval(low, high) for _ in range(size))

    def given(self, type_: Type, known: ir.Parameter | None) -> Bound:
        """Integers and truth values by their parameter's domain, where it has one; else anything."""
        if known is not None and isinstance(known.domain, Interval) and type_ != BOOL:
            element = type_.element if isinstance(type_, Vector) else type_
            size = type_.size if isinstance(type_, Vector) else 1
            low, high = math.ceil(known.domain.low), math.floor(known.domain.high)
            return tuple(
                Whole(np.array([low], np.int64), np.array([high], np.int64), element == I32)
                for _ in range(size)
            )
        return self.anything(type_)

    def anything(self, type_: Type) -> Bound:
        element = type_.element if isinstance(type_, Vector) else type_
        size = type_.size if isinstance(type_, Vector) else 1
        if not isinstance(element, Scalar):
            return ()
        return tuple(self.any_single(element) for _ in range(size))

    def any_single(self, element: Scalar) -> Single:
        if element == BOOL:
            return Truth(np.array([True]), np.array([True]))
        if element == F32:
            code = self.context.book.code(Cause("", 0, "", "", "nothing is known of it"))
            return Range(np.array([-np.inf]), np.array([np.inf]), np.array([code], np.int16))
        least, most = (-(2**31), 2**31 - 1) if element == I32 else (0, 2**32 - 1)
        return Whole(np.array([least]), np.array([most]), element == I32)

    def narrowed(self, e: ir.Expr, found: Bound) -> Bound:
        """The intervals cut to what facts and lengths say."""
        if not _is_float(e.type):
            return found
        fact = self.owner.fact(e)
        if fact is not None:
            low, high = fact
            slack = FACT_SLACK * max(1.0, *(abs(x) for x in (low, high) if math.isfinite(x)))
            found = tuple(_cut(s, low - slack, high + slack) for s in found)
        size = math.inf
        match e:
            case ir.Builtin(op="dot", args=(a, b)):
                size = product(self.owner.values, a, b)
            case ir.Builtin(op="length", args=(a,)):
                size = math.sqrt(product(self.owner.values, a, a)) * (1.0 + UNIT_SLACK)
            case _ if isinstance(e.type, Vector):
                size = norm(self.owner.values, e)
        if not math.isfinite(size):
            return found
        # What may overflow or be no number stays unbounded: a length says nothing of it.
        return tuple(_cut(s, -size, size) if _is_bounded(s) else s for s in found)


def _pending(e: ir.Expr, known: Mapping[int, object]) -> list[ir.Expr]:
    """What is not yet known below an expression, operands first."""
    order: list[ir.Expr] = []
    seen: set[int] = set()
    waiting = [(e, False)]
    while waiting:
        x, ready = waiting.pop()
        if ready:
            order.append(x)
        elif id(x) not in seen and id(x) not in known:
            seen.add(id(x))
            waiting.append((x, True))
            waiting += [(c, False) for c in ir.children(x)]
    return order


def _is_float(type_: Type) -> bool:
    return type_ == F32 or (isinstance(type_, Vector) and type_.element == F32)


def _is_bounded(s: Single) -> bool:
    return not isinstance(s, Truth) and (s.cause is None or not (s.cause > 0).any())


def _either(a: Single, b: Single) -> Single:
    """A value that is one of two, told apart from both."""
    both = Truth(np.array([True]), np.array([True]))
    if isinstance(a, Truth):
        assert isinstance(b, Truth)
        return Truth(a.true | b.true, a.false | b.false)
    if a is b:
        return replace(a)
    found = choose(both, a, b)
    assert isinstance(found, Range | Whole)
    return found


def _interval(low: float, high: float) -> Range:
    a = np.array([low])
    return Range(a, a if low == high else np.array([high]))


def _cut(s: Single, low: float, high: float) -> Single:
    """The interval inside two ends; where it was unbounded, the ends themselves."""
    assert isinstance(s, Range)
    if s.cause is None and s.low[0] >= low and s.high[0] <= high:
        return s
    least, most = max(float(s.low[0]), low), min(float(s.high[0]), high)
    if not (math.isfinite(least) and math.isfinite(most)):
        return s
    return Range(np.array([least]), np.array([max(most, least)]), None, s.product)


def ends(domain: Domain) -> tuple[float, float]:
    """The least and largest component that a domain of floats allows."""
    match domain:
        case Interval():
            low, high = domain.low, domain.high
            return min(low, float(np.float32(low))), max(high, float(np.float32(high)))
        case Unit():
            return -1.0 - UNIT_SLACK, 1.0 + UNIT_SLACK
        case Length():
            high = domain.high * (1.0 + UNIT_SLACK)
            return -high, high
        case Finite():
            return -LARGEST, LARGEST
