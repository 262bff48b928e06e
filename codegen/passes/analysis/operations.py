"""How many operations a function writes down, by cost class; a coarse measure for reports, not of speed.

arithmetic  additions, multiplications, min, max, floor (per component; clamp is two)
special     divisions, roots, exponentials, logarithms, trigonometry
select      choices between two values, per component
compare     comparisons
"""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Callable, Mapping

from codegen.ir import nodes as ir
from codegen.ir.types import Vector
from codegen.library import Library
from codegen.ops import BUILTINS, OPERATORS

CLASSES = ("arithmetic", "special", "select", "compare")
WEIGHTS = {"arithmetic": 1, "special": 8, "select": 1, "compare": 1}
"""Rough relative costs, for decisions that no measurement is worth."""
_COMPARISONS = frozenset({"<", "<=", ">", ">=", "==", "!="})
_ARITHMETIC = frozenset({"add", "multiply"})
_OPERATIONS = (ir.Binary, ir.Builtin, ir.Unary)


def operations(function: ir.Function, library: Library | None = None) -> dict[str, int]:
    """Operations by class of one evaluation; every class is there.

    Both sides of branches count, and loop bodies once per iteration; of a loop that a parameter ends, one
    iteration. What the function calls counts where a library is given to look it up.
    """
    return {**dict.fromkeys(CLASSES, 0), **_counted(function, library, expression_operations)}


def operations_by_cost(function: ir.Function, library: Library) -> dict[str, int]:
    """Scalar operations of one evaluation, calls included, by cost class (codegen.ops.op.COSTS).

    Branches and loops count as in `operations`; classes without an operation are left out.
    """
    counts = _counted(function, library, _registered_operations)
    return {cost: n for cost, n in sorted(counts.items()) if cost != "free"}


def _counted(
    function: ir.Function, library: Library | None, of: Callable[[ir.Expr], Mapping[str, int]]
) -> Counter[str]:
    """The sum of what `of` says of every node, each as often as one evaluation meets it."""
    counts: Counter[str] = Counter()

    def tree(e: ir.Expr, times: int) -> None:
        own, calls = _whole(e, of)
        called = (
            [_counted(library.function(name), library, of) for name in calls] if library is not None else []
        )
        for found in (*called, own):
            for kind, n in found.items():
                counts[kind] += n * times

    def block(body: tuple[ir.Stmt, ...], times: int) -> None:
        for s in body:
            match s:
                case ir.If():
                    tree(s.condition, times)
                    block(s.then, times)
                    block(s.orelse, times)
                case ir.For():
                    known = isinstance(s.limit, ir.Const | None)
                    block(s.body, times * (max(s.stop - s.start, 0) if known else 1))
                case _:
                    tree(s.value, times)

    block(function.body, 1)
    return counts


@functools.lru_cache(16_384)
def _whole(
    e: ir.Expr, of: Callable[[ir.Expr], Mapping[str, int]]
) -> tuple[Mapping[str, int], tuple[str, ...]]:
    """The sum of what `of` says of an expression's nodes, and the functions that it calls."""
    counts: Counter[str] = Counter()
    calls: list[str] = []
    for x in ir.walk(e):
        if isinstance(x, ir.Call):
            calls.append(x.function)
        for kind, n in of(x).items():
            counts[kind] += n
    return counts, tuple(calls)


def expression_operations(e: ir.Expr) -> Mapping[str, int]:
    """Operations by class of one node, its operands left out."""
    if isinstance(e, ir.Select):
        return {"select": e.type.size if isinstance(e.type, Vector) else 1}
    if not isinstance(e, ir.Unary | ir.Binary | ir.Builtin):
        return {}
    return _by_class(e.op, isinstance(e, ir.Builtin), _width(e))


def number_of_operations(e: ir.Expr) -> int:
    """Operations of one node, its operands left out, whatever their class."""
    if isinstance(e, _OPERATIONS):
        return _number(e.op, isinstance(e, ir.Builtin), _width(e))
    return sum(expression_operations(e).values())


@functools.cache
def _number(op: str, is_builtin: bool, width: int) -> int:
    return sum(_by_class(op, is_builtin, width).values())


@functools.cache
def _by_class(op: str, is_builtin: bool, width: int) -> Mapping[str, int]:
    """Operations by class of an operator or a built-in at a width."""
    if op in _COMPARISONS:
        return {"compare": 1}
    if op == "clamp":
        return {"arithmetic": 2 * width}
    found: Counter[str] = Counter()
    for cost, n in (BUILTINS if is_builtin else OPERATORS)[op].operations(width).items():
        if cost != "free":
            found["arithmetic" if cost in _ARITHMETIC else "special"] += n
    return found


def _registered_operations(e: ir.Expr) -> Mapping[str, int]:
    """Scalar operations of one node by the registry's cost classes; none for what has no row there."""
    if not isinstance(e, ir.Unary | ir.Binary | ir.Builtin):
        return {}
    row = BUILTINS[e.op] if isinstance(e, ir.Builtin) else OPERATORS[e.op]
    return row.operations(_width(e))


def _width(e: ir.Expr) -> int:
    """Components of the widest of the node and its operands."""
    widest = e.type.size if isinstance(e.type, Vector) else 1
    for c in ir.children(e):
        if isinstance(c.type, Vector) and c.type.size > widest:
            widest = c.type.size
    return widest
