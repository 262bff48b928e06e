"""Geometric built-ins on float vectors. Read this file as a table."""

from typing import Any

from codegen.ir.types import VEC3
from codegen.ops.op import Op
from codegen.ops.rules import FLOAT_VECTORS, one, reduction, same

SEE = "WGSL 15.7.4; Vulkan GLSL.std.450; GLSL 8.5; OpenCL C 7.4 (geometric functions)"


def _dot(m: Any, a: Any, b: Any) -> Any:
    """The sum of products, first component first, every operation rounded."""
    total = a[..., 0] * b[..., 0]
    for k in range(1, a.shape[-1]):
        total = total + a[..., k] * b[..., k]
    return total


def _cross(m: Any, a: Any, b: Any) -> Any:
    ax, ay, az = (a[..., k] for k in range(3))
    bx, by, bz = (b[..., k] for k in range(3))
    return m.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-1)


BUILTINS = (
    Op(
        "dot",
        reduction(2),
        _dot,
        "multiply",
        (((0.0, 0.6, 0.8), (1.0, 0.0, 0.0)),),
        SEE,
        summary="Inner product.",
        names=("a", "b"),
        work=lambda n: {"multiply": n, "add": n - 1},
    ),
    Op(
        "cross",
        one((VEC3, VEC3), VEC3),
        _cross,
        "multiply",
        (((0.0, 0.6, 0.8), (1.0, 0.0, 0.0)),),
        SEE,
        summary="Outer product; right-handed.",
        names=("a", "b"),
        work=lambda n: {"multiply": 6, "add": 3},
    ),
    Op(
        "length",
        reduction(1),
        lambda m, x: m.sqrt(_dot(m, x, x)),
        "root",
        (((0.0, 0.6, 0.8),),),
        SEE,
        summary="Euclidean length; squares overflow above 1e19 and vanish below 1e-19.",
        names=("x",),
        work=lambda n: {"multiply": n, "add": n - 1, "root": 1},
    ),
    Op(
        "normalize",
        same(FLOAT_VECTORS, 1),
        lambda m, x: m.divide(x, m.sqrt(_dot(m, x, x))[..., None]),
        "root",
        (((0.0, 3.0, 4.0),),),
        SEE,
        summary="x / length(x); not for vectors that may be zero, see safe_normalize.",
        names=("x",),
        work=lambda n: {"multiply": n, "add": n - 1, "root": 1, "divide": n},
    ),
)
