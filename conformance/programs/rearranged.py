"""Sums and products with their constant moved inwards, as compilers do it.

Mesa 22.3.6 turns (a + b) + c with a constant c into (a + c) + b, and the same for products; it does so across
locals and the turns of a loop (conformance.programs.chains), and factors interpolations for some drivers
(conformance.programs.interpolated). WGSL, Vulkan and GLSL without `precise` allow
rearrangement; the accuracy tables judge expressions as written. A result that only this explains is counted
as rearranged, and is no failure.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from codegen.evaluate.arrays import Array, Value
from codegen.intervals import DEFAULT_TABLES, permitted
from codegen.ir import nodes as ir
from codegen.ir.types import Vector
from codegen.library import Library
from conformance.programs.chains import chained, straightened
from conformance.programs.extended import ExtendedLibrary
from conformance.programs.interpolated import interpolated

REARRANGING = frozenset({"glsl", "glsl_es", "vulkan", "wgsl", "opencl_relaxed"})
"""Accuracy tables of specifications that allow it."""
_CHAINS = {"+": ("+", "-"), "-": ("+", "-"), "*": ("*",)}


def explained(
    library: Library, name: str, inputs: Mapping[str, Any], target: str, value: Value, table: str = ""
) -> Array:
    """Mask of the lanes whose value lies in the interval of the rearranged function.

    table  the accuracy table; that of the target's default dialect if empty; no device rearranges nothing
    """
    chosen = table or DEFAULT_TABLES.get(target, "")
    if chosen not in REARRANGING:
        return np.zeros(1, np.bool_)
    functions = {f.name: _rearranged(f) for f in library.select([name]).functions}
    found = np.asarray(permitted(ExtendedLibrary(library, functions), name, inputs, chosen).contains(value))
    if found.all():
        return found
    functions = {f.name: interpolated(f) for f in library.select([name]).functions}
    found |= permitted(ExtendedLibrary(library, functions), name, inputs, chosen).contains(value)
    if found.all():
        return found
    straight = straightened(library, name)
    arguments = straight.arguments(inputs) if straight.parameters else {}
    for constants_first in (False, True):
        made = chained(straight.function, library, constants_first)
        allowed = permitted(ExtendedLibrary(library, {name: made}), name, arguments, chosen)
        found = found | allowed.contains(value)
    return found


def _rearranged(function: ir.Function) -> ir.Function:
    return replace(function, body=ir.map_body(function.body, _inwards))


def _inwards(e: ir.Expr) -> ir.Expr:
    """(a + b) + c becomes (a + c) + b for a constant c."""
    if not (isinstance(e, ir.Binary) and e.op in _CHAINS and isinstance(e.left, ir.Binary)):
        return e
    inner = e.left
    same = inner.op in _CHAINS[e.op] and inner.type == e.type == inner.left.type == e.right.type
    if not same or not _is_constant(e.right) or _is_constant(inner.right):
        return e
    return replace(inner, left=ir.Binary(e.type, e.op, inner.left, e.right))


def _is_constant(e: ir.Expr) -> bool:
    if isinstance(e, ir.Construct) and isinstance(e.type, Vector):
        return all(map(_is_constant, e.args))
    return isinstance(e, ir.Const)
