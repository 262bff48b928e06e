"""Statements of a flow: locals near their first use, in the regions that `regions` chose."""

from __future__ import annotations

from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, Type
from codegen.passes.inline import joined
from codegen.passes.placement.common import Names, named_values
from codegen.passes.placement.regions import Placement, Region, place
from codegen.passes.ssa.flow import Branch, Flow, Item, Loop, roots
from codegen.passes.ssa.values import Values

Origins = dict[int, tuple[str, int]]
"""Line number of a statement -> function and line of the source that its value comes from."""


def statements(
    values: Values, flow: Flow, returns: Type, parameters: dict[str, str], line: int = 0
) -> tuple[tuple[ir.Stmt, ...], Origins]:
    """The body of a function, and where its statements come from.

    parameters  the final name of each parameter by its path
    line        what the statements are numbered from
    """
    result = joined(values, returns, flow.result)
    writer = _Writer(values, place(flow, result), parameters, line)
    return writer.body(flow.items, result), writer.origins


class _Writer:
    def __init__(self, values: Values, placement: Placement, parameters: dict[str, str], line: int) -> None:
        self.values = values
        self.placement = placement
        self.names = Names(parameters.values())
        self.variables = dict(parameters)
        self.named = named_values(values, placement)
        self.locals: dict[int, str] = {}
        self.line = line
        self.origins: Origins = {}

    def body(self, items: list[Item], result: ir.Expr) -> tuple[ir.Stmt, ...]:
        out: list[ir.Stmt] = []
        self.region(self.placement.root, out)
        self.demand(result, self.placement.root, out)
        out.append(ir.Return(self.text(result), self.next_line(result)))
        return tuple(out)

    def next_line(self, of: ir.Expr) -> int:
        """The number of a statement about a value."""
        self.line += 1
        if id(of) in self.values.origins:
            self.origins[self.line] = self.values.origins[id(of)]
        return self.line

    def region(self, region: Region, out: list[ir.Stmt]) -> None:
        """The statements of the region's branches and loops, and what they need."""
        for item in region.items:
            for e in roots([item]):
                self.demand(e, region, out)
            if isinstance(item, Branch):
                self.branch(item, region, out)
            else:
                self.loop(item, region, out)

    def branch(self, item: Branch, region: Region, out: list[ir.Stmt]) -> None:
        for m in item.merges:
            self.variables[m.leaf.name] = self.names.give(m.name)
            start = self.start(m.then.type)
            out.append(ir.Let(self.variables[m.leaf.name], start, True, self.next_line(m.then)))
        condition, line = self.text(item.condition), self.next_line(item.condition)
        sides: list[tuple[ir.Stmt, ...]] = []
        for k, inner in enumerate(region.inner[id(item)]):
            found: list[ir.Stmt] = []
            self.region(inner, found)
            for m in item.merges:
                value = m.orelse if k else m.then
                self.demand(value, inner, found)
                found.append(ir.Assign(self.variables[m.leaf.name], self.text(value), self.next_line(value)))
            sides.append(tuple(found))
        out.append(ir.If(condition, sides[0], sides[1], line))

    def start(self, type_: Type) -> ir.Expr:
        """A value to declare a variable with, before either side gives it one."""
        return self.values.number(False if type_ == BOOL else 0, type_)

    def loop(self, item: Loop, region: Region, out: list[ir.Stmt]) -> None:
        for c in item.carried:
            name = self.names.give(c.name)
            self.variables[c.inside.name] = self.variables[c.outside.name] = name
            out.append(ir.Let(name, self.text(c.initial), True, self.next_line(c.following)))
        self.variables[item.index.name] = self.names.give(item.name)
        limit = None if item.limit is None else self.text(item.limit)
        line = self.next_line(item.index)
        (inner,) = region.inner[id(item)]
        found: list[ir.Stmt] = []
        self.region(inner, found)
        for c in item.carried:
            self.demand(c.following, inner, found)
        copies: dict[int, str] = {}
        for c in item.carried:
            if isinstance(c.following, ir.Var) and len(item.carried) > 1:
                copies[id(c)] = self.names.give(c.name)
                line_of_copy = self.next_line(c.following)
                found.append(ir.Let(copies[id(c)], self.text(c.following), False, line_of_copy))
        for c in item.carried:
            value = ir.Var(c.following.type, copies[id(c)]) if id(c) in copies else self.text(c.following)
            found.append(ir.Assign(self.variables[c.inside.name], value, self.next_line(c.following)))
        out.append(ir.For(self.variables[item.index.name], item.start, item.stop, tuple(found), line, limit))

    def demand(self, e: ir.Expr, region: Region, out: list[ir.Stmt]) -> None:
        """Define the locals of this region that a value needs and that are not there yet."""
        waiting = [(e, False)]
        seen: set[int] = set()
        while waiting:
            x, ready = waiting.pop()
            if ready:
                if id(x) in self.named and self.placement.homes[id(x)] is region and id(x) not in self.locals:
                    value = self.text(x)
                    self.locals[id(x)] = self.names.of(self.values, x)
                    out.append(ir.Let(self.locals[id(x)], value, False, self.next_line(x)))
            elif id(x) not in seen and id(x) not in self.locals:
                seen.add(id(x))
                waiting.append((x, True))
                waiting += [(c, False) for c in reversed(ir.children(x))]

    def text(self, e: ir.Expr) -> ir.Expr:
        """A value over the names given so far."""
        if id(e) in self.locals:
            return ir.Var(e.type, self.locals[id(e)])
        if isinstance(e, ir.Var):
            return ir.Var(e.type, self.variables[e.name])
        return ir.rebuild(e, tuple(map(self.text, ir.children(e))))
