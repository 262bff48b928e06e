"""Any shading function of the library as the lighting of fur: what its parameters are bound to.

Directions and the light come from the stage; everything else is a material that the host sets, a member of
the uniform block each.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from codegen.emit import wrap
from codegen.emit.dialect import Dialect
from codegen.emit.expr import ExprPrinter
from codegen.errors import UserError
from codegen.fur.layout import LEAST_LIGHTS
from codegen.ir import nodes as ir
from codegen.ir.types import F32, VEC3, Scalar, Struct, Type, Vector
from codegen.library import Library
from codegen.passes.specialise import specialise

FROM_STAGE = ("n", "t", "l", "v", "h", "light")
SCALED = {"coat.density": "density_share", "coat.hair_length": "length_share"}
"""Properties of the coat that vertices may scale, and the variable of the stage that does."""
HALF_VECTOR = "half_vector"


@dataclass(frozen=True)
class Slot:
    """One member of the material.

    path  as scenes name it: the parameter, dotted for a field of a struct
    name  in the uniform block
    """

    path: str
    name: str
    type: Scalar | Vector


@dataclass(frozen=True)
class FurShading:
    """A shading function ready to be called by a stage.

    paths     parameter -> what it is called in scenes, where that is not its own name
    lights    how many lights the uniform block holds
    shadowed  whether vertices say which share of the lights arrives at them
    block     what the stages call their uniform block
    known     what is folded into the loop over the lights, see codegen.fur.radiance
    """

    function: ir.Function
    material: tuple[Slot, ...]
    paths: Mapping[str, str] = field(default_factory=dict)
    lights: int = LEAST_LIGHTS
    shadowed: bool = False
    block: str = "fur"
    known: Mapping[str, Any] = field(default_factory=dict)

    @property
    def whole(self) -> bool:
        """Whether the coat is known to be everywhere equally long and dense."""
        return all(self.known.get(share) == 1.0 for share in SCALED.values())

    def statements(self, dialect: Dialect, prefix: str) -> list[str]:
        """Statements that leave in `reflected` what the function sends to the eye of one light.

        They use n, t, l, v, light, length_share and density_share of the stage.
        """
        printer = ExprPrinter(dialect)
        names = {p.name for p in self.function.parameters}
        lines: list[str] = []

        def let(name: str, type_: str, value: str) -> list[str]:
            head = f"let {name}" if dialect.declaration == "name: type" else f"{type_} {name}"
            return wrap.code(f"{head} = {value};", "")

        vec3 = dialect.types["vec3"]
        if "h" in names:
            lines += let("h", vec3, f"{prefix}{HALF_VECTOR}(l, v)")
        args: list[ir.Expr] = []
        for p in self.function.parameters:
            argument = self._argument(p.name, p.type, self.paths.get(p.name, p.name), prefix)
            if isinstance(argument, ir.Construct):
                lines += let(p.name, argument.type.name, printer.show(argument))
                argument = ir.Var(argument.type, p.name)
            args.append(argument)
        value = printer.show(ir.Call(VEC3, prefix + self.function.name, tuple(args)))
        return [*lines, *let("reflected", vec3, value if "light" in names else f"light * {value}")]

    def members(self, dialect: Dialect) -> list[str]:
        """The material's members of the uniform block."""
        types = dialect.types
        if dialect.declaration == "name: type":
            return [f"{slot.name}: {types[slot.type.name]}," for slot in self.material]
        return [f"{types[slot.type.name]} {slot.name};" for slot in self.material]

    def _argument(self, name: str, type_: Type, path: str, prefix: str) -> ir.Expr:
        if path in FROM_STAGE:
            return ir.Var(type_, name)
        if isinstance(type_, Struct):
            fields = tuple(self._argument(f.name, f.type, f"{path}.{f.name}", prefix) for f in type_.fields)
            return ir.Construct(Struct(prefix + type_.name, type_.fields), fields)
        member = ir.Var(type_, f"{self.block}.{member_name(path)}")
        if path in SCALED:
            return ir.Binary(F32, "*", member, ir.Var(F32, SCALED[path]))
        return member


def member_name(path: str) -> str:
    """The uniform member of a parameter."""
    return f"shade_{path.replace('.', '_')}"


def fixed_shading(
    library: Library, shading: FurShading, material: Mapping[str, Any], painted: bool
) -> tuple[Library, FurShading]:
    """The lighting of fur with a scene's parameters folded in, and the library that has it.

    material  value by path, as the scene states it
    painted   whether vertices scale length and density, which then stay members of the uniform block
    """
    constants = {path: value for path, value in material.items() if not (painted and path in SCALED)}
    made = specialise(library, shading.function.name, constants, new_name=f"{shading.function.name}_fixed")
    extended = library.with_functions([made.function])
    paths = {name: path for path, name in made.parameters.items()}
    folded = fur_shading(extended, made.function.name, paths)
    return extended, folded_into(folded, shading, painted)


def folded_into(
    folded: FurShading, shading: FurShading, painted: bool, known: Mapping[str, Any] | None = None
) -> FurShading:
    """A folded lighting with the lights of the one it was made of, and what else is known of the coat."""
    shares = {} if painted else dict.fromkeys(SCALED.values(), 1.0)
    return replace(
        folded, lights=shading.lights, shadowed=shading.shadowed, known={**shares, **(known or {})}
    )


def strand_shading(library: Library, name: str) -> FurShading:
    """The lighting of strands by a function of the library; raises UserError as fur_shading does."""
    shading = fur_shading(library, name, kind="strands")
    for slot in shading.material:
        if slot.path in SCALED:
            raise UserError(f'{name} cannot shade strands: a strand has no "{slot.path}"')
    return replace(shading, block="hair")


def fur_shading(
    library: Library, name: str, paths: Mapping[str, str] | None = None, kind: str = "fur"
) -> FurShading:
    """The lighting of fur by a function of the library.

    paths   parameter -> what it is called in scenes, where that is not its own name
    errors  UserError for an unknown name, and for functions that need what a coat does not have
    """
    paths = paths or {}
    function = library.function(name)
    if function.returns != VEC3:
        raise UserError(f"{name} cannot shade {kind}: it returns no colour")
    slots = []

    def visit(path: str, type_: Type) -> None:
        if path in FROM_STAGE:
            return
        if isinstance(type_, Struct):
            for part in type_.fields:
                visit(f"{path}.{part.name}", part.type)
        elif isinstance(type_, Scalar | Vector) and path != "map_tangent":
            slots.append(Slot(path, member_name(path), type_))
        else:
            owner = "coat" if kind == "fur" else "strand"
            raise UserError(f'{name} cannot shade {kind}: a {owner} has no "{path}"')

    for parameter in function.parameters:
        visit(paths.get(parameter.name, parameter.name), parameter.type)
    return FurShading(function, tuple(slots), paths)
