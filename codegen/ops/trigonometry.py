"""Trigonometry, in radians. OpenGL promises nothing here. Read this file as a table."""

from codegen.ops.op import Op
from codegen.ops.rules import FLOATS, same

SEE = "WGSL 15.7.4; Vulkan GLSL.std.450; GLSL 4.7.1 (undefined precision); OpenCL C table 7.4"

BUILTINS = (
    Op(
        "sin",
        same(FLOATS, 1),
        lambda m, x: m.sin(x),
        "trigonometric",
        ((0.5,), (-3.0,)),
        SEE,
        summary="Sine, componentwise; only absolute accuracy 2^-11 in [-pi, pi] is promised.",
        names=("x",),
    ),
    Op(
        "cos",
        same(FLOATS, 1),
        lambda m, x: m.cos(x),
        "trigonometric",
        ((0.5,), (-3.0,)),
        SEE,
        summary="Cosine, componentwise; only absolute accuracy 2^-11 in [-pi, pi] is promised.",
        names=("x",),
    ),
    Op(
        "atan2",
        same(FLOATS, 2),
        lambda m, y, x: m.arctan2(y, x),
        "trigonometric",
        ((0.0, -1.0), (1.0, 2.0)),
        SEE,
        summary="Angle of the point (x, y) in [-pi, pi]; undefined at the origin.",
        names=("y", "x"),
        spell={"glsl": "atan"},
    ),
)
