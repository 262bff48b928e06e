"""Rewritings of a function that keep its meaning, one idea a file."""

from conformance.metamorphic.relation import SourceRelation
from conformance.metamorphic.source import (
    branches,
    calls,
    choices,
    loops,
    opaque,
    operands,
    order,
    subexpressions,
    uniforms,
    vectors,
)

MODULES = (opaque, calls, loops, vectors, uniforms, order, subexpressions, branches, choices, operands)
RELATIONS: tuple[SourceRelation, ...] = tuple(r for module in MODULES for r in module.RELATIONS)
