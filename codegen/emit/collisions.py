"""Whether a prefix makes names that collide: with words of any target, or with names that stay as they are.

Parameters, locals and fields keep their names. A function named like one of them would be hidden by it.
"""

from __future__ import annotations

from collections.abc import Iterator

from codegen.emit.dialect import Dialect
from codegen.errors import UserError
from codegen.ir import nodes as ir
from codegen.ir.types import TEXTURE
from codegen.ir.unit import Unit
from codegen.names import check_emitted


def check_collisions(unit: Unit, dialect: Dialect, prefix: str) -> None:
    """Raise UserError where a prefixed name is reserved, or is that of a parameter, local or field.

    unit  as it is printed, but before its names are prefixed
    """
    inner = dict(inner_names(unit, dialect))
    for name in (*(f.name for f in unit.functions), *(s.name for s in unit.structs)):
        check_emitted(prefix + name, prefix)
        if prefix + name in inner:
            raise UserError(f'prefix "{prefix}" makes "{prefix + name}", which is {inner[prefix + name]}')


def inner_names(unit: Unit, dialect: Dialect) -> Iterator[tuple[str, str]]:
    """Every name that stays as it is, and what has it: ("exponent", "a parameter of fakefur_lobe")."""
    for s in unit.structs:
        for field in s.type.fields:
            yield field.name, f"a field of {s.name}"
    for f in unit.functions:
        for statement in ir.statements(f.body):
            if isinstance(statement, ir.Let | ir.For):
                yield statement.name, f"a local of {f.name}"
        for p in f.parameters:
            parts = (tail for tail, _ in dialect.texture) if p.type == TEXTURE else ("",)
            for tail in parts:
                yield p.name + tail, f"a parameter of {f.name}"
