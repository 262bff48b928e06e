"""The loop over the lights of a coat, with everything taken out of it that is the same for all lights.

The loop is written as a function of the library's language around the shading function, and specialised:
calls become values, what does not depend on the light moves before the loop, what is known is folded. The
statements then go into the stages as text.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from codegen.emit.dialect import Dialect
from codegen.emit.stmt import StmtPrinter
from codegen.errors import Place
from codegen.fur.shading import FROM_STAGE, HALF_VECTOR, SCALED, FurShading, member_name
from codegen.ir import nodes as ir
from codegen.ir.domains import Interval, Unit
from codegen.ir.types import F32, U32, VEC3, Struct, array_of
from codegen.library import Library
from codegen.passes.specialise import specialise

NAME = "fur_radiance"
ATTENUATION = "fur_surface_attenuation"
BODY = {"body_shadow": "rho_surface", "body_dark": "cos_dark", "body_lit": "cos_lit"}
"""Parameters of the shadow that the body casts on its coat, and their members of the uniform block."""
SHARES = ("length_share", "density_share")
OF_THE_STAGE = ("t", "n", "v", *SHARES)
"""Variables of the stage that the statements read."""
TAKEN = (*OF_THE_STAGE, "position", "height", "lit", "radiance", "k", "l", "light", "h", "fur")
"""Names that the statements must not declare; the light and its direction stand for elements of arrays."""
BRIGHTEST = 1.0e4

Names = Mapping[str, str]


@dataclass(frozen=True)
class Lighting:
    """Statements of a stage.

    before  what all lights share
    each    of one light: they read `l` and `light` and add to `radiance`
    """

    before: tuple[ir.Stmt, ...]
    each: tuple[ir.Stmt, ...]

    def texts(self, dialect: Dialect) -> dict[str, str]:
        """Both as whole lines of a template, by the name of their place there."""
        printer = StmtPrinter(dialect)
        parts = {"before": printer.block(self.before, 4 * " "), "each": printer.block(self.each, 12 * " ")}
        return {name: "".join(f"{line}\n" for line in lines) for name, lines in parts.items()}


def fur_lighting(library: Library, shading: FurShading) -> Lighting:
    """The lighting of a coat by all lights, with what the shading knows folded in."""
    loop = _loop(shading)
    made = specialise(library.with_functions([loop]), NAME, shading.known)
    members = {
        made.parameters[path]: name for path, name in _members(shading).items() if path in made.parameters
    }
    body = made.function.body
    at = next(k for k, s in enumerate(body) if isinstance(s, ir.For))
    lights = body[at]
    assert isinstance(lights, ir.For)
    sums = {s.name for s in lights.body if isinstance(s, ir.Assign)}
    before = tuple(s for s in body[:at] if not (isinstance(s, ir.Let) and s.name in sums))
    renamed = _renamed(before + lights.body, dict.fromkeys(sums, "radiance"))
    variables = {**renamed, **{name: f"{shading.block}.{member}" for name, member in members.items()}}
    change = _change(variables)
    return Lighting(*(_with_names(ir.map_body(part, change), renamed) for part in (before, lights.body)))


def _loop(shading: FurShading) -> ir.Function:
    """The sum over the lights as a function of the library's language."""
    directions = ir.Var(array_of(VEC3, shading.lights), "light_directions")
    colours = ir.Var(array_of(VEC3, shading.lights), "light_colours")
    k, l, light = ir.Var(U32, "k"), ir.Var(VEC3, "l"), ir.Var(VEC3, "light")
    names = {p.name for p in shading.function.parameters}
    share, cosine = Interval(0.0, 1.0), Interval(-1.0, 1.0)
    parameters = [ir.Parameter(name, VEC3, Unit()) for name in ("t", "n", "v")]
    each: list[ir.Stmt] = [
        ir.Let("l", ir.Index(VEC3, directions, k)),
        ir.Let("light", ir.Index(VEC3, colours, k)),
    ]
    arguments: list[ir.Expr] = []
    before: list[ir.Stmt] = []
    for p in shading.function.parameters:
        path = shading.paths.get(p.name, p.name)
        value: ir.Expr = ir.Var(p.type, p.name)
        if path not in FROM_STAGE:
            parameters.append(p)
            value = _scaled(value, path)
        if isinstance(value, ir.Construct):
            before.append(ir.Let(f"{p.name}_here", value))
            value = ir.Var(p.type, f"{p.name}_here")
        arguments.append(value)
    if "h" in names:
        each.append(ir.Let("h", ir.Call(VEC3, HALF_VECTOR, (l, ir.Var(VEC3, "v")))))
    reflected: ir.Expr = ir.Call(VEC3, shading.function.name, tuple(arguments))
    if "light" not in names:
        reflected = ir.Binary(VEC3, "*", light, reflected)
    n_dot_l = ir.Builtin(F32, "dot", (ir.Var(VEC3, "n"), l))
    surface = ir.Call(F32, ATTENUATION, (n_dot_l, *(ir.Var(F32, name) for name in BODY)))
    total = ir.Var(VEC3, "radiance")
    sum_ = ir.Binary(VEC3, "+", total, ir.Binary(VEC3, "*", surface, reflected))
    each.append(ir.Assign(total.name, sum_))
    body = (
        *before,
        ir.Let(total.name, ir.Construct(VEC3, (ir.Const(F32, 0.0),)), mutable=True),
        ir.For(k.name, 0, shading.lights, tuple(each), limit=ir.Var(U32, "light_count")),
        ir.Return(total),
    )
    parameters += [
        *(ir.Parameter(name, F32, share if name == "body_shadow" else cosine) for name in BODY),
        *(ir.Parameter(name, F32, share) for name in SHARES),
        ir.Parameter("light_count", U32, Interval(0, shading.lights)),
        ir.Parameter(directions.name, directions.type, Unit()),
        ir.Parameter(colours.name, colours.type, Interval(0.0, BRIGHTEST)),
    ]
    doc, place = ir.Doc("Light that a point of a coat sends to the eye.", {}), Place(NAME, 1)
    return ir.Function(NAME, "fur", "base", None, tuple(parameters), VEC3, body, doc, place)


