"""Interval values: floats, whole numbers and truth values over arrays of lanes.

Arrays have shape (N,), or (1,) for a value that all lanes share; both ends have the same. A vector is a tuple
of scalars and a struct a dict, so that each scalar keeps its identity: an operation on one and the same value
twice (x * x, x - x) is seen as such.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np

from codegen.intervals.causes import Codes, first
from codegen.intervals.compiled import ends, kernels, wanted
from codegen.intervals.numbers import Array, Reach, reach, select

_serial = itertools.count().__next__
"""Numbers of values: no two values of a process have the same, unless one is the other computed again."""


@dataclass(frozen=True, eq=False, slots=True)
class Product:
    """An unrounded product, by its factors: its ends take as long to write as to compute, and few are used.

    first, second  ends of the factors; where only one is shared by all lanes, it is the second. None where
                   rounding permits all that a multiply-add may give
    is_square      whether both are one value
    is_opposite    whether the product is meant with the other sign
    """

    first: tuple[Array, Array] | None
    second: tuple[Array, Array] | None
    is_square: bool = False
    is_opposite: bool = False

    def opposite(self) -> Product:
        """The same with the other sign."""
        return replace(self, is_opposite=not self.is_opposite)


@dataclass(eq=False, slots=True, weakref_slot=True)
class Range:
    """Floats between two float32 numbers, held in float64.

    low, high  ends, both included; the same array for values that are known exactly
    cause      numbers of causes where the value may be anything, NaN included; its ends are then infinite
    product    for a rounded product, the unrounded one: a multiply-add may use it
    known      its reach, see codegen.intervals.numbers.reach, once it was asked for
    number     which value it is
    """

    low: Array
    high: Array
    cause: Codes = None
    product: Product | None = None
    known: Reach | None = None
    number: int = field(default_factory=_serial)

    @property
    def is_point(self) -> bool:
        return self.low is self.high

    @property
    def reach(self) -> Reach:
        if self.known is None:
            self.known = reach(self.low, self.high)
        return self.known

    def cut(self, low: Array, high: Array) -> None:
        """Narrow it in place, for all who hold it; one end may be of each lane and the other shared."""
        self.low, self.high = _alike(low, high)
        self.known = None


@dataclass(eq=False, slots=True, weakref_slot=True)
class Whole:
    """Integers between two ends, int64; `is_signed` tells i32 from u32."""

    low: Array
    high: Array
    is_signed: bool
    cause: Codes = None
    number: int = field(default_factory=_serial)

    @property
    def is_point(self) -> bool:
        return self.low is self.high

    def cut(self, low: Array, high: Array) -> None:
        """Narrow it in place, for all who hold it; one end may be of each lane and the other shared."""
        self.low, self.high = _alike(low, high)

    @property
    def limits(self) -> tuple[int, int]:
        """The smallest and the largest integer of the type."""
        return (-(2**31), 2**31 - 1) if self.is_signed else (0, 2**32 - 1)


def _alike(low: Array, high: Array) -> tuple[Array, Array]:
    """Both ends of one shape, as whoever computes with them takes them to be."""
    if len(low) == len(high):
        return low, high
    low, high = np.broadcast_arrays(low, high)
    return np.ascontiguousarray(low), np.ascontiguousarray(high)


@dataclass(eq=False, slots=True)
class Truth:
    """Truth values: whether a lane may be true, and whether it may be false."""

    true: Array
    false: Array
    number: int = field(default_factory=_serial)

    @property
    def undecided(self) -> Array:
        return np.asarray(self.true & self.false)


Single = Range | Whole | Truth
Value = Single | tuple[Single, ...] | dict[str, "Value"]

N = TypeVar("N", Range, Whole)


def constant(value: float | int | bool, is_signed: bool) -> Single:
    """A literal, shared by all lanes."""
    if isinstance(value, bool):
        return Truth(np.array([value]), np.array([not value]))
    if isinstance(value, int):
        whole = np.array([value], np.int64)
        return Whole(whole, whole, is_signed)
    a = np.array([value], np.float64)
    return Range(a, a)


def always(value: bool) -> Truth:
    """A truth value that all lanes share."""
    return Truth(np.array([value]), np.array([not value]))


def all_of(a: Truth, b: Truth) -> Truth:
    """Conjunction."""
    return Truth(a.true & b.true, a.false | b.false)


def any_of(a: Truth, b: Truth) -> Truth:
    """Disjunction."""
    return Truth(a.true | b.true, a.false & b.false)


def opposite(a: Truth) -> Truth:
    """Negation."""
    return Truth(a.false, a.true)


def choose(condition: Truth, if_true: Value, if_false: Value) -> Value:
    """The chosen value where the condition is decided, and the hull of both where it is not."""
    if if_true is if_false or not np.count_nonzero(condition.false):
        return if_true
    if not np.count_nonzero(condition.true):
        return if_false
    if isinstance(if_true, dict):
        assert isinstance(if_false, dict)
        return {name: choose(condition, v, if_false[name]) for name, v in if_true.items()}
    if isinstance(if_true, tuple):
        assert isinstance(if_false, tuple)
        return tuple(_choose(condition, a, b) for a, b in zip(if_true, if_false, strict=True))
    assert isinstance(if_false, Range | Whole | Truth)
    return _choose(condition, if_true, if_false)


def _choose(condition: Truth, a: Single, b: Single) -> Single:
    t, f = condition.true, condition.false
    if a is b:
        return a
    if isinstance(a, Truth):
        assert isinstance(b, Truth)
        return Truth((t & a.true) | (f & b.true), (t & a.false) | (f & b.false))
    if isinstance(a, Range):
        assert isinstance(b, Range)
        low, high = _hull(t, f, a, b)
        return Range(low, high, _cause(t, f, a.cause, b.cause))
    assert isinstance(b, Whole)
    low, high = _hull(t, f, a, b)
    return Whole(low, high, a.is_signed, _cause(t, f, a.cause, b.cause))


def _hull(t: Array, f: Array, a: N, b: N) -> tuple[Array, Array]:
    if isinstance(a, Range) and wanted(len(t)) and not (a.is_point and b.is_point):
        low, high = np.empty(len(t)), np.empty(len(t))
        kernels().choose(t, f, *ends(a.low, a.high), *ends(b.low, b.high), low, high)
        return low, high
    both = t & f
    low = select(t, a.low, b.low)
    if not both.any():
        return (low, low) if a.is_point and b.is_point else (low, select(t, a.high, b.high))
    return (
        select(both, np.minimum(a.low, b.low), low),
        select(both, np.maximum(a.high, b.high), select(t, a.high, b.high)),
    )


def _cause(t: Array, f: Array, a: Codes, b: Codes) -> Codes:
    kept_a = None if a is None else np.where(t, a, np.int16(0))
    kept_b = None if b is None else np.where(f, b, np.int16(0))
    return first(kept_a, kept_b)
