"""The results that a table permits, lane by lane, for a function over arrays of inputs."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np

from codegen.evaluate.arrays import Array, arithmetic, convert_inputs
from codegen.evaluate.arrays import Value as Arrays
from codegen.evaluate.interpreter import with_edges
from codegen.evaluate.textures import as_map
from codegen.intervals.arithmetic import from_input
from codegen.intervals.causes import Cause, CauseBook
from codegen.intervals.context import Context, Ways
from codegen.intervals.interpreter import Frame
from codegen.intervals.tables import Table, load_table
from codegen.intervals.threads import threads
from codegen.intervals.values import Single, Truth, Value, Whole
from codegen.ir.types import BOOL, F32, I32, Scalar, Struct, Type, Vector, leaves
from codegen.library import Library

Lanes = Array | slice
"""Some of all lanes, by their numbers or in a row."""
CHUNK = 65536
"""Lanes evaluated together at most: many, since threads wait for each other between operations."""
LEAST_CHUNK = 16384
"""Lanes that are not divided among threads."""
DEPTH = 6
"""Forks that one lane is followed through; further ones count by their hull."""
MOST_PARTS = 32
"""Ways of one lane that are followed at a time; a lane with more keeps the hull that it has."""


@dataclass(frozen=True)
class Permitted:
    """Intervals of permitted results.

    low, high   ends, in the shapes of codegen.evaluate.evaluate: float64 for f32, integers, truth values
    codes       int16 (N,): 0 where every component is bounded, else the number of the first cause
    causes      the causes; number k is causes[k - 1]
    """

    low: Arrays
    high: Arrays
    codes: Array
    causes: tuple[Cause, ...]

    @property
    def guaranteed(self) -> Array:
        """Mask of the lanes whose result the table bounds."""
        return np.asarray(self.codes == 0)

    def cause(self, lane: int) -> str:
        """Why a lane's result may be anything: operation, operand, place; empty where it is bounded."""
        code = int(self.codes[lane])
        return str(self.causes[code - 1]) if code else ""

    def histogram(self) -> dict[Cause, int]:
        """Cause -> number of lanes, most frequent first."""
        counts = np.bincount(self.codes, minlength=len(self.causes) + 1)[1:]
        order = np.argsort(-counts, kind="stable")
        return {self.causes[k]: int(counts[k]) for k in order if counts[k]}

    def contains(self, value: Arrays) -> Array:
        """Mask of the lanes whose result lies inside, all components; anything permits anything."""
        inside = self.codes > 0
        return np.asarray(inside | _inside(self.low, self.high, value))


def _inside(low: Arrays, high: Arrays, value: Arrays) -> Array:
    if isinstance(value, dict):
        assert isinstance(low, dict)
        assert isinstance(high, dict)
        return np.asarray(np.logical_and.reduce([_inside(low[n], high[n], v) for n, v in value.items()]))
    assert not isinstance(low, dict)
    assert not isinstance(high, dict)
    ok = np.asarray((value >= low) & (value <= high))
    return np.asarray(ok.all(axis=-1) if ok.ndim == 2 else ok)


def permitted(
    library: Library, name: str, inputs: Mapping[str, Any], table: Table | str, *, follow_forks: bool = True
) -> Permitted:
    """What a table permits the function to return.

    inputs        as for codegen.evaluate.evaluate, rounded to float32; a denormal may be read as 0
    table         a table or its name
    follow_forks  follow lanes whose comparisons their intervals do not decide along each way; without, the
                  hull of both sides counts, which is wider and quicker
    raises        UserError for unknown functions, parameters, tables or shapes
    """
    chosen = load_table(table) if isinstance(table, str) else table
    return _Run(library, name, inputs, chosen).run(follow_forks)


