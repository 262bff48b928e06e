"""The lighting of fur within an error budget: what `vair scene` finds for one light of a scene.

A coat shows its hairs at every angle, so nothing is assumed of directions, whatever [view] says of a surface.
The budget of a scene is shared evenly among its lights.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from codegen.fur.shading import SCALED, FurShading, fur_shading
from codegen.library import Library
from codegen.scene.description.document import read_scene
from codegen.scene.description.lights import Lights
from codegen.scene.description.settings import Constant, Range, Setting
from codegen.scene.general import general_function
from codegen.scene.proof.points import draw
from codegen.scene.reduction.prices import Prices
from codegen.scene.reduction.reduce import Reducer

POINTS = 12_000
"""Points over which the error is predicted."""
PRICED_ON = "glsl"
"""The stages of all targets share one function, so one target's prices decide."""


def cheaper_shading(
    library: Library,
    path: Path,
    shading: FurShading,
    material: Mapping[str, Any],
    painted: bool,
    lights: int,
    brightest: float,
) -> tuple[Library, FurShading] | None:
    """The shading function of a scene for one of its lights, as cheap as the scene's budget permits.

    path       of the scene file, which states the budget and the function
    material   value by path
    painted    whether vertices scale length and density, which then stay parameters
    lights     among which the budget is shared
    brightest  largest component of a light's colour
    returns    the function's shading, and the library that has it; None where the file asks for exactness,
               for another function than the shading is, or for less error than float32 itself has
    """
    scene = read_scene(path, library)
    if scene.budget <= 0.0 or scene.model.function.name != shading.function.name:
        return None
    settings: dict[str, Setting] = {}
    for name, value in material.items():
        numbers = tuple(float(np.float32(x)) for x in np.atleast_1d(value))
        varies = painted and name in SCALED
        settings[name] = Range((0.0,) * len(numbers), numbers) if varies else Constant(numbers)
    one = replace(
        scene,
        budget=scene.budget / max(lights, 1),
        settings=settings,
        facts={},
        lights=Lights(colour=(0.0, max(brightest, 1e-6))),
    )
    general = general_function(one)
    extended = library.with_functions([general.function])
    reducer = Reducer.of(extended, one, general, draw(one, general, POINTS))
    if one.budget < reducer.reference.rounding:
        return None
    found = reducer.reduced(Prices.of(extended, PRICED_ON), one.budget).final
    function = replace(found.function, name=f"{shading.function.name}_fixed")
    extended = library.with_functions([function])
    paths = {name: general.slots[given].path for given, name in found.parameters.items()}
    return extended, fur_shading(extended, function.name, paths)
