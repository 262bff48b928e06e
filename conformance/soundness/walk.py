"""Walks a function's IR over enclosures: integers and truth values are exact, floats are enclosed.

Where an enclosure does not decide a comparison, a rounding to an integer or a bit pattern, the lane is lost:
its result says nothing. Lanes that do not take a branch are not lost in it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial, reduce
from typing import Any, cast

import numpy as np

from codegen.evaluate.arrays import arithmetic, convert_inputs
from codegen.ir import nodes as ir
from codegen.ir.types import F32, I32, Scalar, Struct, Vector
from codegen.library import Library
from codegen.ops import BUILTINS, OPERATORS
from conformance.soundness import enclosure
from conformance.soundness.enclosure import Array, Enclosure, point

Single = Enclosure | Array
Value = Single | tuple[Single, ...] | dict[str, "Value"]

_EXACT = arithmetic("float64")
"""Integers and truth values are those of every arithmetic."""


def enclosed(library: Library, name: str, inputs: Mapping[str, Any]) -> tuple[Value, Array]:
    """The exact values over arrays of inputs, as enclosures; and the lanes that are lost."""
    function = library.function(name)
    types = {p.name: p.type for p in function.parameters}
    arrays, count = convert_inputs(types, inputs, arithmetic("float32"), name)
    arguments = {p.name: _input(p.type, arrays[p.name]) for p in function.parameters}
    lost = np.zeros(count, np.bool_)
    with np.errstate(all="ignore"):
        value = Walk(library, count, lost).call(function, arguments, np.ones(count, np.bool_))
    return value, lost


def _input(type_: Any, given: Any) -> Value:
    if isinstance(type_, Struct):
        return {f.name: _input(f.type, given[f.name]) for f in type_.fields}
    if isinstance(type_, Vector):
        return tuple(_single(np.ascontiguousarray(given[:, k])) for k in range(type_.size))
    return _single(given)


def _single(given: Array) -> Single:
    if given.dtype.kind == "f":
        return point(given.astype(np.float64))
    return given


def leaves(value: Value) -> list[Single]:
    """Every scalar of a value, in order."""
    if isinstance(value, dict):
        return [leaf for part in value.values() for leaf in leaves(part)]
    return list(value) if isinstance(value, tuple) else [value]


def _chosen(condition: Array, a: Value, b: Value) -> Value:
    if a is b:
        return a
    if isinstance(a, dict):
        assert isinstance(b, dict)
        return {name: _chosen(condition, part, b[name]) for name, part in a.items()}
    if isinstance(a, tuple):
        return tuple(cast(Single, _chosen(condition, p, q)) for p, q in zip(a, cast(Any, b), strict=True))
    if isinstance(a, Enclosure):
        return enclosure.choose(condition, a, cast(Enclosure, b))
    return np.where(condition, a, cast(Array, b))


class Walk:
    """One evaluation: its library, how many lanes it has, and which of them are lost."""

    def __init__(self, library: Library, count: int, lost: Array) -> None:
        self.library = library
        self.count = count
        self.lost = lost

    def call(self, function: ir.Function, arguments: dict[str, Value], active: Array) -> Value:
        """A function's value; lanes that are not active are never lost."""
        frame = _Frame(self, dict(arguments), active)
        frame.block(function.body, active)
        assert frame.result is not None
        return frame.result

    def lose(self, lanes: Array) -> None:
        np.logical_or(self.lost, lanes, out=self.lost)


