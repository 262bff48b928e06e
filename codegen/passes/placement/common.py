"""Common subexpressions: which values get a name, and which.

before   0.5 * sqrt(dot(a, a)) * x + 0.5 * sqrt(dot(a, a)) * y
after    size = 0.5 * sqrt(dot(a, a)); size * x + size * y

A value that is used twice is computed once. A value that the source names keeps that name where it makes the
text readable; other names say what is computed.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from codegen.ir import nodes as ir
from codegen.ir.types import Array, Vector
from codegen.names import reserved
from codegen.passes.analysis.operations import number_of_operations
from codegen.passes.placement.regions import Placement, Region, is_trivial
from codegen.passes.ssa.flow import Loop
from codegen.passes.ssa.values import FIELD, LOCAL, Hint, Values

WORTH_A_NAME = 3
"""Operations from which on a value keeps its name from the source although it is used once."""
TOO_LONG = 14
"""Operations from which on a value gets a name however it comes by one."""

_WORDS = {
    "+": "sum", "-": "difference", "*": "scaled", "/": "ratio", "dot": "cosine", "cross": "across",
    "sqrt": "root", "inverse_sqrt": "inverse_root", "exp": "power", "exp2": "power", "log": "logarithm",
    "log2": "logarithm", "min": "least", "max": "most", "clamp": "limited", "abs": "size", "length": "size",
    "normalize": "direction", "sin": "sine", "cos": "cosine", "atan2": "angle", "floor": "whole",
    "and": "both", "or": "either", "not": "opposite", "negate": "opposite", "select": "chosen",
    "<": "is_below", "<=": "is_below", ">": "is_above", ">=": "is_above", "==": "is_equal", "!=": "differs",
}  # fmt: skip


def named_values(values: Values, placement: Placement) -> set[int]:
    """The ids of values that become locals."""
    named = set(_handed_on(placement.root))
    size: dict[int, int] = {}
    given = {id(e) for e, _ in placement.used}
    for e in reversed(placement.order):
        inner = sum(size[id(c)] for c in ir.children(e) if id(c) not in named)
        size[id(e)] = inner + number_of_operations(e)
        if is_trivial(e) or isinstance(e, ir.Construct):
            shared = not is_trivial(e) and placement.uses[id(e)] > 1 and isinstance(e.type, Vector)
            if shared or (isinstance(e, ir.Construct) and isinstance(e.type, Array)):
                named.add(id(e))
            continue
        moved = id(e) in placement.moved
        assigned = id(e) in given
        hint = values.hints.get(id(e), Hint(0, ""))
        least = WORTH_A_NAME if hint.rank >= LOCAL else 2 * WORTH_A_NAME
        readable = hint.rank >= FIELD and size[id(e)] >= least
        long = not assigned and (readable or size[id(e)] > TOO_LONG)
        if placement.uses[id(e)] > 1 or moved or long:
            named.add(id(e))
    return named


def _handed_on(region: Region) -> Iterator[int]:
    """What a loop hands on is computed before any of it is assigned: one may need another."""
    for item in region.items:
        if isinstance(item, Loop) and len(item.carried) > 1:
            following = [c.following for c in item.carried]
            yield from (id(e) for e in following if not isinstance(e, ir.Const | ir.Var))
        for inner in region.inner[id(item)]:
            yield from _handed_on(inner)


class Names:
    """Gives names, each once, none of them reserved anywhere."""

    def __init__(self, taken: Collection[str]) -> None:
        self.taken = set(taken)

    def give(self, wanted: str) -> str:
        """The name itself if it is free, else with a number."""
        wanted = wanted.rstrip("_") or "value"
        if wanted in reserved():
            wanted = f"{wanted}_value"
        name, number = wanted, 1
        while name in self.taken or name in reserved():
            number += 1
            name = f"{wanted}_{number}"
        self.taken.add(name)
        return name

    def of(self, values: Values, e: ir.Expr) -> str:
        """A name for a value: from the source, else after what it computes."""
        if id(e) in values.hints:
            return self.give(values.hints[id(e)].name)
        match e:
            case ir.Builtin(op="dot", args=(ir.Var(name=a), ir.Var(name=b))) if _plain(a) and _plain(b):
                return self.give(f"{a}_dot_{b}")
            case ir.Unary() | ir.Binary() | ir.Builtin():
                return self.give(_WORDS.get(e.op, "part"))
            case ir.Select():
                return self.give("chosen")
            case ir.Call():
                return self.give(f"{e.function}_value")
            case _:
                return self.give("part")


def _plain(name: str) -> bool:
    return name.isidentifier()
