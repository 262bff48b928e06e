"""Rays that meet the shells see the fur that rasterisers draw: a second path, on backends that draw nothing.

Plan.
  drawn       the rays' picture by the evaluator against OpenGL's, both examples, density painted
  backends    OpenCL and the evaluator in float32 and float64 give one picture
  converging  with more layers the picture comes closer to that of many layers
  pieces      turns of one ray keep the order of the triangles; the first meeting is the nearest
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.library import load_library
from conformance.picture.backends import open_backend
from conformance.picture.fur.draw import draw_fur
from conformance.picture.fur.march import Hits, March, _first, _turns
from conformance.picture.fur.studio import FurStudio, set_up_fur
from conformance.picture.tolerances import tolerance
from conformance.picture.tone import steps_apart
from conformance.unit.support.drivers import need
from targets import TargetUnavailable, probe

SCENES = Path(__file__).parents[3] / "examples" / "scenes"
LIBRARY = load_library()


def studio(name: str, side: int, **coat: Any) -> FurStudio:
    made = set_up_fur(LIBRARY, SCENES / f"{name}.toml", size=(side, side), supersample=1, subdivide=0)
    return replace(made, fur=replace(made.fur, **coat))


def marched(made: FurStudio, backend: str) -> np.ndarray:
    return March(made, open_backend(backend, LIBRARY)).draw()[..., :3].astype(np.float64)


@pytest.mark.parametrize("name", ["furry-bunny", "shell-lit-bunny"])
def test_rays_see_what_opengl_draws(name: str) -> None:
    need("glsl")
    made = studio(name, 64, layers=6)
    paint = made.mesh.vertices["position"][:, 0] * 0.05 + 0.5
    vertices = made.mesh.vertices.copy()
    vertices["density_share"] = np.clip(paint, 0.0, 1.0)
    made = replace(made, mesh=replace(made.mesh, vertices=vertices))
    drawn = draw_fur(made, "glsl")[0][..., :3].astype(np.float64)
    steps = steps_apart(drawn, marched(made, "numpy32"))
    assert drawn.max() > 0.1
    assert steps.mean() < tolerance("fur_mean_steps")
    assert (steps.max(axis=2) < tolerance("fur_pixel_steps")).mean() > tolerance("fur_march_share")


def test_backends_that_draw_nothing_agree() -> None:
    made = studio("furry-bunny", 40, layers=3)
    reference = marched(made, "numpy")
    assert reference.max() > 0.1
    backends = ["numpy32"]
    if not isinstance(probe("opencl"), TargetUnavailable):
        backends.append("opencl")
    for backend in backends:
        assert steps_apart(marched(made, backend), reference).max() < tolerance("backend_steps")


def test_more_layers_come_closer_to_many() -> None:
    many = studio("shell-lit-bunny", 28, layers=17, fins=False)
    goal = marched(many, "numpy32")
    apart = []
    for layers in (3, 5, 9):
        coat = replace(many.fur, layers=layers)
        apart.append(steps_apart(marched(replace(many, fur=coat), "numpy32"), goal).mean())
    assert apart == sorted(apart, reverse=True)
    assert apart[-1] < tolerance("fur_layers") * apart[0]


def test_turns_keep_the_order_of_the_triangles() -> None:
    ray, triangle = np.array([5, 2, 5, 9, 5, 2]), np.array([7, 1, 3, 0, 4, 0])
    turns = _turns(ray, triangle)
    assert [sorted(zip(ray[t].tolist(), triangle[t].tolist(), strict=True)) for t in turns] == [
        [(2, 0), (5, 3), (9, 0)],
        [(2, 1), (5, 4)],
        [(5, 7)],
    ]
    assert _turns(ray[:0], triangle[:0]) == []


def test_the_first_meeting_is_the_nearest() -> None:
    hits = Hits(np.array([1, 0, 1]), np.array([4, 5, 6]), np.array([3.0, 1.0, 2.0]), np.eye(3))
    first = _first(hits)
    assert (first.ray.tolist(), first.triangle.tolist()) == ([0, 1], [5, 6])
    assert np.array_equal(first.weights, np.eye(3)[[1, 2]])
