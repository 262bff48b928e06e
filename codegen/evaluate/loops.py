"""Loops whose iterations hardly depend on each other, evaluated all at once: lanes times iterations.

before   for i in range(8): a = f(x, p[i]); total = total + g(a)
after    a = f(x, p) and part = g(a) over arrays of eight rows; then total = total + part, row by row

Every operation is the same on every lane, so values are the same to the bit. What an interpreter spends on
each operation is spent once, not once an iteration; what all iterations share has no rows, and is computed
once.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import cast

import numpy as np

from codegen.evaluate.arrays import Array, Value
from codegen.evaluate.textures import as_map
from codegen.evaluate.vectors import stacked
from codegen.ir import nodes as ir
from codegen.ir.content import variables, zeros
from codegen.ir.types import Struct, Type, Vector


@dataclass(frozen=True)
class Together:
    """A loop taken apart.

    lets      what all iterations compute at once
    ends      what one iteration hands to the next, over names of `lets`
    elements  name -> array of which it is the element that the iteration names
    outer     names that `lets` take from around the loop
    inner     names of `lets` that `ends` use, with their types
    """

    lets: tuple[ir.Let, ...]
    ends: tuple[ir.Assign, ...]
    elements: Mapping[str, str]
    outer: tuple[str, ...]
    inner: Mapping[str, Type]


def together(s: ir.For) -> Together | None:
    """The loop taken apart; None where it branches, ends early, or defines something by what it hands on."""
    return _together(s, zeros(ir.expressions(s.body)))


@functools.lru_cache(512)
def _together(s: ir.For, signs: tuple[bool, ...]) -> Together | None:
    if s.limit is not None or s.stop - s.start < 2:
        return None
    body = [x for x in s.body if isinstance(x, ir.Let | ir.Assign)]
    if len(body) < len(s.body):
        return None
    assigned = {x.name for x in body if isinstance(x, ir.Assign)}
    own = {x.name for x in body if isinstance(x, ir.Let)}
    if assigned & own or s.name in assigned:
        return None
    lets: list[ir.Let] = []
    ends: list[ir.Assign] = []
    elements: dict[str, str] = {}
    inside = frozenset(own | assigned)

    def part(e: ir.Expr) -> ir.Expr:
        """The expression over parts that no iteration before tells."""
        if isinstance(e, ir.Const) or (isinstance(e, ir.Var) and e.name in assigned):
            return e
        if assigned.isdisjoint(_names(e)):
            name = f"part {len(lets)}"
            lets.append(ir.Let(name, e))
            return ir.Var(e.type, name)
        return ir.rebuild(e, tuple(map(part, ir.children(e))))

    for x in body:
        value, named = _over_elements(x.value, zeros(ir.walk(x.value)), s.name, inside)
        elements |= named
        if isinstance(x, ir.Let):
            if not assigned.isdisjoint(_names(value)):
                return None
            lets.append(ir.Let(x.name, value))
        else:
            ends.append(ir.Assign(x.name, part(value)))
    made = {x.name for x in lets} | set(elements)
    needed = {name for x in lets for name in _names(x.value)}
    used = {v.name: v.type for x in ends for v in ir.walk(x.value) if isinstance(v, ir.Var)}
    return Together(
        tuple(lets),
        tuple(ends),
        elements,
        tuple(sorted(needed - made - {s.name})),
        {name: used[name] for name in sorted(used) if name in made},
    )


@functools.lru_cache(4096)
def _over_elements(
    e: ir.Expr, signs: tuple[bool, ...], index: str, inside: frozenset[str]
) -> tuple[ir.Expr, dict[str, str]]:
    """An expression with elements of arrays around the loop, where the iteration names them, by names of
    their own; and those names with their arrays. Loops that share statements share what becomes of them.

    signs   of its zeros
    inside  names that the loop gives values to
    """
    elements: dict[str, str] = {}

    def element(x: ir.Expr) -> ir.Expr:
        match x:
            case ir.Index(value=ir.Var(name=array), index=ir.Var(name=number)):
                if number == index and array not in inside:
                    elements[f"{array}[{index}]"] = array
                    return ir.Var(x.type, f"{array}[{index}]")
        return x

    return ir.map_expr(e, element), elements


@functools.lru_cache(4096)
def _names(e: ir.Expr) -> frozenset[str]:
    return frozenset(variables(e))


def rows(values: list[Value]) -> Value:
    """The values of the iterations as rows of one; a map stays what it is."""
    first = values[0]
    if as_map(first) is not None:
        return first
    if isinstance(first, dict):
        return {n: rows([cast(dict[str, Value], v)[n] for v in values]) for n in first}
    assert isinstance(first, np.ndarray)
    arrays = cast(list[Array], values)
    if first.ndim == 1:
        return np.stack(np.broadcast_arrays(*arrays))
    return stacked([np.stack(np.broadcast_arrays(*[a[:, k] for a in arrays])) for k in range(first.shape[1])])


def row(value: Value, number: int, type_: Type) -> Value:
    """The value of one iteration; that of all of them where they share it."""
    if as_map(value) is not None:
        return value
    if isinstance(value, dict):
        assert isinstance(type_, Struct)
        return {f.name: row(value[f.name], number, f.type) for f in type_.fields}
    if value.ndim == 1 + isinstance(type_, Vector):
        return value
    found: Array = value[number if len(value) > 1 else 0]
    return found


def joined(values: list[Value]) -> Value:
    """The lanes of several values, one after the other; a map stays what it is."""
    first = values[0]
    if as_map(first) is not None:
        return first
    if isinstance(first, dict):
        return {n: joined([cast(dict[str, Value], v)[n] for v in values]) for n in first}
    return np.concatenate(cast(list[Array], values))


def lanes(value: Value, first: int, last: int) -> Value:
    """Some lanes of a value; the one that stands for all stays."""
    if as_map(value) is not None:
        return value
    if isinstance(value, dict):
        return {n: lanes(v, first, last) for n, v in value.items()}
    return value if len(value) == 1 else value[first:last]
