"""What belongs together in a measurement, and the inputs that all of it gets."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.evaluate.arrays import arithmetic, convert_inputs
from codegen.execute import Words, flatten
from codegen.ir.domains import Domain, Interval, Length
from codegen.ir.nodes import Function, Parameter
from codegen.ir.types import Struct, Vector
from codegen.library import Library
from conformance import cases
from conformance.bench.normal import normal_lanes
from conformance.check.measure import fields, finite

SEED = 20_261
LARGEST = 1e30
"""Inputs whose result is larger are left out: eps times a sum of them must stay 0, not become NaN."""
_LENGTH = re.compile(r"length\(([\w.]+)\)")


@dataclass(frozen=True)
class Group:
    """A function with its variants and printed forms."""

    base: Function
    variants: tuple[Function, ...]

    @property
    def members(self) -> tuple[Function, ...]:
        """All of them, the base first."""
        return (self.base, *self.variants)


def groups(library: Library, names: Iterable[str] = ()) -> list[Group]:
    """The groups of these functions, in the order named; every group that has variants if none is named.

    raises  UserError for a function that reads maps
    """
    wanted = [library.function(name) for name in names] or [f for f in library.public.values() if f.base]
    for f in wanted:
        if f.reads_textures:
            raise UserError(f"{f.name} reads maps, which no measurement of speed draws")
    roots = {root.name: root for root in (_root(library, f) for f in wanted)}
    return [Group(root, tuple(_descendants(library, root))) for root in roots.values()]


def _root(library: Library, f: Function) -> Function:
    return f if f.base is None else _root(library, library.function(f.base))


def _descendants(library: Library, f: Function) -> Iterator[Function]:
    """Variants, each followed by its own variants."""
    for variant in library.variants(f.name):
        yield variant
        yield from _descendants(library, variant)


def common(group: Group) -> Function:
    """The base with its parameters' domains cut down to what the signatures of all members accept."""
    columns = zip(*(f.parameters for f in group.members), strict=True)
    return replace(group.base, parameters=tuple(_narrowest(column) for column in columns))


def _narrowest(column: tuple[Parameter, ...]) -> Parameter:
    domain = column[0].domain
    for p in column[1:]:
        if isinstance(p.domain, Interval | Length):
            domain = _cut(domain, p.domain.low, p.domain.high)
    return replace(column[0], domain=domain)


def _cut(domain: Domain | None, low: float, high: float) -> Domain | None:
    """The part of an interval, or of the lengths, within other ends."""
    if isinstance(domain, Interval | Length):
        return replace(domain, low=max(domain.low, low), high=min(domain.high, high))
    return domain


def within(function: Function, bounds: Iterable[Bound]) -> tuple[Function, Bound | None]:
    """The function with its domains cut down to the first bound that leaves more than a point of each.

    Features that relate two parameters (angles, products) leave the domains alone.
    returns  the function itself and None where no bound does
    """
    for bound in bounds:
        inside = replace(function, parameters=tuple(_inside(p, bound) for p in function.parameters))
        if all(_has_width(p.domain, p.type) for p in inside.parameters):
            return inside, bound
    return function, None


def _inside(p: Parameter, bound: Bound) -> Parameter:
    if isinstance(p.type, Struct):
        parts = tuple(
            replace(f, domain=_by_features(f"{p.name}.{f.name}", f.domain, f.type, bound))
            for f in p.type.fields
        )
        return replace(p, type=replace(p.type, fields=parts))
    return replace(p, domain=_by_features(p.name, p.domain, p.type, bound))


def _by_features(path: str, domain: Domain | None, type_: Any, bound: Bound) -> Domain | None:
    for feature, (low, high) in bound.where.items():
        length = _LENGTH.fullmatch(feature)
        is_length = length is not None and length.group(1) == path
        if feature == path or (is_length and isinstance(domain, Length)):
            domain = _cut(domain, low, high)
        elif is_length and isinstance(type_, Vector):
            # Any point of a cube with this half edge is short enough.
            domain = _cut(domain, -high, high / type_.size**0.5)
    return domain


def _has_width(domain: Domain | None, type_: Any) -> bool:
    if isinstance(type_, Struct):
        return all(_has_width(f.domain, f.type) for f in type_.fields)
    return not isinstance(domain, Interval | Length) or domain.low < domain.high


def declared(library: Library, group: Group) -> tuple[Function, Bound | None]:
    """The base, its domains cut down to where every member declares a bound; and the base's bound there.

    A member's widest bound counts, so that this cuts no more than it must.
    """
    function, bound = within(common(group), library.bounds.get(group.base.name, ()))
    for f in group.variants:
        cuts = [within(function, [b])[0] for b in library.bounds.get(f.name, ()) if within(function, [b])[1]]
        if cuts and all(domains(cut) != domains(function) for cut in cuts):
            function = cuts[0]
    return function, bound


def domains(function: Function) -> dict[str, Domain | None]:
    """The domain of every parameter and field, by path."""
    found: dict[str, Domain | None] = {}
    for p in function.parameters:
        if isinstance(p.type, Struct):
            found |= {f"{p.name}.{f.name}": f.domain for f in p.type.fields}
        else:
            found[p.name] = p.domain
    return found


def lanes(library: Library, group: Group, count: int) -> Words:
    """Words of inputs, uniform over what all members are declared for, on which every one is finite.

    Where any is left, only inputs count at which no member computes a number below 2^-126: these take a CPU a
    hundred times as long as others.

    returns  (slots, count); points repeat where few are fit
    """
    drawn = cases.draw(declared(library, group)[0], cases.UNIFORM, 2 * count, SEED)
    good, normal = np.ones(2 * count, np.bool_), np.ones(2 * count, np.bool_)
    for f in group.members:
        given = by_position(f, drawn)
        value = evaluate(library, f.name, given)
        good &= finite(value) & _moderate(value)
        normal &= normal_lanes(library, f.name, given)
    rows = np.flatnonzero(good & normal)
    if not len(rows):
        rows = np.flatnonzero(good)
    if not len(rows):
        raise ValueError(f"{group.base.name}: no input of the common domain gives finite results")
    types = {p.name: p.type for p in group.base.parameters}
    arrays, n = convert_inputs(types, drawn, arithmetic("float32"), group.base.name)
    return np.ascontiguousarray(flatten(list(arrays.values()), n)[:, np.resize(rows, count)])


def by_position(function: Function, inputs: dict[str, Any]) -> dict[str, Any]:
    """The base's inputs under the names that a member gives its parameters."""
    return dict(zip((p.name for p in function.parameters), inputs.values(), strict=True))


def _moderate(value: Any) -> npt.NDArray[np.bool_]:
    masks = []
    for _, a in fields(value):
        small = np.abs(a) <= LARGEST if a.dtype.kind == "f" else np.ones(a.shape, np.bool_)
        masks.append(small.all(axis=-1) if small.ndim == 2 else small)
    return np.asarray(np.logical_and.reduce(masks), np.bool_)
