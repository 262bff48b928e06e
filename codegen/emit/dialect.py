"""What distinguishes one target language from another, as data; see targets/<target>/dialect.py."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from codegen.errors import UserError


@dataclass(frozen=True)
class Dialect:
    """One dialect of a target.

    target       the family: glsl, wgsl or opencl
    name         as --dialect takes it
    title        as a person says it
    extension    of an emitted file
    types        IR type name -> spelling
    precision    precision qualifier put before float and integer types ("" for none)
    qualifier    what stands before a function definition ("" for none)
    declaration  order of name and type: "type name" or "name: type"
    float_suffix of float literals
    typed_suffix of float literals in operations on literals alone, where one without it has no width and the
                 target computes in double precision ("" where literals are of single precision)
    vectors      "call": vec3(a, b), "cast": (float3)(a, b)
    structs      constructors: "call": S(a, b), "compound": (S){a, b}
    conversions  "call": float(x), "cast": (float)x
    conditional  "ternary": c ? a : b, "select": select(b, a, c)
    guard        whether definitions carry guards
    precise      qualifier of a variable whose computation may be neither reordered nor fused ("" where the
                 dialect has none)
    local        qualifier put before every local that holds floats ("" for none)
    arithmetic   of what is printed: "single", or "half" where the half pass has run
    half_precision  precision qualifier put before f16 and its vectors ("" for none)
    half_suffix  of f16 literals
    half_enable  line that a text with f16 starts with ("" for none)
    texture      a texture parameter as the parameters that stand for it: (what follows its name, type)
    lookup_library  definition of the function that lookups call, with $prefix before its names ("": built in)
    lookup       name of that function, once the prefix is known
    line_map     how a source line is stated, with {line} and {file} ("" where the target has no directive)
    """

    target: str
    name: str
    title: str
    extension: str
    types: Mapping[str, str]
    precision: str = ""
    qualifier: str = ""
    declaration: Literal["type name", "name: type"] = "type name"
    float_suffix: str = ""
    typed_suffix: str = ""
    vectors: Literal["call", "cast"] = "call"
    structs: Literal["call", "compound"] = "call"
    conversions: Literal["call", "cast"] = "call"
    conditional: Literal["ternary", "select"] = "ternary"
    guard: bool = True
    precise: str = ""
    local: str = ""
    arithmetic: Literal["single", "half"] = "single"
    half_precision: str = ""
    half_suffix: str = ""
    half_enable: str = ""
    texture: tuple[tuple[str, str], ...] = ()
    lookup_library: str = ""
    lookup: str = ""
    line_map: str = field(default="")


def file_name(dialect: Dialect, stem: str) -> str:
    """The name of a dialect's file: vair-430.glsl, vair-1.2.cl, vair.wgsl."""
    own = stem if dialect.name == dialect.target else f"{stem}-{dialect.name}"
    return f"{own}.{dialect.extension}"


def with_precise(dialect: Dialect) -> Dialect:
    """The dialect with its `precise` before every local; raises UserError where it has none."""
    if not dialect.precise:
        raise UserError(f"{dialect.title} has no precise qualifier; GLSL has one from 4.00 on")
    return replace(dialect, local=dialect.precise)


def with_half(dialect: Dialect) -> Dialect:
    """The dialect for text in half precision."""
    return replace(dialect, arithmetic="half")
