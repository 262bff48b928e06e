"""Prefixing: functions and structs of the library get the prefix; fields and parameters keep their names.

before   StrandAngles{...}   def strand_specular(t, l): ... safe_pow(x, y)
after    vair_StrandAngles{...}   def vair_strand_specular(t, l): ... vair_safe_pow(x, y)
"""

from __future__ import annotations

from dataclasses import replace

from codegen.ir import nodes as ir
from codegen.ir.types import Array, Struct, Type
from codegen.ir.unit import Unit


def add_prefix(unit: Unit, prefix: str) -> Unit:
    """The unit with prefixed names."""

    def type_(t: Type) -> Type:
        if not isinstance(t, Struct) or isinstance(t, Array):
            return t
        return Struct(prefix + t.name, tuple(replace(f, type=type_(f.type)) for f in t.fields))

    def node(e: ir.Expr) -> ir.Expr:
        new = type_(e.type)
        if new is not e.type:
            e = replace(e, type=new)
        return replace(e, function=prefix + e.function) if isinstance(e, ir.Call) else e

    def function(f: ir.Function) -> ir.Function:
        return replace(
            f,
            name=prefix + f.name,
            parameters=tuple(replace(p, type=type_(p.type)) for p in f.parameters),
            returns=type_(f.returns),
            body=ir.map_body(f.body, node),
        )

    def struct(s: ir.StructDef) -> ir.StructDef:
        renamed = type_(s.type)
        assert isinstance(renamed, Struct)
        return replace(s, type=renamed)

    return Unit(tuple(map(function, unit.functions)), tuple(map(struct, unit.structs)))
