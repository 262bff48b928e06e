"""A function that sums over an array of lights, built by hand: sources name no arrays."""

from typing import Any

import numpy as np

from codegen.errors import Place
from codegen.ir import nodes as ir
from codegen.ir.domains import Interval, Unit
from codegen.ir.types import F32, I32, VEC3, array_of

LIGHTS = 12
LANES = 50
VECTORS = array_of(VEC3, LIGHTS, Unit())
COLOURS = array_of(VEC3, LIGHTS, Interval(0.0, 10.0))
NAME = "lambert_sum"


def element(name: str) -> ir.Expr:
    """The element that the loop has come to."""
    return ir.Index(VEC3, ir.Var(VECTORS, name), ir.Var(I32, "i"))


def lambert_sum() -> ir.Function:
    """total of max(n . l[i], 0) light[i]"""
    cosine = ir.Builtin(F32, "dot", (ir.Var(VEC3, "n"), element("l")))
    lit = ir.Builtin(F32, "max", (cosine, ir.Const(F32, 0.0)))
    total = ir.Var(VEC3, "total")
    added = ir.Binary(VEC3, "+", total, ir.Binary(VEC3, "*", lit, element("light")))
    parameters = (
        ir.Parameter("n", VEC3, Unit()),
        ir.Parameter("l", VECTORS, Unit()),
        ir.Parameter("light", COLOURS, Interval(0.0, 10.0)),
    )
    body = (
        ir.Let("total", ir.Construct(VEC3, (ir.Const(F32, 0.0),)), True),
        ir.For("i", 0, LIGHTS, (ir.Assign("total", added),)),
        ir.Return(total),
    )
    return ir.Function(
        NAME, "", "base", None, parameters, VEC3, body, ir.Doc("Sum over lights.", {}), Place("test", 1)
    )


def inputs() -> dict[str, np.ndarray[Any, np.dtype[np.float32]]]:
    """Directions and colours, LANES of them."""
    random = np.random.default_rng(3)

    def directions(*shape: int) -> np.ndarray[Any, np.dtype[np.float32]]:
        a = random.normal(size=(*shape, 3))
        return np.asarray(a / np.linalg.norm(a, axis=-1, keepdims=True), np.float32)

    light = random.uniform(0.0, 10.0, (LANES, LIGHTS, 3)).astype(np.float32)
    return {"n": directions(LANES), "l": directions(LANES, LIGHTS), "light": light}
