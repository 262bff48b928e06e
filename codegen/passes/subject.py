"""What a function is specialised to: constants, aliases, ranges and facts, checked against its signature.

Parameters are named by paths: "optics.rho_surface", "n". Every mistake is one sentence that names the path
and the nearest valid one.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from codegen.errors import UserError, unknown
from codegen.ir import nodes as ir
from codegen.ir.domains import Domain, Finite, Interval, Length, Unit, number
from codegen.ir.types import BOOL, F32, Array, Scalar, Struct, Texture, Type, Vector
from codegen.passes.ssa import patterns
from codegen.passes.ssa.values import PARAMETER, Value, Values, any_element

TOLERANCE = 1e-6
"""How far a constant's length may be from what its domain says."""


@dataclass(frozen=True)
class Fact:
    """What is known of an expression over parameters: Fact("dot(n, v)", 0.05, 1.0)."""

    expression: str
    low: float = -math.inf
    high: float = math.inf


@dataclass
class Subject:
    """A function with what is known of its parameters."""

    function: ir.Function
    constants: Mapping[str, Any] = field(default_factory=dict)
    aliases: Mapping[str, str] = field(default_factory=dict)
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.types: dict[str, Type] = {}
        self.domains: dict[str, Domain | None] = {}
        for p in self.function.parameters:
            self._enter(p.name, p.type, p.domain)
        for what in (self.constants, self.aliases, self.ranges):
            for path in what:
                self._known(path)
        for path, target in self.aliases.items():
            self._check_alias(path, target)
        for path in self.ranges:
            self.domains[path] = self._narrowed(path, self.ranges[path])
        for path, target in self.aliases.items():
            self._share_domain(path, target)

    def _enter(self, path: str, type_: Type, domain: Domain | None) -> None:
        self.types[path], self.domains[path] = type_, domain
        if is_taken_apart(type_):
            assert isinstance(type_, Struct)
            for f in type_.fields:
                self._enter(f"{path}.{f.name}", f.type, f.domain)

    def _known(self, path: str) -> Type:
        if path not in self.types:
            raise unknown(f"parameter of {self.function.name}", path, self.types)
        return self.types[path]

    def _check_alias(self, path: str, target: str) -> None:
        if self._known(path) != self._known(target):
            names = self.types[path].name, self.types[target].name
            raise UserError(
                f'{self.function.name}: "{path}" is a {names[0]} and cannot be "{target}", a {names[1]}'
            )
        if path in self.constants:
            raise UserError(f'{self.function.name}: "{path}" is given as a constant and as "{target}"')
        if path == target:
            raise UserError(f'{self.function.name}: "{path}" cannot be given as equal to itself')
        if target in self.aliases:
            last = self.aliases[target]
            raise UserError(f'{self.function.name}: "{path}" is "{target}", which is "{last}": name that one')

    def _share_domain(self, path: str, target: str) -> None:
        """A parameter that stands for another one lies in both domains."""
        a, b = self.domains[path], self.domains[target]
        if isinstance(a, Interval) and isinstance(b, Interval):
            if a.low > b.high or b.low > a.high:
                raise UserError(
                    f'{self.function.name}: "{path}" ({a.describe()}) cannot be "{target}" ({b.describe()})'
                )
            self.domains[target] = replace(b, low=max(a.low, b.low), high=min(a.high, b.high))
        elif isinstance(a, Unit) or (isinstance(b, Finite) and a is not None):
            self.domains[target] = a

    def _narrowed(self, path: str, ends: tuple[float, float]) -> Domain:
        where, type_, domain = f"{self.function.name}: {path}", self.types[path], self.domains[path]
        if path in self.constants or path in self.aliases:
            raise UserError(f"{where} has a range although it is not a parameter any more")
        low, high = map(float, ends)
        if is_taken_apart(type_) or isinstance(domain, Unit | Length) or type_ == BOOL:
            raise UserError(f"{where} is a {type_.name} and has no range")
        if not (math.isfinite(low) and math.isfinite(high)):
            raise UserError(f"{where}: a range has finite ends")
        if low > high:
            raise UserError(f"{where}: the range starts at {number(low)} and ends below, at {number(high)}")
        if isinstance(domain, Interval):
            if low < domain.low or high > domain.high:
                shown = f"[{number(low)}, {number(high)}]"
                raise UserError(f"{where}: the range {shown} leaves the domain, {domain.describe()}")
            return replace(domain, low=low, high=high, least=min(max(domain.least, low), high))
        return Interval(low, high)

    def arguments(self, values: Values) -> dict[str, Value]:
        """The arguments to follow the function with: leaves for what varies, by their paths."""
        parameters = {
            path: ir.Parameter(path, type_, self.domains[path])
            for path, type_ in self.types.items()
            if not is_taken_apart(type_)
        }
        values.parameters = parameters
        return {p.name: self._argument(values, p.name, p.type) for p in self.function.parameters}

    def _argument(self, values: Values, path: str, type_: Type) -> Value:
        if path in self.constants:
            made = self._constant(values, path, type_, self.constants[path])
            values.note("substitute", f"{path} = {_shown(self.constants[path])}", "given as a constant")
            return made
        if path in self.aliases:
            target = self.aliases[path]
            values.note("substitute", f"{path} = {target}", "given as equal")
            return self._argument(values, target, self.types[target])
        if is_taken_apart(type_):
            assert isinstance(type_, Struct)
            return {f.name: self._argument(values, f"{path}.{f.name}", f.type) for f in type_.fields}
        return values.intern(ir.Var(type_, path))

    def _constant(self, values: Values, path: str, type_: Type, given: Any) -> Value:
        where = f"{self.function.name}: {path}"
        if isinstance(type_, Array):
            return self._constant_array(values, where, path, type_, given)
        if isinstance(type_, Struct):
            names = [f.name for f in type_.fields]
            if not isinstance(given, Mapping):
                raise UserError(f"{where} is a {type_.name}: give its fields")
            for name in given:
                if name not in names:
                    raise unknown(f"field of {path}", name, names)
            missing = [name for name in names if name not in given]
            if missing:
                raise UserError(f"{where} lacks {', '.join(missing)}")
            return {
                f.name: self._constant(values, f"{path}.{f.name}", f.type, given[f.name])
                for f in type_.fields
            }
        if isinstance(type_, Texture):
            raise UserError(f"{where} is a map, which no constant can be")
        numbers = _numbers(where, type_, given)
        self._check_domain(where, self.domains[path], numbers)
        return _constant_of(values, type_, numbers)

    def _constant_array(self, values: Values, where: str, path: str, type_: Array, given: Any) -> Value:
        rows = list(given.values()) if isinstance(given, Mapping) else given
        if not isinstance(rows, Sequence | np.ndarray) or len(rows) != type_.size:
            raise UserError(f"{where} needs {type_.size} elements")
        parts: list[ir.Expr] = []
        for k, row in enumerate(rows):
            numbers = _numbers(f"{where}[{k}]", type_.element, row)
            self._check_domain(f"{where}[{k}]", self.domains[path], numbers)
            parts.append(_constant_of(values, type_.element, numbers))
        made = values.build(ir.Construct(type_, tuple(parts)))
        values.hint(made, path.rpartition(".")[2], PARAMETER)
        return made

    @staticmethod
    def _check_domain(where: str, domain: Domain | None, numbers: Sequence[float | int | bool]) -> None:
        length = math.hypot(*map(float, numbers))
        match domain:
            case Interval(low=low, high=high):
                slack = TOLERANCE * max(-low, high)
                inside = all(low - slack <= x <= high + slack for x in numbers)
            case Unit():
                inside = abs(length - 1.0) <= TOLERANCE
            case Length(low=low, high=high):
                inside = length == 0.0 or low * (1.0 - TOLERANCE) <= length <= high * (1.0 + TOLERANCE)
            case _:
                inside = True
        if not inside:
            assert domain is not None
            article = "no" if isinstance(domain, Unit) else "not"
            raise UserError(f"{where} is {_shown(list(numbers))}, which is {article} {domain.describe()}")

    def fact(self, values: Values, fact: Fact) -> tuple[ir.Expr, float, float]:
        """A fact as a value with its ends."""
        where = f'{self.function.name}: fact "{fact.expression}"'
        if fact.low > fact.high:
            ends = number(fact.low), number(fact.high)
            raise UserError(f"{where}: nothing is at least {ends[0]} and at most {ends[1]}")
        try:
            pattern = patterns.parse(fact.expression)
            found: dict[str, ir.Expr] = {}
            for path in sorted(patterns.names(pattern)):
                if path not in self.types:
                    raise unknown(f"parameter in {where}", path, self.types)
                value = self._argument(values, path, self.types[path])
                if isinstance(value, dict):
                    raise UserError(f"{where}: {path} is a {self.types[path].name}")
                found[path] = any_element(values, value) if isinstance(value.type, Array) else value
            return patterns.make(pattern, found, values, F32), fact.low, fact.high
        except (SyntaxError, ValueError, KeyError):
            raise UserError(f"{where} is no expression of built-ins and parameters") from None