def _scaled(value: ir.Expr, path: str) -> ir.Expr:
    """A material's value, with what vertices scale of it."""
    if isinstance(value.type, Struct):
        parts = [_scaled(ir.Member(f.type, value, f.name), f"{path}.{f.name}") for f in value.type.fields]
        return ir.Construct(value.type, tuple(parts))
    if path in SCALED:
        return ir.Binary(F32, "*", value, ir.Var(F32, SCALED[path]))
    return value


def _members(shading: FurShading) -> dict[str, str]:
    """Path of a parameter of the loop -> member of the uniform block."""
    found = dict(BODY)
    by_name = {path: name for name, path in shading.paths.items()}
    for slot in shading.material:
        # A parameter that was renamed is one value; fields of structs keep their dotted paths.
        found[by_name.get(slot.path, slot.path)] = member_name(slot.path)
    return found


def _renamed(body: tuple[ir.Stmt, ...], given: dict[str, str]) -> dict[str, str]:
    """New names for what the statements declare under names that the stages use."""
    declared = {s.name for s in ir.statements(body) if isinstance(s, ir.Let | ir.For)}
    names = dict(given)
    for name in sorted(declared & set(TAKEN)):
        number = 2
        while f"{name}_{number}" in declared or f"{name}_{number}" in names.values():
            number += 1
        names[name] = f"{name}_{number}"
    return names


def _change(variables: Names) -> Callable[[ir.Expr], ir.Expr]:
    """Parameters become members of the block, elements of the arrays the light at hand."""
    elements = {"light_directions": "l", "light_colours": "light"}

    def change(e: ir.Expr) -> ir.Expr:
        if isinstance(e, ir.Index) and isinstance(e.value, ir.Var) and e.value.name in elements:
            return ir.Var(e.type, elements[e.value.name])
        if isinstance(e, ir.Var) and e.name in variables:
            return ir.Var(e.type, variables[e.name])
        return e

    return change


def _with_names(body: tuple[ir.Stmt, ...], names: Names) -> tuple[ir.Stmt, ...]:
    """The statements with their declarations and assignments renamed."""

    def statement(s: ir.Stmt) -> ir.Stmt:
        match s:
            case ir.Let() | ir.Assign():
                return replace(s, name=names.get(s.name, s.name))
            case ir.If():
                return replace(s, then=_with_names(s.then, names), orelse=_with_names(s.orelse, names))
            case ir.For():
                return replace(s, name=names.get(s.name, s.name), body=_with_names(s.body, names))
            case _:
                return s

    return tuple(map(statement, body))
