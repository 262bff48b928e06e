"""Small source libraries, written for one test."""

from collections.abc import Mapping
from pathlib import Path

from codegen.library import Library

HEADER = (
    "from typing import Annotated; from shaderlib.lang import abs, atan2, bits_to_float, clamp, cos, cross, "
    "dot, exp, exp2, f32, float_to_bits, floor, i32, inverse_sqrt, length, log, log2, lookup, "
    "lookup_level, max, min, normalize, sin, sqrt, texture_size, u32, uvec2, uvec3, vec2, vec3, vec4, Edges, "
    "Finite, Interval, Length, Texture, Unit, helper, printed, "
    "struct, variant; "
    "X = Annotated[f32, Finite()]; V = Annotated[vec3, Finite()]; P = Annotated[vec2, Finite()]; "
    "Q = Annotated[vec4, Finite()]; D = Annotated[vec3, Unit()]\n"
)
"""One line, so that a test's own text starts at line 2: imports, and X V P Q D as parameter types."""

FIRST_LINE = 2


def write_library(folder: Path, files: Mapping[str, str], *, header: bool = True) -> Path:
    """Write sources below a folder, `section/name.py` -> text, each after the header; returns the folder."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"{HEADER if header else ''}{text}", encoding="utf-8")
    return folder


def library_of(folder: Path, text: str) -> Library:
    """The library of one source text."""
    return Library(write_library(folder, {"numeric/probe.py": text}))
