"""Arithmetic, comparisons, logic, and the built-ins that stay close to them. Read this file as a table."""

from codegen.ir.types import BOOL, I32
from codegen.ops.op import Op
from codegen.ops.rules import FLOATS, INTS, UINTS, arithmetic, comparison, division, same, scaling

SEE = "WGSL 15.7.4; Vulkan: Precision of Individual Operations; GLSL 4.7.1; OpenCL C 7.4"

OPERATORS = (
    Op("+", arithmetic(), lambda m, a, b: a + b, "add", ((0.1, 0.2),), SEE),
    Op("-", arithmetic(), lambda m, a, b: a - b, "add", ((0.3, 0.1),), SEE),
    Op("*", (*arithmetic(), *scaling()), lambda m, a, b: a * b, "multiply", ((0.1, 3.0),), SEE),
    Op(
        "/",
        division(),
        lambda m, a, b: m.divide(a, b),
        "divide",
        ((1.0, 3.0),),
        SEE,
    ),
    Op("negate", same((*FLOATS, I32), 1), lambda m, a: -a, "free", ((1.5,),), SEE),
    Op("<", comparison((*FLOATS[:1], *INTS)), lambda m, a, b: a < b, "add", ((1.0, 2.0),), SEE),
    Op("<=", comparison((*FLOATS[:1], *INTS)), lambda m, a, b: a <= b, "add", ((1.0, 1.0),), SEE),
    Op(">", comparison((*FLOATS[:1], *INTS)), lambda m, a, b: a > b, "add", ((1.0, 2.0),), SEE),
    Op(">=", comparison((*FLOATS[:1], *INTS)), lambda m, a, b: a >= b, "add", ((1.0, 1.0),), SEE),
    Op("==", comparison((*FLOATS[:1], *INTS)), lambda m, a, b: a == b, "add", ((1.0, 1.0),), SEE),
    Op("!=", comparison((*FLOATS[:1], *INTS)), lambda m, a, b: a != b, "add", ((1.0, 1.0),), SEE),
    Op("and", same((BOOL,), 2), lambda m, a, b: m.logical_and(a, b), "free", ((True, False),), SEE),
    Op("or", same((BOOL,), 2), lambda m, a, b: m.logical_or(a, b), "free", ((True, False),), SEE),
    Op("not", same((BOOL,), 1), lambda m, a: m.logical_not(a), "free", ((True,),), SEE),
)

BUILTINS = (
    Op(
        "abs",
        same(FLOATS, 1),
        lambda m, x: m.abs(x),
        "free",
        ((-1.5,),),
        SEE,
        summary="Absolute value, componentwise.",
        names=("x",),
        spell={"opencl": "fabs"},
    ),
    Op(
        "min",
        same((*FLOATS, *INTS, *UINTS[1:]), 2),
        lambda m, x, y: m.minimum(x, y),
        "add",
        ((1.0, 2.0),),
        SEE,
        summary="Smaller of two values, componentwise.",
        names=("x", "y"),
    ),
    Op(
        "max",
        same((*FLOATS, *INTS, *UINTS[1:]), 2),
        lambda m, x, y: m.maximum(x, y),
        "add",
        ((1.0, 2.0),),
        SEE,
        summary="Larger of two values, componentwise.",
        names=("x", "y"),
    ),
    Op(
        "clamp",
        same((*FLOATS, *INTS), 3),
        lambda m, x, low, high: m.minimum(m.maximum(x, low), high),
        "add",
        ((2.0, 0.0, 1.0),),
        SEE,
        summary="min(max(x, low), high), componentwise; low <= high.",
        names=("x", "low", "high"),
    ),
    Op(
        "floor",
        same(FLOATS, 1),
        lambda m, x: m.floor(x),
        "add",
        ((1.5,), (-0.25,)),
        SEE,
        summary="Largest integer not above x, componentwise.",
        names=("x",),
    ),
    Op(
        "sqrt",
        same(FLOATS, 1),
        lambda m, x: m.sqrt(x),
        "root",
        ((2.0,), (0.0,)),
        SEE,
        summary="Square root of x >= 0, componentwise.",
        names=("x",),
    ),
    Op(
        "inverse_sqrt",
        same(FLOATS, 1),
        lambda m, x: m.divide(1, m.sqrt(x)),
        "root",
        ((2.0,),),
        SEE,
        summary="1 / sqrt(x) for x > 0, componentwise.",
        names=("x",),
        spell={"glsl": "inversesqrt", "wgsl": "inverseSqrt", "opencl": "rsqrt"},
    ),
)
