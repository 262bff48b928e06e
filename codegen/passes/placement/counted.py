"""How many operations the statements of a flow hold, without writing them.

A value that gets a name is written once, where it is computed; any other inside the texts of what uses it. In
the body of a loop that is once an iteration, as codegen.passes.analysis.operations counts.
"""

from __future__ import annotations

from codegen.ir import nodes as ir
from codegen.ir.types import Type
from codegen.passes.analysis.operations import number_of_operations
from codegen.passes.inline import joined
from codegen.passes.placement.common import named_values
from codegen.passes.placement.regions import Region, place
from codegen.passes.ssa.flow import Flow, Loop
from codegen.passes.ssa.values import Values


def operations_of(values: Values, flow: Flow, returns: Type) -> int:
    """The operations of the statements that `schedule.statements` makes of a flow."""
    placement = place(flow, joined(values, returns, flow.result))
    named = named_values(values, placement)
    often: dict[int, int] = {}
    written = dict.fromkeys(map(id, placement.order), 0)

    def enter(region: Region, times: int) -> None:
        often[id(region)] = times
        for item in region.items:
            inside = times
            if isinstance(item, Loop):
                if item.limit is not None:  # the head of a loop does not count
                    written[id(item.limit)] -= times
                if isinstance(item.limit, ir.Const | None):
                    inside *= max(item.stop - item.start, 0)
            for inner in region.inner[id(item)]:
                enter(inner, inside)

    enter(placement.root, 1)
    for e, region in placement.used:
        written[id(e)] += often[id(region)]
    total = 0
    for e in placement.order:
        if id(e) in named:
            written[id(e)] = often[id(placement.homes[id(e)])]
        times = written[id(e)]
        total += times * number_of_operations(e)
        for child in ir.children(e):
            written[id(child)] += times
    return total
