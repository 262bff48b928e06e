"""Arrays as text: parameters, tables and elements in each language.

Plan. One function that takes an array and makes one, against lines written by hand from the specifications.
Not covered here: what arrays mean, and whether compilers take them (test_arrays.py).
"""

import pytest

from codegen.backends import dialect
from codegen.emit.stmt import StmtPrinter
from codegen.errors import Place
from codegen.ir import nodes as ir
from codegen.ir.types import F32, U32, VEC3, array_of
from codegen.ir.verify import verify
from conformance.unit.support.trees import no_function

TEXTS = {
    "glsl": (
        "float probe(vec3 l[2], uint k) {",
        "float table[2] = float[2](0.5, 0.25);",
    ),
    "wgsl": (
        "fn probe(l: array<vec3<f32>, 2>, k: u32) -> f32 {",
        "var table = array<f32, 2>(0.5, 0.25);",
    ),
    "opencl": (
        "static inline float probe(const float3 l[2], uint k) {",
        "const float table[2] = {0.5f, 0.25f};",
    ),
}
"""A parameter and a table in each language, by its specification: C passes the place of an array's first
element, which the function does not write, and makes arrays of values in braces."""


@pytest.mark.parametrize("target", TEXTS)
def test_arrays_in_every_language(target: str) -> None:
    directions, numbers = array_of(VEC3, 2), array_of(F32, 2)
    table = ir.Construct(numbers, (ir.Const(F32, 0.5), ir.Const(F32, 0.25)))
    product = ir.Binary(
        F32,
        "*",
        ir.Index(F32, ir.Var(numbers, "table"), ir.Var(U32, "k")),
        ir.Swizzle(F32, ir.Index(VEC3, ir.Var(directions, "l"), ir.Var(U32, "k")), "z"),
    )
    parameters = (ir.Parameter("l", directions, None), ir.Parameter("k", U32, None))
    body = (ir.Let("table", table), ir.Return(product))
    f = ir.Function("probe", "", "base", None, parameters, F32, body, ir.Doc("", {}), Place("", 1))
    verify(f, no_function)
    head, first, last, _ = StmtPrinter(dialect(target, None)).function(f)
    assert (head, first.strip()) == TEXTS[target]
    assert last.strip() == "return table[k] * l[k].z;"
