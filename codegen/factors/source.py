"""Samples of a library function: its directions drawn over the hemisphere, its other parameters held."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from codegen.errors import UserError, unknown
from codegen.evaluate import evaluate
from codegen.factors.homomorphic import half_vector
from codegen.factors.samples import Samples, directions
from codegen.ir.domains import Interval
from codegen.ir.nodes import Function
from codegen.ir.types import F32, VEC3
from codegen.library import Library

FRAME = {"t": (1.0, 0.0, 0.0), "n": (0.0, 0.0, 1.0)}
"""Directions that belong to the surface: the tangent is x, the normal z."""
DRAWN = ("l", "v", "h")


def draw_samples(
    library: Library,
    name: str,
    settings: Mapping[str, float],
    count: int,
    *,
    diffuse: float = 0.0,
    seed: int = 1,
) -> Samples:
    """diffuse + (1 - diffuse) f over uniform pairs of directions above the surface, f evaluated in float64.

    settings  values of the parameters that are no direction of the frame

    raises    UserError for a function that is no reflectance, a missing or unknown parameter, or a value
              outside its domain
    """
    function = library.function(name)
    _check(function, settings, diffuse)
    l, v = directions(count, seed)  # the library's name
    drawn = {"l": l, "v": v, "h": half_vector(l, v)}
    inputs = {}
    for parameter in function.parameters:
        if parameter.name in drawn:
            inputs[parameter.name] = drawn[parameter.name]
        elif parameter.name in FRAME:
            inputs[parameter.name] = np.broadcast_to(np.array(FRAME[parameter.name]), l.shape)
        else:
            inputs[parameter.name] = np.full(count, settings[parameter.name])
    value = np.asarray(evaluate(library, name, inputs, "float64"), np.float64).reshape(count, -1)
    return Samples(l, v, diffuse + (1.0 - diffuse) * value)


def _check(function: Function, settings: Mapping[str, float], diffuse: float) -> None:
    if function.returns not in (F32, VEC3) or not any(p.name in DRAWN for p in function.parameters):
        raise UserError(f"{function.name} is no reflectance: it returns no number or colour of l and v, or h")
    open_ = {p.name: p for p in function.parameters if p.name not in (*DRAWN, *FRAME)}
    for name in settings:
        if name not in open_:
            raise unknown(f"parameter of {function.name}", name, open_)
    for name, parameter in open_.items():
        if parameter.type != F32:
            raise UserError(
                f"{function.name}: {name} is no number; only functions of directions and numbers fit"
            )
        if name not in settings:
            raise UserError(f"{function.name} needs a value of {name}: --set {name}=...")
        domain, value = parameter.domain, settings[name]
        if isinstance(domain, Interval) and not domain.low <= value <= domain.high:
            raise UserError(f"{function.name}: {name} = {value:g} is not {domain.describe()}")
    if not 0.0 <= diffuse < 1.0:
        raise UserError(f"--diffuse {diffuse:g}: the constant part is in [0, 1)")
