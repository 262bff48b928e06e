"""How many operations a function has left where parameters are constant: one question after the other.

All questions share their values, so that what does not depend on what is asked is simplified once.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from codegen.ir import nodes as ir
from codegen.ir.content import variables
from codegen.library import Library
from codegen.passes.analysis.operations import operations
from codegen.passes.analysis.ranges import Ranges
from codegen.passes.inline import Inliner, Scope
from codegen.passes.placement.counted import operations_of
from codegen.passes.placement.dead import pruned
from codegen.passes.specialise import EXACT_KINDS, exact_rules, specialise
from codegen.passes.ssa.values import Value, Values
from codegen.passes.subject import Subject

Known = dict[tuple[int, ...], tuple[Value, list[Value]]]


def operations_left(
    library: Library, name: str, questions: Iterable[Mapping[str, Any]], unroll: int
) -> list[int]:
    """The operations that `specialise` leaves for each set of constants, path -> value."""
    shared = _Shared(library, library.function(name), unroll)
    return [shared.operations(constants) for constants in questions]


@dataclass
class _Recalling(Inliner):
    """Follows a function again: a statement over the same values has the same value.

    known  a statement's expression and the values of its variables, by their ids -> its value, and those
           values: structs are made anew each time, and the id of one that is gone may be another's
    names  of the variables of an expression, by its id
    """

    known: Known = field(default_factory=dict)
    names: dict[int, tuple[str, ...]] = field(default_factory=dict)

    def whole(self, e: ir.Expr, scope: Scope) -> Value:
        if id(e) not in self.names:
            self.names[id(e)] = variables(e)
        of = [scope[name] for name in self.names[id(e)]]
        key = (id(e), *map(id, of))
        if key not in self.known:
            self.known[key] = self.expr(e, scope), of
        return self.known[key][0]


class _Shared:
    def __init__(self, library: Library, function: ir.Function, unroll: int) -> None:
        self.library, self.function, self.unroll = library, function, unroll
        self.values = self.fresh()
        self.names: dict[int, tuple[str, ...]] = {}

    def fresh(self) -> Values:
        """Values of which nothing is known yet."""
        values = Values(function=self.function.name, line=self.function.place.line)
        values.simplify_by(exact_rules(Ranges(values), frozenset(EXACT_KINDS)))
        self.known: Known = {}
        return values

    def operations(self, constants: Mapping[str, Any]) -> int:
        """The operations that are left for these constants."""
        values, function = self.values, self.function
        before = dict(values.indices)
        arguments = Subject(function, dict(constants), {}, {}).arguments(values)
        inliner = _Recalling(self.library, values, (), self.unroll, known=self.known, names=self.names)
        flow = pruned(inliner.flow(function, arguments))
        if any(values.indices[index] != ends for index, ends in before.items()):
            # A loop has the variable of another: what is known of that one does not hold for it.
            self.values = self.fresh()
            made = specialise(self.library, function.name, constants, new_name="probe", unroll=self.unroll)
            return sum(operations(made.function).values())
        return operations_of(values, flow, function.returns)