class _Frame:
    def __init__(self, walk: Walk, scope: dict[str, Value], active: Array) -> None:
        self.walk = walk
        self.scope = scope
        self.result: Value | None = None
        self.returned = ~active

    def block(self, body: tuple[ir.Stmt, ...], active: Array) -> None:
        for s in body:
            live = active & ~self.returned
            match s:
                case ir.Let():
                    self.scope[s.name] = self.expr(s.value, live)
                case ir.Assign():
                    self.scope[s.name] = _chosen(live, self.expr(s.value, live), self.scope[s.name])
                case ir.If():
                    condition = cast(Array, self.expr(s.condition, live))
                    self.block(s.then, live & condition)
                    self.block(s.orelse, live & ~condition)
                case ir.For():
                    limit = None if s.limit is None else cast(Array, self.expr(s.limit, live))
                    dtype = _EXACT.dtype(cast(Scalar, s.index_type))
                    for i in range(s.start, s.stop):
                        self.scope[s.name] = np.full(self.walk.count, i, dtype)
                        self.block(s.body, live if limit is None else live & (limit > i))
                case ir.Return():
                    value = self.expr(s.value, live)
                    self.result = value if self.result is None else _chosen(live, value, self.result)
                    self.returned = self.returned | live

    def expr(self, e: ir.Expr, live: Array) -> Value:
        match e:
            case ir.Const():
                return self.constant(e)
            case ir.Var():
                return self.scope[e.name]
            case ir.Unary():
                return self.each(lambda a: self.unary(e.op, a), self.expr(e.operand, live))
            case ir.Binary():
                left = self.expr(e.left, live)
                right = left if e.right == e.left else self.expr(e.right, live)
                return self.each(lambda a, b: self.binary(e.op, a, b, live), left, right)
            case ir.Builtin():
                return self.builtin(e.op, live, [self.expr(a, live) for a in e.args])
            case ir.Call():
                function = self.walk.library.function(e.function)
                values = [self.expr(a, live) for a in e.args]
                names = [p.name for p in function.parameters]
                return self.walk.call(function, dict(zip(names, values, strict=True)), live)
            case ir.Construct():
                parts = [self.expr(a, live) for a in e.args]
                if isinstance(e.type, Struct):
                    return {f.name: part for f, part in zip(e.type.fields, parts, strict=True)}
                flat = [s for part in parts for s in leaves(part)]
                return tuple(flat * cast(Vector, e.type).size if len(flat) == 1 else flat)
            case ir.Convert():
                return self.each(lambda a: self.convert(e.type, a, live), self.expr(e.operand, live))
            case ir.Member():
                return cast(dict[str, Value], self.expr(e.value, live))[e.name]
            case ir.Index():
                return self.element(cast(dict[str, Value], self.expr(e.value, live)), e.index, live)
            case ir.Swizzle():
                vector = cast(tuple[Single, ...], self.expr(e.value, live))
                chosen = tuple(vector["xyzw".index(c)] for c in e.components)
                return chosen[0] if len(chosen) == 1 else chosen
            case ir.Select():
                condition = cast(Array, self.expr(e.condition, live))
                if_true = self.expr(e.if_true, live & condition)
                return _chosen(condition, if_true, self.expr(e.if_false, live & ~condition))

    def element(self, value: dict[str, Value], index: ir.Expr, live: Array) -> Value:
        number = cast(Array, self.expr(index, live))
        found = value["0"]
        for k in range(1, len(value)):
            found = _chosen(number == k, value[str(k)], found)
        return found

    def constant(self, e: ir.Const) -> Single:
        if e.type == F32:
            return point(np.full(self.walk.count, e.value, np.float64))
        assert isinstance(e.type, Scalar)
        return np.full(self.walk.count, e.value, _EXACT.dtype(e.type))

    def each(self, apply: Callable[..., Single], *parts: Value) -> Value:
        """Component by component; a scalar goes with every component of a vector."""
        size = max((len(p) for p in parts if isinstance(p, tuple)), default=0)
        if size == 0:
            return apply(*parts)
        columns = [p if isinstance(p, tuple) else (p,) * size for p in parts]
        return tuple(apply(*c) for c in zip(*columns, strict=True))

    def unary(self, op: str, a: Single) -> Single:
        if isinstance(a, Enclosure):
            return enclosure.negate(a)
        return np.asarray(OPERATORS[op].meaning(_EXACT.namespace, a))

    def binary(self, op: str, a: Single, b: Single, live: Array) -> Single:
        if not isinstance(a, Enclosure):
            return np.asarray(OPERATORS[op].meaning(_EXACT.namespace, a, b))
        assert isinstance(b, Enclosure)
        match op:
            case "+":
                return enclosure.add(a, b)
            case "-":
                return enclosure.add(a, enclosure.negate(b))
            case "*":
                return enclosure.multiply(a, b)
            case "/":
                return enclosure.divide(a, b)
            case "<" | ">=":
                surely, never = a.high < b.low, a.low >= b.high
            case ">" | "<=":
                surely, never = a.low > b.high, a.high <= b.low
            case _:
                surely = (a.low == b.high) & (a.high == b.low)
                never = (a.high < b.low) | (a.low > b.high)
        self.walk.lose(live & ~surely & ~never)
        return never if op in (">=", "<=", "!=") else surely

    def builtin(self, op: str, live: Array, args: list[Value]) -> Value:
        if op in _VECTORS:
            return cast(Value, _VECTORS[op](*args))
        return self.each(lambda *a: self.scalar(op, live, a), *args)

    def scalar(self, op: str, live: Array, args: tuple[Single, ...]) -> Single:
        if op == "bits_to_float":
            return _from_bits(cast(Array, args[0]))
        if not isinstance(args[0], Enclosure):
            return np.asarray(BUILTINS[op].meaning(_EXACT.namespace, *args))
        floats = cast(tuple[Enclosure, ...], args)
        if op in ("floor", "float_to_bits"):
            return self.decided(op, floats[0], live)
        return _SCALARS[op](*floats)

    def decided(self, op: str, a: Enclosure, live: Array) -> Single:
        """What both ends agree on; the lanes where they do not are lost."""
        function = np.floor if op == "floor" else _to_bits
        low, high = function(a.low), function(a.high)
        self.walk.lose(live & (low != high))
        return point(low) if op == "floor" else low

    def convert(self, type_: Any, a: Single, live: Array) -> Single:
        if isinstance(a, Enclosure):
            if type_ == F32:
                return a
            low, high = np.trunc(a.low), np.trunc(a.high)
            least, most = (-(2**31), 2**31 - 1) if type_ == I32 else (0, 2**32 - 1)
            known = (low == high) & (low >= least) & (low <= most)
            self.walk.lose(live & ~known)
            return np.where(known, low, 0.0).astype(np.int64).astype(_EXACT.dtype(type_))
        if type_ != F32:
            return a.astype(_EXACT.dtype(type_))
        number = a.astype(np.float64)
        return Enclosure(number, number, short=bool((np.abs(number) <= 2.0**24).all()))


