"""Types of the IR: scalars, vectors, structs, arrays and textures."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from codegen.ir.domains import Domain
from codegen.ir.once import hashed_once


@hashed_once
@dataclass(frozen=True, eq=False)
class Scalar:
    """A 32-bit scalar (bool: a truth value), or the 16-bit float f16."""

    name: str


@hashed_once
@dataclass(frozen=True, eq=False)
class Vector:
    """A short vector; `name` as in the source (vec3, uvec2)."""

    name: str
    element: Scalar
    size: int


@hashed_once
@dataclass(frozen=True, eq=False)
class Field:
    """One field of a struct."""

    name: str
    type: Type
    domain: Domain | None = field(compare=False, default=None)


@hashed_once
@dataclass(frozen=True, eq=False)
class Struct:
    """A struct; two structs are the same type if their names and fields agree."""

    name: str
    fields: tuple[Field, ...]

    def field(self, name: str) -> Field | None:
        """The field of that name, or None."""
        return next((f for f in self.fields if f.name == name), None)


@hashed_once
@dataclass(frozen=True, eq=False)
class Array(Struct):
    """`size` values of one scalar or vector type, told apart by a number: a struct with the fields 0, 1, ...

    Whatever handles structs field by field handles arrays. Sources name no arrays: passes and scenes make
    them, as parameters and as constants.
    """

    element: Scalar | Vector

    @property
    def size(self) -> int:
        """How many there are."""
        return len(self.fields)


@hashed_once
@dataclass(frozen=True, eq=False)
class Texture:
    """A handle of a map with its sampler: only a parameter has it, and only lookups and calls take it."""

    name: str


Type = Scalar | Vector | Struct | Texture


def array_of(element: Scalar | Vector, size: int, domain: Domain | None = None) -> Array:
    """The array type, named like vec3[8]; the domain of its elements lets them be drawn one by one."""
    fields = tuple(Field(str(k), element, domain) for k in range(size))
    return Array(f"{element.name}[{size}]", fields, element)


F32, I32, U32, BOOL = Scalar("f32"), Scalar("i32"), Scalar("u32"), Scalar("bool")
VEC2, VEC3, VEC4 = (Vector(f"vec{n}", F32, n) for n in (2, 3, 4))
UVEC2, UVEC3 = Vector("uvec2", U32, 2), Vector("uvec3", U32, 3)
TEXTURE = Texture("Texture")
F16 = Scalar("f16")
HVEC2, HVEC3, HVEC4 = (Vector(f"hvec{n}", F16, n) for n in (2, 3, 4))

VALUE_TYPES: dict[str, Scalar | Vector] = {
    t.name: t for t in (F32, I32, U32, BOOL, VEC2, VEC3, VEC4, UVEC2, UVEC3)
}


HALF_TYPES: dict[str, Scalar | Vector] = {t.name: t for t in (F16, HVEC2, HVEC3, HVEC4)}
"""Types that no source names: the pass codegen.passes.half makes them of f32 and its vectors."""

_HALVES: dict[Type, Scalar | Vector] = {F32: F16, VEC2: HVEC2, VEC3: HVEC3, VEC4: HVEC4}
_SINGLES: dict[Type, Type] = {half: single for single, half in _HALVES.items()}


def half_of(type_: Type) -> Type:
    """The type with f16 in place of f32, fields included."""
    if isinstance(type_, Array):
        return array_of(_HALVES.get(type_.element, type_.element), type_.size)
    if isinstance(type_, Struct):
        return Struct(type_.name, tuple(replace(f, type=half_of(f.type)) for f in type_.fields))
    return _HALVES.get(type_, type_)


def single_of(type_: Type) -> Type:
    """The scalar or vector type with f32 in place of f16."""
    return _SINGLES.get(type_, type_)


def element_of(type_: Type) -> Type:
    """The scalar that a vector consists of; any other type itself."""
    return type_.element if isinstance(type_, Vector) else type_


def vector_of(element: Scalar, size: int) -> Scalar | Vector | None:
    """The vector type of `size` elements (size 1: the scalar itself); None where there is none."""
    if size == 1:
        return element
    prefix = {"f32": "vec", "u32": "uvec", "f16": "hvec"}.get(element.name, "?")
    name = f"{prefix}{size}"
    return VALUE_TYPES.get(name) or HALF_TYPES.get(name)


def leaves(type_: Type, path: str = "") -> list[tuple[str, Scalar]]:
    """The scalars a value consists of, in order, with their access paths (".tangent.x", "[2].x")."""
    if isinstance(type_, Scalar):
        return [(path, type_)]
    if isinstance(type_, Texture):
        return []
    if isinstance(type_, Vector):
        return [(f"{path}.{c}", type_.element) for c in "xyzw"[: type_.size]]
    if isinstance(type_, Array):
        return [leaf for f in type_.fields for leaf in leaves(f.type, f"{path}[{f.name}]")]
    return [leaf for f in type_.fields for leaf in leaves(f.type, f"{path}.{f.name}")]
