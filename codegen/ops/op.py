"""What a row of the op registry holds."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from codegen.ir.types import F16, F32, Type, element_of, half_of, single_of
from codegen.ops.rules import Rule

Meaning = Callable[..., Any]
"""(m, *operands) -> value; m is a namespace of numpy's names: numpy itself, or codegen.evaluate.precise."""

COSTS = ("free", "add", "multiply", "divide", "root", "exponential", "trigonometric", "texture")
"""Cost classes: a coarse order for reading reports. Speed is measured, never summed from these."""


@dataclass(frozen=True)
class Op:
    """One row: an operator (name is its symbol) or a built-in function.

    rule      overloads: argument types -> result type
    meaning   the value over the numbers, in terms of numpy names
    cost      one of COSTS
    probe     legal sample arguments, one tuple per sample (vectors as tuples)
    see       where the specifications speak of it; what they promise is in codegen/intervals/tables
    summary   one line for editors (built-ins)
    names     parameter names for editors (built-ins)
    spell     spelling per target where it differs from `name`
    trailing  numbers that the text adds to the arguments
    text      per target, the whole expression of a built-in that is no call there; {0} is the name of the
              first argument
    half      whether the overloads of f32 hold for f16 as well
    work      scalar operations by cost class for vectors of n components, where that is not n times `cost`
    """

    name: str
    rule: Rule
    meaning: Meaning
    cost: str
    probe: tuple[tuple[Any, ...], ...]
    see: str
    summary: str = ""
    names: tuple[str, ...] = ()
    spell: Mapping[str, str] = field(default_factory=dict)
    work: Callable[[int], Mapping[str, int]] | None = None
    half: bool = True
    trailing: tuple[float, ...] = ()
    text: Mapping[str, str] = field(default_factory=dict)

    def operations(self, size: int) -> Mapping[str, int]:
        """Scalar operations by cost class for operands of `size` components."""
        return {self.cost: size} if self.work is None else self.work(size)

    def result(self, arguments: tuple[Type, ...]) -> Type | None:
        """The result type for these argument types; None where no overload fits.

        Halves follow the overloads of f32; halves and f32 do not mix.
        """
        elements = {element_of(t) for t in arguments}
        if F16 not in elements:
            return next((result for types, result in self.rule if types == arguments), None)
        if F32 in elements or not self.half:
            return None
        found = self.result(tuple(map(single_of, arguments)))
        return None if found is None else half_of(found)

    def spelling(self, target: str) -> str:
        """The name in a target's text."""
        return self.spell.get(target, self.name)


def table(*rows: Op) -> dict[str, Op]:
    """Rows by name; a name may stand once."""
    names = [row.name for row in rows]
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        raise ValueError(f"rows given twice: {', '.join(sorted(twice))}")
    return dict(zip(names, rows, strict=True))
