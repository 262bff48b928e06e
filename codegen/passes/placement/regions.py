"""Where each value of a flow is computed: as late as all its uses allow, but outside loops it does not need.

before   for i in range(9): total = total + sqrt(k) * x        if c: y = sqrt(k)   else: y = 0
after    sqrt(k) before the loop                               sqrt(k) inside the branch only
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

from codegen.ir import nodes as ir
from codegen.ir.types import Array
from codegen.passes.ssa.flow import Branch, Flow, Item


@dataclass(eq=False)
class Region:
    """A sequence of branches and loops: the function itself, one side of a branch, or a loop's body."""

    parent: Region | None
    is_loop: bool
    items: list[Item]
    depth: int
    inner: dict[int, tuple[Region, ...]] = field(default_factory=dict)

    def ancestors(self) -> Iterator[Region]:
        """This region and those around it, innermost first."""
        region: Region | None = self
        while region is not None:
            yield region
            region = region.parent


@dataclass
class Placement:
    """The regions of a flow, the region of every value, and how often each is used.

    homes     id of a value -> region in which it is computed
    uses      id of a value -> number of places that use it; what costs nothing counts for its operands
    order     every value, those that use others first
    moved     ids of values that are computed outside the regions that use them
    used      values that a branch, a loop or the function gives as they are, with the region that does
    """

    root: Region
    homes: dict[int, Region]
    uses: dict[int, int]
    order: list[ir.Expr]
    moved: set[int]
    used: list[tuple[ir.Expr, Region]]


def place(flow: Flow, result: ir.Expr) -> Placement:
    """Decide the region of every value that branches, loops and the result need."""
    root, bound, used = _regions(flow, result)
    order = _users_first([e for e, _ in used])
    wanted: dict[int, Region] = {}
    uses: dict[int, int] = {}

    def use(e: ir.Expr, region: Region, times: int = 1) -> None:
        wanted[id(e)] = _common(wanted[id(e)], region) if id(e) in wanted else region
        uses[id(e)] = uses.get(id(e), 0) + times

    for e, region in used:
        use(e, region)
    known = _available(order, bound, root)
    homes: dict[int, Region] = {}
    for e in order:
        home = _hoisted(wanted[id(e)], known[id(e)])
        homes[id(e)] = home
        times = uses[id(e)] if is_trivial(e) else 1
        for child in ir.children(e):
            use(child, home, times)
    moved = {key for key, home in homes.items() if home is not wanted[key]}
    return Placement(root, homes, uses, order, moved, used)


def is_trivial(e: ir.Expr) -> bool:
    """Whether an expression costs nothing, so that repeating it is better than naming it."""
    test = _TRIVIAL.get(type(e))
    return test is not None and test(e)


def _always(e: ir.Expr) -> bool:
    return True


def _trivial_sign(e: ir.Unary) -> bool:
    return e.op == "negate" and isinstance(e.operand, ir.Const | ir.Var)


def _trivial_element(e: ir.Index) -> bool:
    return isinstance(e.value, ir.Var) and isinstance(e.index, ir.Var | ir.Const)


def _trivial_vector(e: ir.Construct) -> bool:
    return not isinstance(e.type, Array) and all(isinstance(a, ir.Const) for a in e.args)


_TRIVIAL: dict[type, Callable[[Any], bool]] = {
    **dict.fromkeys((ir.Const, ir.Var, ir.Swizzle, ir.Member), _always),
    ir.Unary: _trivial_sign,
    ir.Index: _trivial_element,
    ir.Construct: _trivial_vector,
}
"""A table, since every value is asked for in every flow; what is not in it costs something."""


def _regions(flow: Flow, result: ir.Expr) -> tuple[Region, dict[str, Region], list[tuple[ir.Expr, Region]]]:
    """The tree of regions, where each leaf is bound, and the values that each region uses itself."""
    bound: dict[str, Region] = {}
    used: list[tuple[ir.Expr, Region]] = []

    def enter(items: list[Item], parent: Region | None, is_loop: bool) -> Region:
        region = Region(parent, is_loop, items, parent.depth + 1 if parent else 0)
        for item in items:
            if isinstance(item, Branch):
                used.append((item.condition, region))
                then, orelse = enter(item.then, region, False), enter(item.orelse, region, False)
                region.inner[id(item)] = then, orelse
                for m in item.merges:
                    bound[m.leaf.name] = region
                    used.extend(((m.then, then), (m.orelse, orelse)))
            else:
                body = enter(item.body, region, True)
                region.inner[id(item)] = (body,)
                if item.limit is not None:
                    used.append((item.limit, region))
                bound[item.index.name] = body
                for c in item.carried:
                    bound[c.inside.name], bound[c.outside.name] = body, region
                    used.extend(((c.initial, region), (c.following, body)))
        return region

    root = enter(flow.items, None, False)
    used.append((result, root))
    return root, bound, used


def _users_first(of: list[ir.Expr]) -> list[ir.Expr]:
    """Every value below some, each after all that use it."""
    done: list[ir.Expr] = []
    seen: set[int] = set()
    for top in reversed(of):
        waiting = [(top, False)]
        while waiting:
            e, ready = waiting.pop()
            if ready:
                done.append(e)
            elif id(e) not in seen:
                seen.add(id(e))
                waiting.append((e, True))
                waiting += [(c, False) for c in ir.children(e)]
    return done[::-1]


def _available(order: list[ir.Expr], bound: dict[str, Region], root: Region) -> dict[int, Region]:
    """The outermost region in which all leaves of a value are known."""
    known: dict[int, Region] = {}
    for e in reversed(order):
        here = bound.get(e.name, root) if isinstance(e, ir.Var) else root
        for c in ir.children(e):
            if known[id(c)].depth > here.depth:
                here = known[id(c)]
        known[id(e)] = here
    return known


def _common(a: Region, b: Region) -> Region:
    if a is b:
        return a
    around = set(map(id, a.ancestors()))
    return next(region for region in b.ancestors() if id(region) in around)


def _hoisted(wanted: Region, known: Region) -> Region:
    best = wanted
    for region in wanted.ancestors():
        if region is known:
            break
        if region.is_loop and region.parent is not None:
            best = region.parent
    return best
