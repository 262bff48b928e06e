"""Loops evaluated all iterations at once give the bits of one iteration after the other.

Plan.
  scene   a general function with two loops over arrays of lights, with a memory and without
  forms   sums, products, a number of the iteration, a value that is carried and used, a branch inside, an
          assigned local, what is the same in every iteration, a call: whatever is taken apart and what is not
  lookups likewise
  apart   which of these loops are taken apart
  returns a loop that returns ends, in all lanes or in some
  lanes   where a parameter ends a loop, every lane runs as often as its own number says, also in a branch and
          where some have returned
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.evaluate.interpreter import Frame
from codegen.evaluate.loops import together
from codegen.evaluate.memory import Memory
from codegen.ir import nodes as ir
from codegen.library import Library, load_library
from codegen.scene.description.document import read_scene
from codegen.scene.general import general_function
from codegen.scene.proof.points import draw as scene_points
from conformance.textures.maps import chain
from conformance.unit.support.sources import library_of

LIBRARY = load_library()
COUNT = 40
LOOPS = '[shade]\nmodel = "fakefur"\n[lights]\ndirectional = 5\npoint = 6\n'
FORMS = {
    "sum": ("total = total + sin(x * f32(i))", True),
    "two": ("a = x * f32(i)\n        total = total + a\n        other = other + total * a", True),
    "product": ("total = (total + x) * (f32(i) - y)", True),
    "carried": ("a = sin(total)\n        total = a + x", False),
    "branch": ("if x > f32(i):\n            total = total + y", False),
    "shared": ("a = sin(y)\n        total = total + a * f32(i) + cos(y)", True),
    "loop in a call": ("total = total + powers(x * f32(i))", True),
    "call": ("total = total + term(x * f32(i), y, vec3(x, y, 1.0)) * term(y, x, vec3(f32(i)))", True),
}
"""A loop's body, and whether it is taken apart."""


CALLED = """@helper
def term(a: X, b: X, v: V) -> f32:
    if a < 1.0:
        return b
    total = dot(v.zyx, vec3(a, v.xy))
    for k in range(3):
        total = total * v.y + f32(k)
    if b > a:
        total = total - a
    return total if a > 3.0 else cross(v, vec3(b)).z


@helper
def powers(a: X) -> f32:
    total = 0.0
    for k in range(4):
        total = total * 0.5 + a * f32(k)
    return total


"""
"""A function with branches, an early return, a loop and vectors, some of them the same in every iteration."""


def source(body: str) -> str:
    return CALLED + (
        "def probe(x: X, y: X) -> f32:\n    total = 1.0\n    other = y\n"
        f"    for i in range(2, 7):\n        {body}\n    return total + 0.5 * other\n"
    )


def both(
    monkeypatch: pytest.MonkeyPatch, library: Library, name: str, inputs: Any, memory: bool
) -> list[bytes]:
    found = []
    for apart in (True, False):
        monkeypatch.setattr(Frame, "takes_loops_apart", apart)
        value = evaluate(library, name, inputs, memory=Memory() if memory else None)
        found.append(np.ascontiguousarray(value).tobytes())
    return found


@pytest.mark.parametrize("memory", [True, False])
def test_scene_with_loops_over_lights(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, memory: bool) -> None:
    (tmp_path / "scene.toml").write_text(LOOPS, encoding="utf-8")
    scene = read_scene(tmp_path / "scene.toml", LIBRARY)
    general = general_function(scene)
    library = LIBRARY.with_functions([general.function])
    loops = [s for s in ir.statements(general.function.body) if isinstance(s, ir.For)]
    assert len(loops) == 2
    assert all(together(s) for s in loops)
    inputs = scene_points(scene, general, COUNT).inputs
    one, other = both(monkeypatch, library, general.function.name, inputs, memory)
    assert one == other


@pytest.mark.parametrize("memory", [True, False])
@pytest.mark.parametrize("form", FORMS)
def test_forms_of_loops(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, form: str, memory: bool) -> None:
    body, apart = FORMS[form]
    library = library_of(tmp_path, source(body))
    (loop,) = [s for s in ir.statements(library.function("probe").body) if isinstance(s, ir.For)]
    assert (together(loop) is not None) == apart
    generator = np.random.default_rng(5)
    inputs = {name: generator.uniform(-4.0, 8.0, COUNT).astype(np.float32) for name in "xy"}
    one, other = both(monkeypatch, library, "probe", inputs, memory)
    assert one == other


LOOKED_UP = """def probe(t: Annotated[Texture, Edges("repeat", "clamp")], uv: P, lod: X) -> f32:
    total = 0.0
    for i in range(3):
        total = total + lookup_level(t, uv * f32(i), lod).x * lookup(t, vec2(f32(i) * 0.25)).y
        total = total + lookup_level(t, vec2(0.25, 0.5), lod * f32(i)).z
        total = total + lookup_level(t, uv, f32(i)).w
    return total


"""


