"""Dead code: branches and loops keep only what the result needs; parameters that nothing uses are gone.

before   for i in range(30): y = exp(y); return k
after    return k

Values need no such pass: what nothing uses is never written.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from codegen.ir import nodes as ir
from codegen.passes.ssa.flow import Branch, Carried, Flow, Item, Merge
from codegen.passes.ssa.values import Values, leaves

NAME = "dead"


def pruned(flow: Flow) -> Flow:
    """The flow without branches, loops and carried values that the result does not need."""
    makers = dict(_makers(flow.items))
    needed: set[str] = set()
    waiting = list(leaves(flow.result))
    seen: set[int] = set()
    while waiting:
        e = waiting.pop()
        if id(e) in seen:
            continue
        seen.add(id(e))
        waiting += ir.children(e)
        if isinstance(e, ir.Var) and e.name in makers:
            needed.add(e.name)
            waiting += makers[e.name]
    return Flow(_kept(flow.items, needed), flow.result)


def used_parameters(values: Values, of: Iterable[ir.Expr]) -> list[str]:
    """The paths of the parameters that some values use, in the order of the signature."""
    found: set[str] = set()
    seen: set[int] = set()
    waiting = list(of)
    while waiting:
        e = waiting.pop()
        if id(e) not in seen:
            seen.add(id(e))
            waiting += ir.children(e)
            if isinstance(e, ir.Var):
                found.add(e.name)
    return [path for path in values.parameters if path in found]


def _makers(items: list[Item]) -> Iterator[tuple[str, tuple[ir.Expr, ...]]]:
    """Each leaf that a branch or loop binds, with the values that make it."""
    for item in items:
        if isinstance(item, Branch):
            yield from _makers(item.then)
            yield from _makers(item.orelse)
            for m in item.merges:
                yield m.leaf.name, (item.condition, m.then, m.orelse)
        else:
            yield from _makers(item.body)
            for c in item.carried:
                yield c.inside.name, (c.initial, c.following, c.outside)
                yield c.outside.name, (c.initial, c.following, c.inside)


def _kept(items: list[Item], needed: set[str]) -> list[Item]:
    kept: list[Item] = []
    for item in items:
        if isinstance(item, Branch):
            merges: list[Merge] = [m for m in item.merges if m.leaf.name in needed]
            if merges:
                sides = _kept(item.then, needed), _kept(item.orelse, needed)
                kept.append(replace(item, then=sides[0], orelse=sides[1], merges=merges))
        else:
            carried: list[Carried] = [c for c in item.carried if c.outside.name in needed]
            if carried:
                kept.append(replace(item, body=_kept(item.body, needed), carried=carried))
    return kept
