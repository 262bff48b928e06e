"""Components: those of a constructed vector are its operands; vectors stay whole where all parts are used.

Plan. Each row is written in two ways: as a person may have it, and as it is left. Both become one tree, the
second without any step of this pass; the first computes what it did, bit for bit.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.ir import nodes as ir
from codegen.passes.rules.scalars import NAME
from codegen.passes.specialise import Specialised, specialise
from conformance.unit.support.sources import library_of

SEED, LANES = 20_261, 50
LEFT = {
    "f32": {
        "vec3(a, b, c).y": "b",
        "vec2(a).y": "a",
        "vec3(a, v.zx).z": "v.x",
        "vec3(v.xy, a).z": "a",
        "v.zyx.x": "v.z",
        "(v + u).zyx.yz.x": "(v + u).y",
        "f32(a)": "a",
    },
    "vec2": {
        "v.zyx.zy": "v.xy",
        "v.yx.yx": "v.xy",
        "vec3(v.xy, a).yz": "vec2(v.y, a)",
        "vec3(a, b, c).zx": "vec2(c, a)",
        "vec2(v.x, u.y)": "vec2(v.x, u.y)",
        "vec2(a, a)": "vec2(a)",
    },
    "vec3": {
        "vec3(v.x, v.y, v.z)": "v",
        "v.xyz": "v",
        "vec3(v.xy, v.z)": "v",
        "vec3(v.z, v.y, v.x)": "v.zyx",
        "vec3(vec2(a, b), c)": "vec3(a, b, c)",
        "vec3(a, a, a)": "vec3(a)",
        "vec3(a) + vec3(b)": "vec3(a + b)",
        "vec3(a) / vec3(b)": "vec3(a / b)",
        "vec3(a) * v": "a * v",
        "v * vec3(a)": "v * a",
        "v / vec3(a)": "v / a",
        "vec3(a) / v": "vec3(a) / v",
        "vec3(a) + v": "vec3(a) + v",
        "v - vec3(a)": "v - vec3(a)",
        "vec3(v.x, v.y, u.z)": "vec3(v.x, v.y, u.z)",
    },
}
ROWS = [(type_, before, after) for type_, rows in LEFT.items() for before, after in rows.items()]


def made(folder: Path, returns: str, text: str) -> tuple[Any, Specialised]:
    folder.mkdir()
    source = f"def f(v: V, u: V, a: X, b: X, c: X) -> {returns}:\n    return {text}\n"
    library = library_of(folder, source)
    return library, specialise(library, "f", new_name="g")


def returned(found: Specialised) -> list[ir.Expr]:
    return [s.value for s in found.function.body if isinstance(s, ir.Return)]


@pytest.mark.parametrize(("returns", "before", "after"), ROWS, ids=lambda x: x)
def test_components_are_moved_and_nothing_is_computed(
    returns: str, before: str, after: str, tmp_path: Path
) -> None:
    library, found = made(tmp_path / "before", returns, before)
    _, simple = made(tmp_path / "after", returns, after)
    assert returned(found) == returned(simple)
    assert not [s for s in simple.log if s.name == NAME]
    random = np.random.default_rng(SEED)
    shapes = {"v": (LANES, 3), "u": (LANES, 3), "a": (LANES,), "b": (LANES,), "c": (LANES,)}
    x = {name: random.uniform(0.5, 2.0, shape).astype(np.float32) for name, shape in shapes.items()}
    special = evaluate(library.with_functions([found.function]), "g", found.arguments(x))
    np.testing.assert_array_equal(special, evaluate(library, "f", x))
