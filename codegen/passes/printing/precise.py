"""Naming results: every computed value that a function returns gets a local of its own.

before   return 0.5 * length(cross(a - b, a + b))
after    returned = 0.5 * length(cross(a - b, a + b)); return returned

GLSL's `precise` stands before a variable and reaches every operation that contributes to it. After this pass
each operation contributes to a variable, so the printer can put the qualifier before all of them.
"""

from __future__ import annotations

from dataclasses import replace

from codegen.ir import nodes as ir
from codegen.ir.unit import Unit

STEM = "returned"


def name_results(unit: Unit) -> Unit:
    """The unit without computed operands of return."""
    return Unit(tuple(map(_function, unit.functions)), unit.structs)


def _function(f: ir.Function) -> ir.Function:
    taken = {p.name for p in f.parameters}
    taken |= {s.name for s in ir.statements(f.body) if isinstance(s, ir.Let | ir.For)}
    name = STEM
    while name in taken:
        name += "_"
    return replace(f, body=_block(f.body, name))


def _block(body: tuple[ir.Stmt, ...], name: str) -> tuple[ir.Stmt, ...]:
    found: list[ir.Stmt] = []
    for s in body:
        match s:
            case ir.Return() if not isinstance(s.value, ir.Var | ir.Const):
                found += [ir.Let(name, s.value), replace(s, value=ir.Var(s.value.type, name))]
            case ir.If():
                found.append(replace(s, then=_block(s.then, name), orelse=_block(s.orelse, name)))
            case ir.For():
                found.append(replace(s, body=_block(s.body, name)))
            case _:
                found.append(s)
    return tuple(found)