def _to_bits(x: Array) -> Array:
    return np.ascontiguousarray(x.astype(np.float32)).view(np.uint32)


def _from_bits(bits: Array) -> Enclosure:
    number = np.ascontiguousarray(bits.astype(np.uint32)).view(np.float32).astype(np.float64)
    finite = np.isfinite(number)
    if finite.all():
        return point(number)
    return Enclosure(np.where(finite, number, -np.inf), np.where(finite, number, np.inf))


def _inverse_root(a: Enclosure) -> Enclosure:
    return enclosure.divide(point(np.ones_like(a.low)), enclosure.square_root(a))


def _clamped(x: Enclosure, least: Enclosure, most: Enclosure) -> Enclosure:
    return enclosure.smaller(enclosure.larger(x, least), most)


_SCALARS: dict[str, Callable[..., Enclosure]] = {
    "abs": enclosure.absolute,
    "min": enclosure.smaller,
    "max": enclosure.larger,
    "clamp": _clamped,
    "sqrt": enclosure.square_root,
    "inverse_sqrt": _inverse_root,
    "exp": partial(enclosure.increasing, np.exp),
    "exp2": partial(enclosure.increasing, np.exp2),
    "log": partial(enclosure.logarithm, np.log),
    "log2": partial(enclosure.logarithm, np.log2),
    "sin": partial(enclosure.sine, quarter=0.0),
    "cos": partial(enclosure.sine, quarter=1.0),
    "atan2": enclosure.arc_tangent,
}


def _dot(a: Any, b: Any) -> Enclosure:
    return reduce(enclosure.add, map(enclosure.multiply, a, b))


def _length(a: Any) -> Enclosure:
    return enclosure.square_root(_dot(a, a))


def _cross(a: Any, b: Any) -> tuple[Enclosure, ...]:
    return tuple(
        enclosure.add(enclosure.multiply(a[i], b[j]), enclosure.negate(enclosure.multiply(a[j], b[i])))
        for i, j in ((1, 2), (2, 0), (0, 1))
    )


def _normalized(a: Any) -> tuple[Enclosure, ...]:
    size = _length(a)
    return tuple(enclosure.divide(c, size) for c in a)


_VECTORS: dict[str, Callable[..., Any]] = {
    "dot": _dot,
    "cross": _cross,
    "length": _length,
    "normalize": _normalized,
}
