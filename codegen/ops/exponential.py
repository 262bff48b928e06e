"""Exponentials and logarithms. Read this file as a table."""

from codegen.ops.op import Op
from codegen.ops.rules import FLOATS, same

SEE = "WGSL 15.7.4 exp, log; Vulkan GLSL.std.450; GLSL 4.7.1; OpenCL C table 7.4 (single precision)"

BUILTINS = (
    Op(
        "exp",
        same(FLOATS, 1),
        lambda m, x: m.exp(x),
        "exponential",
        ((0.5,), (-80.0,)),
        SEE,
        summary="e to the power x, componentwise; keep x in [-87, 88].",
        names=("x",),
    ),
    Op(
        "exp2",
        same(FLOATS, 1),
        lambda m, x: m.exp2(x),
        "exponential",
        ((0.5,), (-100.0,)),
        SEE,
        summary="2 to the power x, componentwise; keep x in [-126, 127].",
        names=("x",),
    ),
    Op(
        "log",
        same(FLOATS, 1),
        lambda m, x: m.log(x),
        "exponential",
        ((0.5,), (1e-30,)),
        SEE,
        summary="Natural logarithm of x > 0, componentwise.",
        names=("x",),
    ),
    Op(
        "log2",
        same(FLOATS, 1),
        lambda m, x: m.log2(x),
        "exponential",
        ((0.5,), (1e-30,)),
        SEE,
        summary="Base-2 logarithm of x > 0, componentwise.",
        names=("x",),
    ),
)
