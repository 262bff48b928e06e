"""The plate of what each piece of fur buys: its plan fits the library, its panels differ as they should."""

import numpy as np
import pytest

from codegen.errors import UserError
from codegen.library import load_library
from conformance.bench.fur.plate import draw_in_turns, panels, read_plan
from conformance.unit.support.drivers import need


def test_every_panel_shows_something_else() -> None:
    need("glsl")
    plan = read_plan()
    made = panels(load_library(), plan, size=(40, 40), supersample=1, subdivide=0)
    assert len(made) == len(plan["panel"]) == 12
    pictures, seconds = draw_in_turns(made, "glsl", rounds=1)
    assert all(cost > 0.0 for cost in seconds)
    pairs = [(a, b) for a in range(12) for b in range(a)]
    same = [(made[a].caption, made[b].caption) for a, b in pairs if np.array_equal(pictures[a], pictures[b])]
    assert same == [("32 layers", "fake fur")]
    covered = [float((picture[..., 3] > 0.0).mean()) for picture in pictures]
    assert covered[0] == min(covered)  # the mesh alone


def test_a_panel_without_its_parameters_is_refused() -> None:
    plan = read_plan()
    panel = {"caption": "bare", "model": "kajiya_kay_shade"}
    with pytest.raises(UserError, match='panel "bare" lacks k_diffuse, k_specular, exponent'):
        panels(load_library(), {**plan, "panel": [panel]}, subdivide=0)
