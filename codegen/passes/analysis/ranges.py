"""Range analysis: bounds of every value over all parameters in their ranges, on every target.

Each value is followed through the interval arithmetic of codegen.intervals under every table, rounding
outwards, with one lane whose inputs are whole ranges (codegen.passes.analysis.transfer). What a table leaves
open is unbounded. A fact narrows one expression; lengths of vectors narrow products of directions
(codegen.passes.analysis.norms).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from codegen.errors import UserError
from codegen.intervals import TABLES
from codegen.intervals.numbers import LARGEST, SMALLEST
from codegen.intervals.values import Range, Single, Truth, Whole, constant
from codegen.ir import nodes as ir
from codegen.ir.domains import Domain, Edges, Finite, Interval, Length, Unit
from codegen.ir.types import BOOL, F32, I32, TEXTURE, Array, Scalar, Struct, Type, Vector
from codegen.passes.analysis.norms import UNIT_SLACK, Lengths
from codegen.passes.analysis.transfer import Bound, remembered, signatures, transfers
from codegen.passes.ssa.values import Values, any_element

FACT_SLACK = 2.0**-19
"""A fact speaks of the exact quantity; a target may be so far off, relative to 1 or to its size."""


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

    def __init__(self, values: Values) -> None:
        self.values = values
        self.facts: dict[int, tuple[float, float]] = {}
        self._under: dict[int, tuple[Bound, ...]] = {}
        self._kept: list[ir.Expr] = []
        self._lengths = Lengths(values, self.bounds)
        self._known: dict[int, tuple[Bounds, ...]] = {}

    def add_fact(self, e: ir.Expr, low: float, high: float) -> None:
        """An expression over values lies between two ends; only before anything is asked."""
        assert not self._known
        self.facts[id(e)] = low, high
        self._kept.append(e)

    def check_facts(self) -> None:
        """Raise UserError where a fact contradicts what the ranges of parameters give."""
        for e in tuple(self._kept):
            self.bounds(e)

    def bounds(self, e: ir.Expr) -> tuple[Bounds, ...]:
        """The bounds of each component. Raises UserError where a fact contradicts what ranges give."""
        if id(e) not in self._known:
            with np.errstate(all="ignore"):
                for part in _pending(e, self._under):  # operands first, without deep recursion
                    if id(part) in self._under:
                        continue  # asked for meanwhile, for the lengths of others
                    self._bound(part)
                    self._kept.append(part)
            found = {id(bound): bound for bound in self._under[id(e)]}
            self._known[id(e)] = tuple(_hull(singles) for singles in zip(*found.values(), strict=True))
        return self._known[id(e)]

    def _bound(self, e: ir.Expr) -> None:
        """Note the intervals of an expression under every table; tables that agree share them."""
        cut, leaf = self._cut(e), self._leaf(e)
        if leaf is not None:
            self._under[id(e)] = (self._narrowed(e, leaf, cut),) * len(TABLES)
            return
        made: dict[tuple[int, ...], Bound] = {}
        found: list[Bound] = []
        operands = zip(*[self._under[id(c)] for c in ir.children(e)], strict=True)
        for transfer, said, of in zip(transfers(), signatures(e), operands, strict=True):
            key = (said, *map(id, of))
            if key not in made:
                made[key] = self._narrowed(e, transfer.apply(e, of), cut)
            found.append(made[key])
        self._under[id(e)] = tuple(found)

    def _leaf(self, e: ir.Expr) -> Bound | None:
        """The intervals of what is the same under every table; None for operations."""
        match e:
            case ir.Const():
                key = ("const", e.type.name, type(e.value), repr(e.value))
                return remembered(key, lambda: (constant(e.value, e.type == I32),))
            case ir.Var():
                return self._variable(e)
            case ir.Call() | ir.Member():
                return _anything(e.type)
            case ir.Builtin() if any(a.type == TEXTURE for a in e.args):
                return _anything(e.type)  # nothing is known of what a map holds
            case ir.Construct() if isinstance(e.type, Struct) and not isinstance(e.type, Array):
                return ()  # an argument of a call that is kept
            case _:
                return None

    def _variable(self, e: ir.Var) -> Bound:
        if e.name in self.values.indices:
            first, last = self.values.indices[e.name]
            return remembered(("index", e.name, first, last), lambda: (_whole(first, last, I32),))
        known = self.values.parameters.get(e.name)
        domain = None if known is None else known.domain
        return remembered(("var", e.name, e.type, domain), lambda: _parameter(e.type, domain))

    def _cut(self, e: ir.Expr) -> tuple[float, float, bool] | None:
        """The ends that a fact or the lengths of vectors give a float value, and whether it is a fact."""
        if not _is_float(e.type):
            return None
        least, most = -math.inf, math.inf
        match e:
            case ir.Builtin(op="dot", args=(a, b)):
                least, most = self._lengths.product(a, b)
            case ir.Builtin(op="length", args=(a,)):
                ends = self._lengths.product(a, a)
                least, most = (
                    math.sqrt(x) * (1.0 + k * UNIT_SLACK) for x, k in zip(ends, (-1, 1), strict=True)
                )
            case _ if isinstance(e.type, Vector):
                most = self._lengths.of(e)[1]
                least = -most
        fact = self._fact(e)
        if fact is not None:
            slack = FACT_SLACK * max(1.0, *(abs(x) for x in fact if math.isfinite(x)))
            low, high = fact[0] - slack, fact[1] + slack
            if low > most or high < least:
                raise self._contradiction(e, low, high, Bounds(least, most))
            return max(low, least), min(high, most), True
        return (least, most, False) if math.isfinite(most) else None

    def _contradiction(self, e: ir.Expr, low: float, high: float, found: Bounds) -> UserError:
        given = f'fact "{self.values.show(e)}" in [{low:.6g}, {high:.6g}]'
        return UserError(f"{given} contradicts the ranges, which give {found}")

    def _fact(self, e: ir.Expr) -> tuple[float, float] | None:
        """What a fact says of an expression; one of an array speaks of each of its elements."""
        if id(e) in self.facts or not self.facts:
            return self.facts.get(id(e))
        parts = ir.children(e)
        if not any(isinstance(c, ir.Index) for c in parts):
            return None
        parts = tuple(any_element(self.values, c.value) if isinstance(c, ir.Index) else c for c in parts)
        return self.facts.get(id(self.values.intern(ir.rebuild(e, parts))))

    def _narrowed(self, e: ir.Expr, found: Bound, cut: tuple[float, float, bool] | None) -> Bound:
        """The intervals cut to the ends; a length says nothing of what may overflow or be no number."""
        if cut is None:
            return found
        low, high, is_fact = cut
        if is_fact and any(_is_bounded(s) and not _meets(s, low, high) for s in found):
            raise self._contradiction(e, low, high, _hull((found[0],)))
        return remembered(
            ("cut", id(found), low, high, is_fact),
            lambda: tuple(_limited(s, low, high) if is_fact or _is_bounded(s) else s for s in found),
            found,
        )


def _hull(singles: tuple[Single, ...]) -> Bounds:
    ends = [_ends(s) for s in singles]
    return Bounds(min(low for low, _ in ends), max(high for _, high in ends))


def _ends(s: Single) -> tuple[float, float]:
    if isinstance(s, Truth):
        return (0.0 if s.false.any() else 1.0), (1.0 if s.true.any() else 0.0)
    return (float(s.low[0]), float(s.high[0])) if _is_bounded(s) else (-math.inf, math.inf)


def _is_bounded(s: Single) -> bool:
    return isinstance(s, Truth) or s.cause is None or not (s.cause > 0).any()


def _meets(s: Single, low: float, high: float) -> bool:
    return not isinstance(s, Truth) and bool(s.low[0] <= high and s.high[0] >= low)


def _limited(s: Single, low: float, high: float) -> Single:
    """The interval inside two ends; where it was unbounded, the ends themselves."""
    assert isinstance(s, Range)
    if s.cause is None and s.low[0] >= low and s.high[0] <= high:
        return s
    least, most = max(float(s.low[0]), low), min(float(s.high[0]), high)
    if not (math.isfinite(least) and math.isfinite(most)):
        return s
    return Range(np.array([least]), np.array([max(most, least)]), None, s.product)


def _parameter(type_: Type, domain: Domain | None) -> Bound:
    """A parameter anywhere in its domain; of an array, any element."""
    kind = type_.element if isinstance(type_, Array) else type_
    size = kind.size if isinstance(kind, Vector) else 1
    if domain is None or kind == BOOL:
        return _anything(kind)
    if not _is_float(kind):
        if not isinstance(domain, Interval):
            return _anything(kind)
        element = kind.element if isinstance(kind, Vector) else kind
        first, last = math.ceil(domain.low), math.floor(domain.high)
        return tuple(_whole(first, last, element) for _ in range(size))
    low, high = ends(domain)
    if 0.0 < low < SMALLEST:  # may be read as 0
        low = 0.0
    if -SMALLEST < high < 0.0:
        high = 0.0
    return tuple(_interval(low, high) for _ in range(size))


def _anything(type_: Type) -> Bound:
    element = type_.element if isinstance(type_, Vector) else type_
    size = type_.size if isinstance(type_, Vector) else 1
    return tuple(_any_single(element) for _ in range(size)) if isinstance(element, Scalar) else ()


def _any_single(element: Scalar) -> Single:
    if element == BOOL:
        return Truth(np.array([True]), np.array([True]))
    if element.name.startswith("f"):
        return Range(np.array([-np.inf]), np.array([np.inf]), np.array([1], np.int16))
    return _whole(-(2**31), 2**31 - 1, element) if element == I32 else _whole(0, 2**32 - 1, element)


def _whole(first: int, last: int, element: Type) -> Whole:
    return Whole(np.array([first], np.int64), np.array([last], np.int64), element == I32)


def _interval(low: float, high: float) -> Range:
    a = np.array([low])
    return Range(a, a if low == high else np.array([high]))


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


def ends(domain: Domain) -> tuple[float, float]:
    """The least and largest component that a domain of floats allows."""
    assert not isinstance(domain, Edges)
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
