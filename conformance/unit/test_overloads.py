"""Which types every operation takes, and what comes of them: the type rules written a second time.

Plan.
  overloads  of every row, by the names of the types, as its row in WGSL's and GLSL's tables has them
  halves     follow those of f32; they do not mix with f32, and have no bits to look at
"""

from __future__ import annotations

from itertools import product

import pytest

from codegen.ir.types import F16, F32, HVEC2, HVEC3, HVEC4, U32, VALUE_TYPES, VEC2, VEC3, VEC4, Type
from codegen.ops import BUILTINS, OPERATORS

FLOATS, VECTORS = "f32 vec2 vec3 vec4", "vec2 vec3 vec4"
WORDS, WORD_VECTORS = "u32 uvec2 uvec3", "uvec2 uvec3"


def same(types: str, count: int) -> set[str]:
    """So many operands of one type, and that type."""
    return {f"{' '.join([t] * count)} -> {t}" for t in types.split()}


def to(result: str, types: str, count: int) -> set[str]:
    """So many operands of one type, and another type."""
    return {f"{' '.join([t] * count)} -> {result}" for t in types.split()}


SCALED = {f"{v} f32 -> {v}" for v in VECTORS.split()}, {f"f32 {v} -> {v}" for v in VECTORS.split()}
SCALED_WORDS = {t for v in WORD_VECTORS.split() for t in (f"{v} u32 -> {v}", f"u32 {v} -> {v}")}
OVERLOADS: dict[str, set[str]] = {
    **dict.fromkeys(("+", "-"), same(f"{FLOATS} i32 {WORDS}", 2)),
    "*": same(f"{FLOATS} i32 {WORDS}", 2) | SCALED[0] | SCALED[1] | SCALED_WORDS,
    "/": same(FLOATS, 2) | SCALED[0],
    "negate": same(f"{FLOATS} i32", 1),
    **dict.fromkeys(("<", "<=", ">", ">=", "==", "!="), to("bool", "f32 i32 u32", 2)),
    **dict.fromkeys(("and", "or"), same("bool", 2)),
    "not": same("bool", 1),
    **dict.fromkeys(("//", "%", "<<", ">>"), same("u32", 2)),
    **dict.fromkeys(("&", "|", "^"), same(WORDS, 2)),
    "~": same(WORDS, 1),
    **dict.fromkeys(("abs", "floor", "sqrt", "inverse_sqrt", "exp", "exp2"), same(FLOATS, 1)),
    **dict.fromkeys(("log", "log2", "sin", "cos"), same(FLOATS, 1)),
    "atan2": same(FLOATS, 2),
    **dict.fromkeys(("min", "max"), same(f"{FLOATS} i32 {WORDS}", 2)),
    "clamp": same(f"{FLOATS} i32 u32", 3),
    "float_to_bits": {"f32 -> u32"},
    "bits_to_float": {"u32 -> f32"},
    "dot": to("f32", VECTORS, 2),
    "length": to("f32", VECTORS, 1),
    "normalize": same(VECTORS, 1),
    "cross": same("vec3", 2),
    "lookup": {"Texture vec2 -> vec4"},
    "lookup_level": {"Texture vec2 f32 -> vec4"},
    "texture_size": {"Texture -> vec2"},
}
ROWS = {**OPERATORS, **BUILTINS}


def test_every_row_has_its_overloads() -> None:
    found = {
        name: {f"{' '.join(t.name for t in types)} -> {result.name}" for types, result in row.rule}
        for name, row in ROWS.items()
    }
    assert found == OVERLOADS


HALVES: dict[Type, Type] = {F32: F16, VEC2: HVEC2, VEC3: HVEC3, VEC4: HVEC4}


@pytest.mark.parametrize("name", ROWS)
def test_halves_follow_floats(name: str) -> None:
    """Operands of all combinations of types, each float of which becomes a half; and all but the last."""
    row = ROWS[name]
    count = len(row.rule[0][0])
    for types in product(VALUE_TYPES.values(), repeat=count):
        halved = tuple(HALVES.get(t, t) for t in types)
        if halved == types:
            continue
        single = row.result(types)
        if name == "float_to_bits":
            assert row.result(halved) is None
        else:
            assert row.result(halved) == (None if single is None else HALVES.get(single, single))
        if count > 1 and halved[-1] != types[-1] and halved[:-1] != types[:-1]:
            assert row.result((*halved[:-1], types[-1])) is None


def test_whole_numbers_have_the_bits_of_floats_only() -> None:
    assert BUILTINS["float_to_bits"].result((F16,)) is None
    assert BUILTINS["bits_to_float"].result((U32,)) == F32