class _Run:
    def __init__(self, library: Library, name: str, inputs: Mapping[str, Any], table: Table) -> None:
        self.library = library
        self.function = library.function(name)
        types = {p.name: p.type for p in self.function.parameters}
        arrays, self.count = convert_inputs(types, inputs, arithmetic("float32"), name)
        self.inputs = with_edges(self.function, arrays)
        self.table = table
        self.book = CauseBook()
        kinds = [scalar for _, scalar in leaves(self.function.returns)]
        self.low = [np.empty(self.count, _dtype(kind)) for kind in kinds]
        self.high = [np.empty(self.count, _dtype(kind)) for kind in kinds]
        self.codes = np.zeros(self.count, np.int16)

    def run(self, follow_forks: bool) -> Permitted:
        self.library.select([self.function.name])  # all that is called, before threads ask for it
        forks = np.full(self.count, -1, np.int32)
        widths = np.zeros(self.count, np.int32)
        for part, found in self.each_chunk(self.count, None, None):
            self.store(part, found)
            forks[part], widths[part] = found.first_fork, found.width
        if follow_forks and (forks >= 0).any():
            self.follow(np.flatnonzero(forks >= 0), forks, widths)
        shape = self.function.returns
        causes = tuple(self.book.causes)
        return Permitted(_build(shape, self.low), _build(shape, self.high), self.codes, causes)

    def each_chunk(
        self, total: int, owner: Array | None, ways: Ways | None
    ) -> Iterator[tuple[slice, _Found]]:
        """Positions in `owner`, or lanes without it, and what was found there, in order; some at a time."""
        at_a_time = threads()
        # As many for each thread, and all of one size, so that none is left alone at the end.
        count = at_a_time * max(-(-total // (at_a_time * CHUNK)), 1)
        size = max(min(LEAST_CHUNK, CHUNK), -(-total // count))
        parts = [slice(k, min(k + size, total)) for k in range(0, total, size)]

        def found(part: slice) -> tuple[_Found, CauseBook]:
            chosen = None if ways is None else Ways(ways.forks[part], ways.ways[part])
            with np.errstate(all="ignore"):
                return self.evaluate(part if owner is None else owner[part], part.stop - part.start, chosen)

        if len(parts) < 2 or at_a_time < 2:
            results = map(found, parts)
            yield from ((part, self.numbered(*result)) for part, result in zip(parts, results, strict=True))
            return
        with ThreadPoolExecutor(at_a_time) as pool:
            # A few chunks ahead only: what is found in them is kept until it is asked for.
            ahead: deque[Future[tuple[_Found, CauseBook]]] = deque()
            for k, part in enumerate(parts):
                while len(ahead) < 2 * at_a_time and k + len(ahead) < len(parts):
                    ahead.append(pool.submit(found, parts[k + len(ahead)]))
                yield part, self.numbered(*ahead.popleft().result())

    def numbered(self, found: _Found, book: CauseBook) -> _Found:
        """What one chunk found, its causes numbered as in the whole run."""
        if not book.causes:
            return found
        numbers = np.array([0, *(self.book.code(cause) for cause in book.causes)], np.int16)
        return replace(found, codes=numbers[found.codes])

    def evaluate(self, lanes: Lanes, count: int, ways: Ways | None) -> tuple[_Found, CauseBook]:
        book = CauseBook()
        context = Context(self.table, book, count, ways)
        context.function, context.line = self.function.name, self.function.place.line
        context.operation = "input"
        arguments = {
            p.name: _value(context, p.type, self.inputs[p.name], lanes) for p in self.function.parameters
        }
        value = Frame(self.library, context, self.function, arguments).run()
        singles = list(_singles(value))
        low = [np.broadcast_to(_low(s), count) for s in singles]
        high = [np.broadcast_to(_high(s), count) for s in singles]
        codes = np.zeros(count, np.int16)
        for s in singles:
            if not isinstance(s, Truth) and s.cause is not None:
                codes = np.where(codes > 0, codes, s.cause)
        return _Found(low, high, codes, context.first_fork, context.width), book

    def store(self, lanes: Lanes, found: _Found) -> None:
        """Put results in, one for each lane."""
        for k, (low, high) in enumerate(zip(found.low, found.high, strict=True)):
            self.low[k][lanes], self.high[k][lanes] = low, high
        self.codes[lanes] = found.codes

    def join(self, lanes: Array, found: _Found, seen: Array) -> None:
        """Put the hulls of results in, several for a lane in a row; joined to what is there where seen."""
        starts = np.flatnonzero(np.diff(lanes, prepend=-1))
        mine = lanes[starts]
        kept = seen[mine]

        def joined(into: Array, results: Array, hull: np.ufunc) -> None:
            new = hull.reduceat(results, starts)
            into[mine] = np.where(kept, hull(into[mine], new), new)

        for k, (low, high) in enumerate(zip(found.low, found.high, strict=True)):
            joined(self.low[k], low, np.minimum)
            joined(self.high[k], high, np.maximum)
        joined(self.codes, found.codes, np.maximum)

    def follow(self, lanes: Array, forks: Array, widths: Array) -> None:
        """Split lanes at their first open fork until none is open, or DEPTH or MOST_PARTS is reached."""
        before = [a[lanes].copy() for a in (*self.low, *self.high, self.codes)]
        owner = lanes
        path = Ways(np.empty((len(lanes), 0), np.int32), np.empty((len(lanes), 0), np.int32))
        fork, width = forks[lanes], widths[lanes]
        seen = np.zeros(self.count, np.bool_)
        given_up = np.zeros(self.count, np.bool_)
        for depth in range(DEPTH):
            parts = np.bincount(owner, weights=width, minlength=self.count)
            given_up |= parts > MOST_PARTS
            kept = ~given_up[owner]
            index = np.repeat(np.flatnonzero(kept), width[kept])
            if not len(index):
                break
            path = path.then(index, fork[index], _counted(width[kept]).astype(np.int32))
            owner = owner[index]
            open_fork, open_width = np.empty(len(owner), np.int32), np.empty(len(owner), np.int32)
            for part, found in self.each_chunk(len(owner), owner, path):
                open_fork[part], open_width[part] = found.first_fork, found.width
                done = (found.first_fork < 0) | (depth == DEPTH - 1)
                # The first finished way of a lane replaces its hull, later ones join it.
                if done.any():
                    mine = owner[part][done]
                    self.join(mine, found.select(done), seen)
                    seen[mine] = True
            rest = open_fork >= 0
            owner, fork, width = owner[rest], open_fork[rest], open_width[rest]
            path = Ways(path.forks[rest], path.ways[rest])
        lost = given_up[lanes]
        for a, old in zip((*self.low, *self.high, self.codes), before, strict=True):
            a[lanes[lost]] = old[lost]


@dataclass(frozen=True)
class _Found:
    low: list[Array]
    high: list[Array]
    codes: Array
    first_fork: Array
    width: Array

    def select(self, mask: Array) -> _Found:
        return _Found(
            [a[mask] for a in self.low],
            [a[mask] for a in self.high],
            self.codes[mask],
            self.first_fork[mask],
            self.width[mask],
        )


def _counted(widths: Array) -> Array:
    """0, 1, ... below each width, one after another."""
    ends = np.cumsum(widths)
    return np.asarray(np.arange(ends[-1]) - np.repeat(ends - widths, widths))


def _dtype(kind: Scalar) -> type[np.generic]:
    return np.bool_ if kind == BOOL else np.float64 if kind == F32 else np.int64


def _value(context: Context, type_: Type, given: Arrays, lanes: Lanes) -> Value:
    if isinstance(type_, Struct):
        assert isinstance(given, dict)
        return {f.name: _value(context, f.type, given[f.name], lanes) for f in type_.fields}
    if as_map(given) is not None:
        return cast(Value, given)
    assert isinstance(given, np.ndarray)
    assert isinstance(type_, Scalar | Vector)
    if isinstance(type_, Vector):
        return tuple(_single(context, type_.element, given[:, k][lanes]) for k in range(type_.size))
    return _single(context, type_, given[lanes])


def _single(context: Context, kind: Scalar, given: Array) -> Single:
    if kind == F32:
        return from_input(context, given)
    if kind == BOOL:
        return Truth(given.copy(), ~given)
    whole = given.astype(np.int64)
    return Whole(whole, whole, kind == I32)


def _singles(value: Value) -> Iterator[Single]:
    if isinstance(value, dict):
        for part in value.values():
            yield from _singles(part)
    elif isinstance(value, tuple):
        yield from value
    else:
        yield value


def _low(s: Single) -> Array:
    return ~s.false if isinstance(s, Truth) else s.low


def _high(s: Single) -> Array:
    return s.true if isinstance(s, Truth) else s.high


def _build(type_: Type, rows: list[Array]) -> Arrays:
    """Rows of scalars as a value of the type."""
    remaining = iter(rows)

    def build(t: Type) -> Arrays:
        if isinstance(t, Struct):
            return {f.name: build(f.type) for f in t.fields}
        if isinstance(t, Vector):
            return np.stack([next(remaining) for _ in range(t.size)], axis=-1)
        return next(remaining)

    return build(type_)
