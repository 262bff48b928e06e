"""The interpreter: the definition of the IR, and a fourth target that needs no device.

Every operation is rounded on its own (float32 stays float32). Both sides of a `Select` and both branches of
an `If` are computed for all lanes and chosen lane by lane; lanes that have returned keep their value.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping
from typing import Any, cast

import numpy as np

from codegen.evaluate.arrays import (
    Arithmetic,
    Array,
    Value,
    broadcast,
    choose,
    convert_inputs,
    row_by_row,
)
from codegen.evaluate.arrays import arithmetic as find_arithmetic
from codegen.evaluate.blocks import block_by_block
from codegen.evaluate.loops import Together, row, rows, together
from codegen.evaluate.memory import Memory
from codegen.evaluate.textures import as_map
from codegen.evaluate.vectors import stacked
from codegen.half import half_rules
from codegen.ir import nodes as ir
from codegen.ir.types import F16, F32, I32, TEXTURE, U32, Scalar, Struct, Type, Vector, element_of
from codegen.library import Library
from codegen.ops import BUILTINS, OPERATORS
from codegen.passes.half import SMALLEST_NORMAL, HalfRules, half_versions


def evaluate(
    library: Library,
    name: str,
    inputs: Mapping[str, Any],
    arithmetic: str = "float32",
    *,
    rules: HalfRules | None = None,
    memory: Memory | None = None,
) -> Value:
    """The function's values over arrays of inputs.

    inputs      parameter name -> array: scalars (N,), vectors (N, size), structs as dicts; one value repeats
    arithmetic  "float32" (op by op), "float64", "mpmath" (at mpmath's current precision), or the function's
                half form op by op: "float16", "float16-strict" (denormals are 0, overflow is NaN)
    rules       of the half form; those of the library if None
    memory      what was evaluated in this arithmetic before, over the same arrays as inputs
    returns     scalars (N,), vectors (N, size), structs as dicts of those
    raises      UserError for unknown functions, parameters or shapes
    """
    chosen = find_arithmetic(arithmetic)
    find: Callable[[str], ir.Function] = library.function
    if chosen.is_half:
        versions = half_versions(library, [name], half_rules(library) if rules is None else rules)
        find = {v.function.name: v.function for v in versions}.__getitem__
    function = find(name)
    if memory is None:
        types = {p.name: p.type for p in function.parameters}
        arrays, count = convert_inputs(types, inputs, chosen, name, repeated=False)
    else:
        arrays, count = memory.inputs(function, inputs, chosen)
    arrays = with_edges(function, arrays)

    def run(some: dict[str, Value], lanes: int) -> Value:
        return broadcast(Frame(find, chosen, function, some, lanes, memory).run(), lanes)

    with np.errstate(all="ignore"):  # lanes that a branch does not take may overflow or divide by zero
        whole = memory is not None or chosen.floats is np.object_
        return row_by_row(run(arrays, count) if whole else block_by_block(run, arrays, count))


def with_edges(function: ir.Function, arrays: dict[str, Value]) -> dict[str, Value]:
    """The inputs with maps that go on beyond their edges as the parameters' domains say."""
    domains = {p.name: p.domain for p in function.parameters}
    found = dict(arrays)
    for name, value in arrays.items():
        texture = as_map(value)
        if texture is not None:
            found[name] = cast(Value, texture.with_edges(domains[name]))
    return found


def _alike(kind: np.dtype[Any], value: float | int | bool) -> Array:
    """A number that is the same in all lanes; the same object for the same number, not to be written to."""
    return _kept(kind, value, value == 0 and math.copysign(1.0, value) < 0.0)


@functools.lru_cache(1024)
def _kept(kind: np.dtype[Any], value: float | int | bool, negative_zero: bool) -> Array:
    one = np.full(1, value, kind)
    one.setflags(write=False)
    return one


@functools.lru_cache(16)
def _numbered(start: int, stop: int) -> Array:
    """The numbers of a loop's iterations, one a row; not to be written to."""
    numbers = np.arange(start, stop, dtype=np.int32)[:, None]
    numbers.setflags(write=False)
    return numbers


class Frame:
    """One call: its locals, which lanes still run, and what has been returned so far."""

    takes_loops_apart = True
    """Whether loops may be evaluated all iterations at once, in other expressions than the function's own;
    not where values have rows already."""

    def __init__(
        self,
        find: Callable[[str], ir.Function],
        arithmetic: Arithmetic,
        function: ir.Function,
        inputs: dict[str, Value],
        count: int,
        memory: Memory | None = None,
    ) -> None:
        self.find = find
        self.arithmetic = arithmetic
        self.function = function
        self.scope: dict[str, Value] = dict(inputs)
        self.count = count
        self.memory = memory
        self.made: Mapping[int, Value] = {}
        self.result: Value | None = None
        self.returned: Array | None = None

    def run(self) -> Value:
        self.block(self.function.body, None)
        assert self.result is not None
        return self.result

    def block(self, body: tuple[ir.Stmt, ...], active: Array | None) -> None:
        """Run statements for the active lanes; None: all lanes, so that nothing has to be chosen."""
        for s in body:
            match s:
                case ir.Let():
                    self.scope[s.name] = self.whole(s.value)
                case ir.Assign():
                    value, live = self.whole(s.value), self.live(active)
                    if live is not None and not live.all():
                        value = choose(live, value, self.scope[s.name], s.value.type)
                    self.scope[s.name] = value
                case ir.If():
                    condition = self.array(s.condition)
                    self.block(s.then, condition if active is None else active & condition)
                    self.block(s.orelse, ~condition if active is None else active & ~condition)
                case ir.For():
                    self.loop(s, active)
                case ir.Return():
                    value, live = self.whole(s.value), self.live(active)
                    if live is None:
                        live = _alike(np.dtype(np.bool_), True)
                    if self.result is not None:
                        value = choose(live, value, self.result, s.value.type)
                    self.result = value
                    self.returned = live if self.returned is None else self.returned | live

    def live(self, active: Array | None) -> Array | None:
        """The active lanes that have not returned; None: all lanes."""
        if self.returned is None:
            return active
        return ~self.returned if active is None else active & ~self.returned

    def loop(self, s: ir.For, active: Array | None) -> None:
        """As many iterations as the lane that runs longest has; the others wait."""
        apart = together(s) if active is None and self.returned is None and self.takes_loops_apart else None
        if apart is not None:
            self.iterations(s, apart)
            return
        if s.limit is None:
            for i in range(s.start, s.stop):
                self.scope[s.name] = _alike(np.dtype(np.int32), i)
                self.block(s.body, active)
            return
        limit, live = self.array(s.limit), self.live(active)
        most = int((limit if live is None else np.where(live, limit, 0)).max(initial=0))
        for i in range(s.start, min(s.stop, most)):
            self.scope[s.name] = _alike(limit.dtype, i)
            self.block(s.body, limit > i if active is None else active & (limit > i))

    def iterations(self, s: ir.For, apart: Together) -> None:
        """All iterations of a loop at once, then what each hands to the next."""
        steps = range(s.start, s.stop)
        scope = {name: self.scope[name] for name in apart.outer}
        for name, array in apart.elements.items():
            value = self.scope[array]
            assert isinstance(value, dict)
            scope[name] = self.rows([value.get(str(i), value["0"]) for i in steps])
        scope[s.name] = _numbered(s.start, s.stop)
        inner = Frame(self.find, self.arithmetic, self.function, scope, self.count, self.memory)
        inner.takes_loops_apart = False
        inner.block(apart.lets, None)
        for k, i in enumerate(steps):
            self.scope[s.name] = _alike(np.dtype(np.int32), i)
            for name, type_ in apart.inner.items():
                self.scope[name] = row(inner.scope[name], k, type_)
            for end in apart.ends:
                self.scope[end.name] = self.expr(end.value)

    def rows(self, values: list[Value]) -> Value:
        """The values of the iterations as rows of one; remembered where there is a memory."""
        if self.memory is None:
            return rows(values)
        return self.memory.value("rows", values, lambda: rows(values))

    def whole(self, e: ir.Expr) -> Value:
        """The value of a statement's expression or of an argument; remembered where there is a memory."""
        memory, scope = self.memory, self.scope
        if type(e) is ir.Var:
            return scope[e.name]
        if memory is None:
            return self.expr(e)
        if type(e) is ir.Call:
            return self.call(e)
        known = memory.prepared(e)
        of = [scope[x] for x in known.variables]
        made: dict[int, Value] = {}
        if known.calls:
            made = {id(call): self.call(call) for call in known.calls}
            of += made.values()
        key = (known.number, self.count, *map(id, of))
        value = memory.find(key)
        if value is None:
            self.made = made
            value = memory.keep(key, self.expr(e), of)
            self.made = {}
        return value

    def array(self, e: ir.Expr) -> Array:
        value = self.expr(e)
        assert isinstance(value, np.ndarray)
        return value

    def expr(self, e: ir.Expr) -> Value:
        """The value of an expression."""
        return _EVALUATE[type(e)](self, e)

    def variable(self, e: ir.Var) -> Value:
        return self.scope[e.name]

    def unary(self, e: ir.Unary) -> Array:
        return self.fit(e.type, OPERATORS[e.op].meaning(self.arithmetic.namespace, self.array(e.operand)))

    def binary(self, e: ir.Binary) -> Array:
        a, b = self.array(e.left), self.array(e.right)
        if e.left.type is not e.right.type:
            wide = isinstance(e.left.type, Vector), isinstance(e.right.type, Vector)
            if wide[0] != wide[1]:
                a, b = (a, b[..., None]) if wide[0] else (a[..., None], b)
        return self.fit(e.type, OPERATORS[e.op].meaning(self.arithmetic.namespace, a, b))

    def builtin(self, e: ir.Builtin) -> Value:
        args = [self.expr(a) for a in e.args]
        meaning = BUILTINS[e.op].meaning
        if e.args[0].type == TEXTURE and len(args) > 1:
            return self.fit(e.type, _looked_up(functools.partial(meaning, self.arithmetic.namespace), *args))
        return self.fit(e.type, meaning(self.arithmetic.namespace, *args))

    def made_or_called(self, e: ir.Call) -> Value:
        return self.made[id(e)] if id(e) in self.made else self.call(e)

    def member(self, e: ir.Member) -> Value:
        value = self.expr(e.value)
        assert isinstance(value, dict)
        return value[e.name]

    def index(self, e: ir.Index) -> Value:
        return self.element(self.expr(e.value), self.array(e.index), e.type)

    def swizzle(self, e: ir.Swizzle) -> Array:
        columns = ["xyzw".index(c) for c in e.components]
        a = self.array(e.value)
        return a[..., columns[0]] if len(columns) == 1 else stacked([a[..., k] for k in columns])

    def select(self, e: ir.Select) -> Value:
        return choose(self.array(e.condition), self.expr(e.if_true), self.expr(e.if_false), e.type)

    def element(self, value: Value, index: Array, type_: Type) -> Value:
        """The elements of an array that the lanes' numbers name."""
        assert isinstance(value, dict)
        if index.size == 1:  # one number for all lanes, as in a loop
            return value.get(str(int(index.item())), value["0"])
        found = value["0"]
        for k in range(1, len(value)):
            found = choose(index == k, value[str(k)], found, type_)
        return found

    def constant(self, e: ir.Const) -> Array:
        assert isinstance(e.type, Scalar)
        kind = self.arithmetic.dtype(e.type)
        value = self.arithmetic.literal(e.value) if kind is self.arithmetic.floats else e.value
        return np.full(1, value, object) if kind is np.object_ else _alike(np.dtype(kind), value)

    def fit(self, type_: Type, value: Any) -> Array:
        """The value in the arithmetic's own dtype: numpy widens in places (comparisons of mpmath numbers)."""
        dtype = self.arithmetic.dtypes[type_.name]
        if isinstance(value, np.ndarray) and value.dtype.type is dtype and not self.arithmetic.strict:
            return value
        fitted = np.asarray(value).astype(dtype, copy=False)
        if self.arithmetic.strict and element_of(type_) == F16:
            kept = np.where(np.abs(fitted) < np.float16(SMALLEST_NORMAL), np.float16(0.0), fitted)
            return np.where(np.isinf(kept), np.float16(np.nan), kept)
        return fitted

    def call(self, e: ir.Call) -> Value:
        function = self.find(e.function)
        inputs = {p.name: self.whole(a) for p, a in zip(function.parameters, e.args, strict=True)}
        if self.memory is None:
            return self.inner(function, inputs).run()
        return self.memory.value(
            function.name, list(inputs.values()), lambda: self.inner(function, inputs).run(), self.count
        )

    def inner(self, function: ir.Function, inputs: dict[str, Value]) -> Frame:
        """The frame of a call."""
        frame = Frame(self.find, self.arithmetic, function, inputs, self.count, self.memory)
        frame.takes_loops_apart = self.takes_loops_apart
        return frame

    def construct(self, e: ir.Construct) -> Value:
        type_, parts = e.type, [self.expr(a) for a in e.args]
        if isinstance(type_, Struct):
            return {f.name: part for f, part in zip(type_.fields, parts, strict=True)}
        assert isinstance(type_, Vector)
        columns: list[Array] = []
        for a, part in zip(e.args, parts, strict=True):
            assert isinstance(part, np.ndarray)
            wide = isinstance(a.type, Vector)
            columns += [part[..., k] for k in range(part.shape[-1])] if wide else [part]
        if len(columns) == 1:
            columns *= type_.size
        return stacked(columns)

    def convert(self, e: ir.Convert) -> Array:
        type_, value = e.type, self.array(e.operand)
        if isinstance(type_, Vector):
            return self.fit(type_, value)
        assert isinstance(type_, Scalar)
        if type_ == F32 and self.arithmetic.name == "mpmath":
            return np.asarray(_each(lambda x: self.arithmetic.literal(int(x)), value), dtype=object)
        if value.dtype == object:
            low = -(2**31) if type_ == I32 else 0

            def clipped(x: Any) -> int:  # lanes that a branch does not take
                return min(max(int(x) if abs(x) < math.inf else 0, low), low + 2**32 - 1)

            return _each(clipped, value).astype(np.int64).astype(self.arithmetic.dtype(type_))
        if type_ == U32 and value.dtype.kind == "f":
            return value.astype(np.float64).astype(np.int64).astype(np.uint32)
        return self.fit(type_, value)


def _each(change: Callable[[Any], Any], value: Array) -> Array:
    """A function of Python's numbers on every lane."""
    found: Array = np.frompyfunc(change, 1, 1)(value)
    return found


def _looked_up(lookup: Callable[..., Array], texture: Value, *place: Value) -> Array:
    """A lookup in a map at (u, v), and at a level if there is one: it takes its lanes in one row."""
    uv, *level = cast(list[Array], place)
    shape = np.broadcast_shapes(uv.shape[:-1], *(a.shape for a in level))
    flat = [np.broadcast_to(a, shape).reshape(-1) for a in level]
    found = lookup(texture, np.broadcast_to(uv, (*shape, 2)).reshape(-1, 2), *flat)
    return found.reshape(*shape, found.shape[-1])


_EVALUATE: dict[type, Callable[[Frame, Any], Value]] = {
    ir.Const: Frame.constant,
    ir.Var: Frame.variable,
    ir.Unary: Frame.unary,
    ir.Binary: Frame.binary,
    ir.Builtin: Frame.builtin,
    ir.Call: Frame.made_or_called,
    ir.Construct: Frame.construct,
    ir.Convert: Frame.convert,
    ir.Member: Frame.member,
    ir.Index: Frame.index,
    ir.Swizzle: Frame.swizzle,
    ir.Select: Frame.select,
}