@pytest.mark.parametrize("memory", [True, False])
def test_lookups_in_loops(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, memory: bool) -> None:
    """At places and levels that are the same in all lanes, in all iterations, or in neither."""
    library = library_of(tmp_path, LOOKED_UP)
    (loop,) = [s for s in ir.statements(library.function("probe").body) if isinstance(s, ir.For)]
    assert together(loop)
    generator = np.random.default_rng(5)
    inputs = {
        "t": chain(8, 4, 3, 7),
        "uv": generator.uniform(-1.0, 2.0, (COUNT, 2)).astype(np.float32),
        "lod": generator.uniform(0.0, 2.0, COUNT).astype(np.float32),
    }
    one, other = both(monkeypatch, library, "probe", inputs, memory)
    assert one == other


RETURNS = """def f(x: X, y: X) -> f32:
    for i in range(3):
        return x + f32(i)
    return y


def directed(x: X, y: X) -> f32:
    v = vec_of(x, y)
    return v.x + v.y * 10.0


@helper
def vec_of(x: X, y: X) -> vec2:
    for i in range(3):
        return vec2(x + f32(i), y)
    return vec2(y)


def g(x: X, y: X) -> f32:
    for i in range(3):
        if x > f32(i):
            return y + f32(i)
        y2 = x
        for k in range(2):
            return y2 - f32(i + k)
    return y


"""


def test_a_loop_that_returns_ends(tmp_path: Path) -> None:
    """What would come after a return changes nothing, be it in all lanes or in some."""
    library = library_of(tmp_path, RETURNS)
    inputs = {"x": np.array([-1.0, 0.5, 3.0], np.float32), "y": np.array([8.0, 9.0, 7.0], np.float32)}
    for memory in (None, Memory()):
        for name, expected in (
            ("f", [-1.0, 0.5, 3.0]),
            ("directed", [79.0, 90.5, 73.0]),
            ("g", [-1.0, 9.0, 7.0]),
        ):
            found: Any = evaluate(library, name, inputs, memory=memory)
            assert found.tolist() == expected


LANES = """def f(x: X, n: u32, inside: bool) -> f32:
    total = x
    if inside:
        for k in range(3):
            total = total + f32(k) * 0.25
        for i in range(min(n, 2)):
            total = total + 0.125
    for i in range(min(n, 6)):
        total = total * 2.0 + f32(i)
        if total > 50.0:
            return -total
    if inside:
        for i in range(min(n, 3)):
            total = total + f32(i) + 0.5
        for k in range(2):
            total = total - f32(k) * x
    return total


"""


def one_lane(x: float, n: int, inside: bool) -> float:
    """What LANES says, as Python says it; its numbers are exact."""
    total = x
    if inside:
        for k in range(3):
            total += k * 0.25
        for _ in range(min(n, 2)):
            total += 0.125
    for i in range(min(n, 6)):
        total = total * 2.0 + i
        if total > 50.0:
            return -total
    if inside:
        for i in range(min(n, 3)):
            total += i + 0.5
        for k in range(2):
            total -= k * x
    return total


def test_each_lane_runs_as_often_as_its_own_number_says(tmp_path: Path) -> None:
    library = library_of(tmp_path, LANES)
    lanes = [(x, n, inside) for x in (-1.0, 0.5, 3.0) for n in range(9) for inside in (False, True)]
    x, n, inside = (np.array(column) for column in zip(*lanes, strict=True))
    inputs = {"x": x.astype(np.float32), "n": n.astype(np.uint32), "inside": inside}
    expected = [one_lane(*lane) for lane in lanes]
    assert len(set(expected)) > len(lanes) // 3
    for memory in (None, Memory()):
        np.testing.assert_array_equal(np.asarray(evaluate(library, "f", inputs, memory=memory)), expected)


@pytest.mark.parametrize("most", [0, 1, 3])
def test_loops_run_as_long_as_the_lanes_that_take_part(most: int, tmp_path: Path) -> None:
    """Be it longer or shorter than the numbers of those that do not; and without any lane."""
    library = library_of(tmp_path, LANES)
    lanes = [(0.5, most, True), (0.5, 3 - most, False), (-1.0, most, True)]
    for some in (lanes, lanes[:1], lanes[1:2], []):
        x, n, inside = (np.array([lane[k] for lane in some]) for k in range(3))
        inputs = {"x": x.astype(np.float32), "n": n.astype(np.uint32), "inside": inside.astype(bool)}
        found: Any = evaluate(library, "f", inputs)
        assert found.tolist() == [one_lane(*lane) for lane in some]
