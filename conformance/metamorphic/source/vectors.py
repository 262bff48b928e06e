"""Operations on vectors taken apart into operations on their components."""

from __future__ import annotations

from codegen.ir import nodes as ir
from codegen.library import Library
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Changed, SourceRelation
from conformance.programs.components import componentwise


def _apply(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    apart = componentwise(function)
    return None if apart.body == function.body else Changed(apart)


RELATIONS = (SourceRelation("scalar_path", "vector operations component by component", _apply),)
