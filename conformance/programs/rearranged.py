"""Sums and products with their constant moved inwards, as compilers do it.

Mesa 22.3.6 turns (a + b) + c with a constant c into (a + c) + b, and the same for products; it does so across
locals, choices and the turns of a loop (conformance.programs.chains), reorders sums, takes out factors that
their terms share (conformance.programs.gathered), and factors or distributes interpolations for some drivers
(conformance.programs.interpolated). WGSL (Reassociation and Fusion: any reordering whose answer is the same
if computed exactly), Vulkan (distributivity included) and GLSL without `precise` allow rearrangement; the
accuracy tables judge expressions as written. A result that only this explains is counted as rearranged, and
is no failure.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from codegen.evaluate.arrays import Array, Value
from codegen.intervals import DEFAULT_TABLES, Permitted, Table, load_table, permitted
from codegen.intervals.accuracy import Inherited
from codegen.ir import nodes as ir
from codegen.ir.types import Vector
from codegen.library import Library
from conformance.programs.chains import beyond_choices, chained, straightened
from conformance.programs.gathered import gathered, reordered
from conformance.programs.interpolated import interpolated, weighted

REARRANGING = frozenset({"glsl", "glsl_es", "vulkan", "wgsl", "opencl_relaxed"})
"""Accuracy tables of specifications that allow it."""
ANY_ORDER = Inherited("sum of products, in any order")
"""What a table says of `dot` where sums in any order can be written as one."""
_CHAINS = {"+": ("+", "-"), "-": ("+", "-"), "*": ("*",)}


def explained(
    library: Library, name: str, inputs: Mapping[str, Any], target: str, value: Value, table: str = ""
) -> Array:
    """Mask of the lanes whose value lies, component by component, in the interval of a rearranged function.

    table  the accuracy table; that of the target's default dialect if empty; no device rearranges nothing
    """
    chosen = table or DEFAULT_TABLES.get(target, "")
    if chosen not in REARRANGING:
        return np.zeros(1, np.bool_)
    found = _components_inside(permitted(library, name, inputs, chosen), value)
    for extended, arguments in _forms(library, name, inputs, load_table(chosen)):
        if found.all():
            break
        found |= _components_inside(permitted(extended, name, arguments, chosen), value)
    return np.asarray(found.all(axis=1))


def _forms(
    library: Library, name: str, inputs: Mapping[str, Any], table: Table
) -> Iterator[tuple[Library, Any]]:
    """Every rearranged form of a function with its arguments, the ones that cost least first."""
    selected = library.select([name]).functions
    for change in (_moved(_inwards), _moved(_outwards), interpolated, weighted):
        yield library.with_functions(map(change, selected)), inputs
    in_any_order = table.row("dot").accuracy == ANY_ORDER
    if in_any_order:
        yield library.with_functions(map(reordered, selected)), inputs
    straight = straightened(library, name)
    arguments = straight.arguments(inputs) if straight.parameters else {}
    for first in (False, True):
        yield library.with_functions([chained(straight.function, first)]), arguments
    yield library.with_functions([chained(beyond_choices(straight.function), True)]), arguments
    if in_any_order:
        for made in gathered(straight.function):
            yield library.with_functions([made]), arguments
            yield library.with_functions([chained(made, True)]), arguments


def _components_inside(allowed: Permitted, value: Value) -> Array:
    """(N, components): which components lie inside; each may have been rearranged in a way of its own."""
    columns = zip(*map(_columns, (allowed.low, allowed.high, value)), strict=True)
    inside = [(x >= low) & (x <= high) for low, high, x in columns]
    return np.stack(inside, axis=1) | (allowed.codes > 0)[:, None]


def _columns(value: Value) -> Iterator[Array]:
    if isinstance(value, dict):
        for part in value.values():
            yield from _columns(part)
    elif value.ndim == 2:
        yield from (value[:, k] for k in range(value.shape[1]))
    else:
        yield value


def _moved(change: Callable[[ir.Expr], ir.Expr]) -> Callable[[ir.Function], ir.Function]:
    return lambda function: replace(function, body=ir.map_body(function.body, change))


def _inwards(e: ir.Expr) -> ir.Expr:
    """(a + b) + c becomes (a + c) + b for a constant c."""
    if not (isinstance(e, ir.Binary) and e.op in _CHAINS and isinstance(e.left, ir.Binary)):
        return e
    inner = e.left
    same = inner.op in _CHAINS[e.op] and inner.type == e.type == inner.left.type == e.right.type
    if not same or not _is_constant(e.right) or _is_constant(inner.right):
        return e
    return replace(inner, left=ir.Binary(e.type, e.op, inner.left, e.right))


def _outwards(e: ir.Expr) -> ir.Expr:
    """a + (b + c) becomes (a + b) + c for a constant c: relaxed OpenCL."""
    if not (isinstance(e, ir.Binary) and e.op in ("+", "*") and isinstance(e.right, ir.Binary)):
        return e
    inner = e.right
    same = inner.op in _CHAINS[e.op] and inner.type == e.type == inner.left.type == e.left.type
    if not same or not _is_constant(inner.right) or _is_constant(e.left):
        return e
    return replace(inner, left=ir.Binary(e.type, e.op, e.left, inner.left))


def _is_constant(e: ir.Expr) -> bool:
    if isinstance(e, ir.Construct) and isinstance(e.type, Vector):
        return all(map(_is_constant, e.args))
    return isinstance(e, ir.Const)
