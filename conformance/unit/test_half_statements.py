"""Half forms of every kind of statement and expression compute what the source says.

Plan. Small dyadic inputs, on which every operation is exact in half precision: half forms give the results
of the source in float32, bit for bit, also where some parameters stay f32; every version is well-formed, and
what is no longer f32 is f16. Values that only f32 holds show where f32 is kept.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.ir import nodes as ir
from codegen.ir.types import F16, F32, HVEC3, VEC3, element_of
from codegen.ir.verify import verify
from codegen.library import Library
from codegen.passes.half import HalfRules, half_structs, half_versions
from conformance.unit.support.sources import library_of

PAIR = '@struct\nclass Pair:\n    """A pair."""\n    first: X\n    second: V\n'
SQUARE = (
    "@helper\ndef square(x: X) -> f32:\n    return x * x\n"
    "@helper\ndef fourth(x: X) -> f32:\n    return square(square(x))\n"
    "@helper\ndef times(x: X, n: u32) -> f32:\n    return x * x * f32(n)\n"
)
BODIES = {
    "assignments": "    y = x\n    y = y + k\n    y += 0.5\n    return y - 2.0 * x\n",
    "branches": (
        "    y = x\n    if x > k:\n        y = k\n        z = 2.0 * y\n        y = z\n"
        "    elif x > 0.5:\n        y = 0.25\n    return y\n"
    ),
    "returns": "    if x < 0.0:\n        return 1.0\n    if k < x:\n        return k\n    return 0.0\n",
    "loop": "    y = x\n    for i in range(1, 4):\n        y = y + k * f32(i)\n    return y\n",
    "loop with an end": "    y = x\n    for i in range(min(n, 3)):\n        y = y + k\n    return y\n",
    "nested": (
        "    y = 0.0\n    for i in range(2):\n        for j in range(2):\n            if i == j:\n"
        "                y = y + x\n    return y\n"
    ),
    "choice": "    return x if x > k else (1.0 if n > 1 else k)\n",
    "structs": "    pair = Pair(x, vec3(k, 0.5, x))\n    return pair.first + pair.second.y - pair.second.x\n",
    "calls": "    return square(x) - square(square(k) * 0.25)\n",
    "bits": "    return bits_to_float(float_to_bits(x)) + k\n",
    "whole numbers": "    return x + f32(n) - f32(u32(abs(k)))\n",
    "vectors": "    a = vec3(x, k, 1.0)\n    b = a.zxy * 2.0 - vec3(x)\n    return dot(a, b) + b.x\n",
    "comparisons": "    high = x >= k and not x == 1.0 or n == 2\n    return 1.0 if high else -1.0\n",
    "extremes": "    return clamp(x, -1.0, k) if k > -1.0 else min(max(x, 0.5), abs(k)) + floor(x)\n",
    "literals": "    y = 0.5\n    z = 1.5 if n > 0 else 2.0\n    return y * z * x\n",
}
KEPT: dict[str, frozenset[str]] = {
    "": frozenset(),
    "x": frozenset("x"),
    "k": frozenset("k"),
    "both": frozenset("xk"),
}


def library(folder: Path, body: str) -> Library:
    return library_of(folder, f"{PAIR}{SQUARE}def f(x: X, k: X, n: u32) -> f32:\n{body}")


def checked(made: Library, rules: HalfRules) -> ir.Function:
    """The half form of f, after looking whether all versions are well formed."""
    seen: dict[str, Any] = {}
    for version in half_versions(made, ["f"], rules):
        verify(version.function, seen.get)
        seen[version.function.name] = (
            tuple(p.type for p in version.function.parameters),
            version.function.returns,
        )
    return version.function


@pytest.mark.parametrize("kept", KEPT)
@pytest.mark.parametrize("name", BODIES)
def test_half_form_computes_what_the_source_says(name: str, kept: str, tmp_path: Path) -> None:
    made = library(tmp_path, BODIES[name])
    rules = HalfRules({}, {"f": KEPT[kept]})
    f = checked(made, rules)
    assert f.returns == F16
    assert {p.name for p in f.parameters if element_of(p.type) == F32} == KEPT[kept]
    steps = np.arange(-4, 5) / 2.0
    x, k, n = (a.ravel() for a in np.meshgrid(steps, steps, np.arange(5)))
    inputs = {"x": x.astype(np.float32), "k": k.astype(np.float32), "n": n.astype(np.uint32)}
    wanted = evaluate(made, "f", inputs)
    assert isinstance(wanted, np.ndarray)
    assert len(np.unique(wanted)) > 1
    for arithmetic in ("float16", "float16-strict"):
        got = evaluate(made, "f", inputs, arithmetic, rules=rules)
        assert isinstance(got, np.ndarray)
        np.testing.assert_array_equal(got.astype(np.float32), wanted)


LARGE = {
    "operation": ("    return (x * x) / x\n", True),
    "local": ("    y = x * x\n    return y / x\n", True),
    "call": ("    return square(x) / x\n", True),
    "call with a count": ("    return times(x, n) / x\n", True),
    "call in a call": ("    return fourth(x) / (x * square(x))\n", True),
    "choice": ("    return (x * x if x > 0.0 else x) / x\n", True),
    "beside a half": ("    return (x * x + k) / x\n", False),
    "bits": ("    return bits_to_float(float_to_bits(x * x)) / x\n", True),
}
"""x * x leaves the halves: whether it is computed in f32 where x stays f32 and k does not."""


@pytest.mark.parametrize("name", LARGE)
def test_what_is_of_f32_alone_is_computed_in_f32(name: str, tmp_path: Path) -> None:
    body, stays = LARGE[name]
    made = library(tmp_path, body)
    rules = HalfRules({}, {"f": frozenset("x")})
    checked(made, rules)
    inputs = {"x": np.array([1000.0, 2000.0]), "k": np.array([1.0, 1.0]), "n": np.array([1, 1], np.uint32)}
    got = evaluate(made, "f", inputs, "float16", rules=rules)
    assert isinstance(got, np.ndarray)
    assert np.array_equal(got.astype(float), inputs["x"]) == stays
    assert stays or not np.isfinite(got.astype(float)).any()


def test_structs_hold_halves(tmp_path: Path) -> None:
    made = library(tmp_path, BODIES["structs"])
    (pair,) = half_structs(made.structs.values())
    assert [(f.name, f.type) for f in pair.type.fields] == [("first", F16), ("second", HVEC3)]
    assert [f.type for f in made.struct("Pair").type.fields] == [F32, VEC3]
