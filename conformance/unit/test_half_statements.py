"""Half forms of every kind of statement and expression compute what the source says.

Plan. Small dyadic inputs, on which every operation is exact in half precision: half forms give the results
of the source in float32, bit for bit, also where some parameters stay f32; every version is well-formed, and
what is no longer f32 is f16. Values that only f32 holds show where f32 is kept. Constants at the ends of what
halves hold, and those that rules state; which versions are halves.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.ir import nodes as ir
from codegen.ir.types import F16, F32, HVEC3, VEC3, element_of
from codegen.ir.verify import verify
from codegen.library import Library
from codegen.passes.half import HalfRules, half_structs, half_versions
from codegen.passes.specialise import specialise
from conformance.unit.support.sources import library_of
from conformance.unit.support.trees import no_function

PAIR = '@struct\nclass Pair:\n    """A pair."""\n    first: X\n    second: V\n'
SQUARE = (
    "@helper\ndef square(x: X) -> f32:\n    return x * x\n"
    "@helper\ndef fourth(x: X) -> f32:\n    return square(square(x))\n"
    "@helper\ndef times(x: X, n: u32) -> f32:\n    return x * x * f32(n)\n"
    "@helper\ndef taken(x: X) -> f32:\n    pair = Pair(x, vec3(x))\n    return pair.first * 2.0\n"
    "@helper\ndef around(x: X) -> f32:\n    return taken(x) - 1.0\n"
    "@helper\ndef of_pair(pair: Pair, x: X) -> f32:\n    return pair.first - pair.second.z * x\n"
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
    "call of a literal": "    return x * square(2.0) + k\n",
    "call that holds a struct": "    return taken(x) * x + around(k)\n",
    "call in a call that holds a struct": "    y = around(x)\n    return y * x\n",
    "call of a struct": "    return of_pair(Pair(x, vec3(k)), x) + of_pair(Pair(x, vec3(x)), x)\n",
    "fields": "    pair = Pair(k, vec3(x))\n    return pair.first * x + pair.second.y * k\n",
    "literals alone": "    return sqrt(4.0) * x + k * max(0.5, 2.0)\n",
    "choice of truth values": "    p = x > k if n > 1 else k > 0.5\n    return x if p else -1.0\n",
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
    "choice where a half decides": ("    return (x * x if k > 0.0 else x) / x\n", True),
    "comparison": ("    return x if x * x > 80000.0 else 0.0\n", True),
    "comparison of close numbers": ("    return x if x + 0.25 > x else 0.0\n", True),
    "beside a call of a literal": ("    return (x * x * square(1.0)) / x\n", False),
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


def test_loop_that_a_float_ends(tmp_path: Path) -> None:
    """Inlining puts an argument in the place of the count that ends a loop."""
    text = (
        "@helper\ndef sum_of(x: X, n: u32) -> f32:\n    y = x\n    for i in range(min(n, 3)):\n"
        "        y = y + f32(i) * 0.5\n    return y\n"
        "def f(x: X, k: X) -> f32:\n    return sum_of(x, u32(abs(k)))\n"
    )
    given = library_of(tmp_path, text)
    inlined = given.with_functions([specialise(given, "f", new_name="g", unroll=0).function])
    assert any(isinstance(s, ir.For) for s in inlined.function("g").body)
    (version,) = half_versions(inlined, ["g"], HalfRules())
    verify(version.function, no_function)
    inputs = {"x": np.full(9, 1.5, np.float32), "k": np.arange(-4.0, 5.0).astype(np.float32)}
    got = evaluate(inlined, "g", inputs, "float16", rules=HalfRules())
    assert isinstance(got, np.ndarray)
    assert got.tolist() == [3.0, 3.0, 2.0, 1.5, 1.5, 1.5, 2.0, 3.0, 3.0]


def constants_of(folder: Path, returned: str, rules: HalfRules) -> set[tuple[object, object]]:
    made = library_of(folder, f"def f(x: X) -> f32:\n    return {returned}\n")
    body = half_versions(made, ["f"], rules)[-1].function.body
    return {(e.type, e.value) for e in ir.expressions(body) if isinstance(e, ir.Const)}


def test_constants_are_normal_halves(tmp_path: Path) -> None:
    """2^-14 is the least normal half: below it devices may flush."""
    assert constants_of(tmp_path, "x + 6.103515625e-05", HalfRules()) == {(F16, 2.0**-14)}
    for number in ("4.0e-05", "-6.0e-05"):
        with pytest.raises(UserError, match=r"f has the constant -?\d\.\d+e-05, which halves lose"):
            constants_of(tmp_path, f"x + {number}", HalfRules())
    assert constants_of(tmp_path, "x + 65504.0", HalfRules()) == {(F16, 65504.0)}
    assert constants_of(tmp_path, "x * 0.0", HalfRules()) == {(F16, 0.0)}


def test_stated_constants_hold_for_a_function_or_for_all(tmp_path: Path) -> None:
    """A rule of the function itself goes before one for all; a sign is kept."""
    everywhere = HalfRules({(0.25, ""): 0.5})
    assert constants_of(tmp_path, "x - (-0.25)", everywhere) == {(F16, -0.5)}
    assert constants_of(tmp_path, "x - 0.25", everywhere) == {(F16, 0.5)}
    both = HalfRules({(0.25, ""): 0.5, (0.25, "f"): 0.125, (0.5, "g"): 3.0})
    assert constants_of(tmp_path, "x - 0.25 * max(x, 0.5)", both) == {(F16, 0.125), (F16, 0.5)}
    assert constants_of(tmp_path, "x + 0.0", HalfRules({(0.0, ""): 1.0})) == {(F16, 1.0)}


def test_versions_say_which_are_halves(tmp_path: Path) -> None:
    made = library(tmp_path, "    return (square(x) + around(k)) * fourth(x)\n")
    found = half_versions(made, ["f"], HalfRules({}, {"f": frozenset("x")}))
    names = [(v.function.name, v.source.name, v.is_half) for v in found]
    assert sorted(names) == [
        ("around", "around", True),
        ("f", "f", True),
        ("fourth_single", "fourth", False),
        ("square_single", "square", False),
        ("taken", "taken", True),
    ]
    order = [name for name, _, _ in names]
    assert order.index("square_single") < order.index("fourth_single")
    assert order.index("taken") < order.index("around")
    assert order[-1] == "f"