def is_taken_apart(type_: Type) -> bool:
    """Whether parameters of a type are known field by field: structs are, arrays stay whole."""
    return isinstance(type_, Struct) and not isinstance(type_, Array)


def _constant_of(values: Values, type_: Scalar | Vector, numbers: Sequence[float | int | bool]) -> ir.Expr:
    if isinstance(type_, Vector):
        parts = tuple(values.build(ir.Const(type_.element, n)) for n in numbers)
        return values.build(ir.Construct(type_, parts))
    return values.build(ir.Const(type_, numbers[0]))


def _numbers(where: str, type_: Scalar | Vector, given: Any) -> list[float | int | bool]:
    element = type_.element if isinstance(type_, Vector) else type_
    size = type_.size if isinstance(type_, Vector) else 1
    try:
        a = np.asarray(given)
        flat = a.ravel().tolist()
    except ValueError:
        raise UserError(f"{where}: {given!r} is no {type_.name}") from None
    if len(flat) != size or a.ndim > 1 or any(isinstance(x, str | bytes | None | dict) for x in flat):
        raise UserError(f"{where}: {given!r} is no {type_.name}")
    if element == F32:
        with np.errstate(over="ignore"):
            found = [float(np.float32(x)) for x in flat]
        if not all(map(math.isfinite, found)):
            raise UserError(f"{where}: {given!r} is no finite float32")
        return [x + 0.0 for x in found]
    if element == BOOL:
        if not all(isinstance(x, bool) for x in flat):
            raise UserError(f"{where}: {given!r} is no truth value")
        return list(flat)
    low, high = (0, 2**32 - 1) if element.name == "u32" else (-(2**31), 2**31 - 1)
    if not all(isinstance(x, int) and not isinstance(x, bool) and low <= x <= high for x in flat):
        raise UserError(f"{where}: {given!r} is no {element.name}")
    return list(flat)


def _shown(given: Any) -> str:
    if isinstance(given, Mapping):
        return "{" + ", ".join(f"{k} = {_shown(v)}" for k, v in given.items()) + "}"
    flat = np.asarray(given).ravel().tolist()
    texts = [str(x).lower() if isinstance(x, bool) else number(float(x)) for x in flat]
    return texts[0] if len(texts) == 1 else f"({', '.join(texts)})"
