"""Values as arrays: scalars (N,), vectors (N, size), structs as dicts; and the arithmetics over them.

What is the same in all lanes may have one lane. In loops that are evaluated all at once, iterations come
before lanes: (iterations, N), (iterations, N, size); what is the same in all iterations has lanes alone.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError, check_names, unknown
from codegen.evaluate.textures import as_map, lookup_in, size_in, texture_map
from codegen.evaluate.vectors import stacked
from codegen.ir.types import (
    BOOL,
    F16,
    F32,
    HALF_TYPES,
    I32,
    TEXTURE,
    U32,
    VALUE_TYPES,
    Scalar,
    Struct,
    Type,
    Vector,
)
from codegen.ir.types import Array as ArrayType

Array = npt.NDArray[Any]
Value = Array | dict[str, "Value"]

INTEGER_TYPES: dict[Type, type[np.generic]] = {I32: np.int32, U32: np.uint32, BOOL: np.bool_}


@dataclass(frozen=True)
class Arithmetic:
    """How floats are held and which functions work on them (`m` in the op registry's meanings)."""

    name: str
    floats: type[np.generic]
    namespace: Any
    literal: Callable[[float], Any]
    strict: bool = False
    """Whether a half that would be denormal is 0 and one that overflows is NaN: what a device may do."""

    @property
    def is_half(self) -> bool:
        """Whether the half form of a function is evaluated: f16 rounded to half, f32 to float32."""
        return self.name.startswith("float16")

    @functools.cached_property
    def dtypes(self) -> Mapping[str, type[np.generic]]:
        """How each scalar type is held, and the elements of each vector type, by its name."""
        half = np.float16 if self.is_half else self.floats
        scalars = {F16.name: half, F32.name: self.floats, **{t.name: d for t, d in INTEGER_TYPES.items()}}
        every = (*VALUE_TYPES.values(), *HALF_TYPES.values())
        return scalars | {t.name: scalars[t.element.name] for t in every if isinstance(t, Vector)}

    def dtype(self, element: Scalar) -> type[np.generic]:
        return self.dtypes[element.name]


def _float_to_bits(x: Array) -> Array:
    return np.asarray(x, np.float32).view(np.uint32)


def _bits_to_float(x: Array) -> Array:
    return np.asarray(x, np.uint32).view(np.float32)


def _numpy_namespace(floats: type[np.generic]) -> SimpleNamespace:
    def to_float(x: Array) -> Array:
        return _bits_to_float(x).astype(floats)

    names = "abs minimum maximum divide floor sqrt exp exp2 log log2 sin cos arctan2"
    logic = "logical_and logical_or logical_not"
    functions = {name: getattr(np, name) for name in f"{names} {logic}".split()}
    return SimpleNamespace(
        **functions,
        stack=stacked,
        float_to_bits=_float_to_bits,
        bits_to_float=to_float,
        lookup_level=lookup_in(floats, np.floor),
        texture_size=size_in(floats),
    )


ARITHMETICS = ("float32", "float64", "mpmath")
HALF_ARITHMETICS = ("float16", "float16-strict")
"""Of half forms: as IEEE 754 has it, and with all that a device may do about tiny and huge results."""


@functools.cache
def arithmetic(name: str) -> Arithmetic:
    """An arithmetic by name; raises UserError for an unknown one. mpmath is imported only when asked for."""
    if name not in (*ARITHMETICS, *HALF_ARITHMETICS):
        raise unknown("arithmetic", name, (*ARITHMETICS, *HALF_ARITHMETICS))
    if name == "mpmath":
        import mpmath

        from codegen.evaluate.precise import namespace

        return Arithmetic(name, np.object_, namespace(), mpmath.mpf)
    floats = np.float64 if name == "float64" else np.float32
    return Arithmetic(name, floats, _numpy_namespace(floats), floats, strict=name == "float16-strict")


def convert_inputs(
    parameters: Mapping[str, Type],
    inputs: Mapping[str, Any],
    arithmetic: Arithmetic,
    function: str,
    *,
    repeated: bool = True,
) -> tuple[dict[str, Value], int]:
    """Inputs as arrays of the arithmetic, and their common length N.

    repeated  whether single values are repeated for all lanes
    raises    UserError for missing or unknown names and for shapes that do not fit
    """
    check_names(inputs, parameters, parameters, f"{function} has no parameter", f"{function} needs")
    arrays = {n: _convert(f"{function}: {n}", t, inputs[n], arithmetic) for n, t in parameters.items()}
    lengths = {len(a) for value in arrays.values() for a in _leaf_arrays(value)}
    counts = lengths - {1}
    if len(counts) > 1:
        raise UserError(f"{function}: inputs have different lengths: {sorted(lengths)}")
    count = counts.pop() if counts else 1
    return {n: broadcast(value, count) for n, value in arrays.items()} if repeated else arrays, count


def _convert(where: str, type_: Type, given: Any, arithmetic: Arithmetic) -> Value:
    if isinstance(type_, ArrayType) and not isinstance(given, Mapping):
        given = _elements(where, type_, given)
    if type_ == TEXTURE:
        return cast(Value, texture_map(where, given))
    if isinstance(type_, Struct):
        if not isinstance(given, Mapping):
            raise UserError(f"{where} is a {type_.name}: give its fields")
        fields = {f.name: f.type for f in type_.fields}
        check_names(given, fields, fields, f"{where} has no field", f"{where} lacks")
        return {n: _convert(f"{where}.{n}", t, given[n], arithmetic) for n, t in fields.items()}
    element = type_.element if isinstance(type_, Vector) else type_
    assert isinstance(element, Scalar)
    a = _numbers(where, element, given)
    if arithmetic.floats is np.object_ and element in (F16, F32):
        a = np.frompyfunc(arithmetic.literal, 1, 1)(a.astype(np.float64) if a.dtype != object else a)
        a = np.asarray(a, dtype=object)
    else:
        with np.errstate(over="ignore"):  # a number beyond the largest half becomes infinite
            a = a.astype(arithmetic.dtype(element), order="F")  # as `stacked` has vectors
    shape: tuple[int, ...] = (type_.size,) if isinstance(type_, Vector) else ()
    if a.shape == shape:
        a = a[None]
    if a.ndim != 1 + len(shape) or a.shape[1:] != shape:
        expected = "(N,)" if not shape else f"(N, {shape[0]})"
        raise UserError(f"{where} has shape {a.shape}, but {type_.name} needs {expected}")
    return a


def _elements(where: str, type_: ArrayType, given: Any) -> dict[str, Any]:
    """An array (N, size) or (N, size, k), or one for all lanes without the N, by the elements' numbers."""
    a = np.asarray(given)
    shape = (type_.size, *((type_.element.size,) if isinstance(type_.element, Vector) else ()))
    if a.shape == shape:
        a = a[None]
    if a.shape[1:] != shape:
        raise UserError(
            f"{where} has shape {a.shape}, but {type_.name} needs (N, {', '.join(map(str, shape))})"
        )
    return {f.name: a[:, k] for k, f in enumerate(type_.fields)}


def _numbers(where: str, element: Scalar, given: Any) -> Array:
    """The given value as an array of numbers that the element type can hold."""
    try:
        a = np.asarray(given)
    except ValueError:
        raise UserError(f"{where} is not an array: its rows differ in length") from None
    allowed = {F16: "fiubO", F32: "fiubO", BOOL: "bO"}.get(element, "iubO")
    if a.size and a.dtype.kind not in allowed:
        raise UserError(f"{where} holds {a.dtype.name}, but {element.name} is needed")
    if element in (I32, U32) and a.size:
        low, high = (0, 2**32 - 1) if element == U32 else (-(2**31), 2**31 - 1)
        if a.min() < low or a.max() > high:
            raise UserError(f"{where} holds a number outside [{low}, {high}]")
    return a


def _leaf_arrays(value: Value) -> list[Array]:
    if as_map(value) is not None:
        return []
    if isinstance(value, dict):
        return [a for v in value.values() for a in _leaf_arrays(v)]
    return [value]


def broadcast(value: Value, count: int) -> Value:
    """The value with `count` lanes, repeated from one lane where needed."""
    if as_map(value) is not None:
        return value
    if isinstance(value, dict):
        return {n: broadcast(v, count) for n, v in value.items()}
    return np.broadcast_to(value, (count, *value.shape[1:]))


def row_by_row(value: Value) -> Value:
    """The value with vectors one after the other in memory, as callers expect what they sum or write."""
    if isinstance(value, dict):
        return {n: row_by_row(v) for n, v in value.items()}
    return np.ascontiguousarray(value)


def choose(condition: Array, if_true: Value, if_false: Value, type_: Type) -> Value:
    """Lane by lane choice between two values of one type."""
    if isinstance(if_true, dict):
        assert isinstance(if_false, dict)
        assert isinstance(type_, Struct)
        return {f.name: choose(condition, if_true[f.name], if_false[f.name], f.type) for f in type_.fields}
    assert isinstance(if_true, np.ndarray)
    assert isinstance(if_false, np.ndarray)
    wide = condition[..., None] if isinstance(type_, Vector) else condition
    return np.where(wide, if_true, if_false)
