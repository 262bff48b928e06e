"""Results that only rearranged sums explain, results that nothing explains, and programs made of chains.

The sum across a loop and a vector is that of random program 1032 of seed 9, as Mesa 22.3.6 computes it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.evaluate.arrays import Value
from codegen.intervals import permitted
from codegen.ir import nodes as ir
from conformance.fuzz.case import draw_inputs, make_case
from conformance.fuzz.source import write
from conformance.metamorphic.pairs import columns
from conformance.programs.chains import chained, straightened
from conformance.programs.gathered import gathered, reordered
from conformance.programs.rearranged import explained
from conformance.unit.support.sources import library_of

LOOP = """def probe(x: X) -> vec2:
    y = x
    for k in range(3):
        y = y + 3.0
    return -(vec2(0.001) - vec2(2.75, y))
"""
PRODUCT = """@helper
def scaled(x: X) -> f32:
    return x * 0.1

def probe(x: X, y: X) -> f32:
    s = -scaled(x)
    return s * 0.3 * y * 0.7
"""
SAME = 1e-6
"""How far chains may differ in float64 from what they were made of, relative to 1 + |value|: sums cancel."""


def in_one_sum(x: np.ndarray) -> np.ndarray:
    """2.75 - 0.001, and x + (9 - 0.001), every operation rounded."""
    first = np.full(len(x), np.float32(2.75) - np.float32(0.001), np.float32)
    return np.stack([first, x + (np.float32(9.0) - np.float32(0.001))], axis=-1)


@pytest.mark.parametrize("table", ["glsl", "wgsl"])
def test_a_sum_through_a_loop_is_explained(table: str, tmp_path: Path) -> None:
    library = library_of(tmp_path, LOOP)
    inputs = {"x": np.linspace(-9.01, -8.99, 50, dtype=np.float32)}
    got = in_one_sum(inputs["x"])
    assert not permitted(library, "probe", inputs, table).contains(got).any(), "this needs no explanation"
    assert explained(library, "probe", inputs, "", got, table).all()


def test_components_are_rearranged_each_for_itself(tmp_path: Path) -> None:
    """cranley_patterson under relaxed mathematics: one component loses its + 1 - 1, the other keeps - 1."""
    source = (
        "def probe(u: P) -> vec2:\n    d = u + (vec2(0.48853) - vec2(1.0))\n    return vec2(d.x + 1.0, d.y)\n"
    )
    library = library_of(tmp_path, source)
    shift = np.float32(0.48853)
    u = np.array([[0.4486155, 0.90600872]], np.float32)
    got = np.stack([u[:, 0] + shift, (u[:, 1] + shift) - np.float32(1.0)], axis=-1)
    assert explained(library, "probe", {"u": u}, "opencl", got, "opencl_relaxed").all()
    got[0, 0] += np.float32(1e-6)
    assert not explained(library, "probe", {"u": u}, "opencl", got, "opencl_relaxed").any()


REORDERED = """def probe(f: X) -> vec3:
    rest = vec2(f, f) * (vec2(f, 0.0) - vec2(1.5))
    return rest.xxy - rest.xxx - vec3(f, f, f)
"""


def test_a_sum_in_another_order_is_explained(tmp_path: Path) -> None:
    """Random program 13 of seed 4 on Mesa: the terms stand behind swizzles of a vector."""
    library = library_of(tmp_path, REORDERED)
    f = np.array([0xBFF8B24E], np.uint32).view(np.float32)
    three_halves = np.float32(1.5)
    last = (f * -three_halves - f) - f * (f - three_halves)
    got = np.stack([-f, -f, last], axis=-1)
    assert not permitted(library, "probe", {"f": f}, "wgsl").contains(got).any()
    for table in ("wgsl", "glsl", "vulkan"):
        assert explained(library, "probe", {"f": f}, "", got, table).all(), table
    assert not explained(library, "probe", {"f": f}, "", got, "opencl").any()
    got[:, 2] -= 16.0 * np.spacing(np.abs(last))
    assert not explained(library, "probe", {"f": f}, "", got, "wgsl").any()


CROSS = """def probe(a: V, b: V) -> vec3:
    return cross(a, b) - abs(b)
"""


def test_a_cross_product_is_a_sum_in_any_order(tmp_path: Path) -> None:
    """Random program 50085 of seed 1 on Mesa: z is (a.x b.y - |b.z|) - a.y b.x."""
    library = library_of(tmp_path, CROSS)
    a, b = (
        np.array([words], np.uint32).view(np.float32)
        for words in ((0xBF7514D6, 0xBF46CA96, 0xC02D9F89), (0x3F95FF6A, 0xBDAB8023, 0xC02CFA86))
    )
    inputs = {"a": a, "b": b}
    got = np.array(evaluate(library, "probe", inputs))
    got[:, 2] = (a[:, 0] * b[:, 1] - np.abs(b[:, 2])) - a[:, 1] * b[:, 0]
    for table in ("wgsl", "glsl", "vulkan"):
        assert not permitted(library, "probe", inputs, table).contains(got).any(), table
        assert explained(library, "probe", inputs, "", got, table).all(), table
    assert not explained(library, "probe", inputs, "", got, "opencl").any()
    got[:, 2] -= 16.0 * np.spacing(np.abs(got[:, 2]))
    assert not explained(library, "probe", inputs, "", got, "wgsl").any()


F, THIRD = np.float32, np.float32(0.3333333333333333)
SHARED: dict[str, tuple[str, list[int], Callable[..., Any]]] = {
    # A factor before the sum of what it was shared by: random programs 14041, 19458 and 28995 of seed 1.
    "square": (
        "dot(vec4(a, -2.75, a, 0.3333333333333333), vec4(a))",
        [0x3F869730],
        lambda a: a * ((a + a) + (F(-2.75) + THIRD)),
    ),
    "value": (
        "dot(vec3(a, a, 0.3333333333333333), vec3(b))",
        [0x4078948A, 0x40582610],
        lambda a, b: b * ((a + a) + THIRD),
    ),
    "constant": ("dot(vec2(a, b), vec2(5.0))", [0x3F36B3A5, 0xC00BEF24], lambda a, b: F(5.0) * (a + b)),
    "inside": (
        "c - dot(min(vec2(a, b), vec2(9.0)), vec2(5.0))",
        [0x3DA95099, 0x3F9747B4, 0x404BEE6C],
        lambda a, b, c: c - F(5.0) * (a + b),
    ),
    # A product that is a sign: random program 24669 of seed 1.
    "sign": (
        "0.7 - (a + b) * clamp(a, -1.0, -1.0)",
        [0x407A5B3F, 0xC07A5B3F],
        lambda a, b: (a + F(0.7)) + b,
    ),
    "sign before": (
        "0.7 - clamp(b, -1.0, -1.0) * (a + b)",
        [0x407A5B3F, 0xC07A5B3F],
        lambda a, b: (a + F(0.7)) + b,
    ),
    "component": (
        "dot(vec3(1.0, vec2(b, a) * 1.0).zy, vec3(vec2(a, b) * 0.0, 5.0).zz)",
        [0x3F36B3A5, 0xC00BEF24],
        lambda a, b: F(5.0) * (a + b),
    ),
    # What is left of a product, with another constant: random program 9697 of seed 2.
    "product": (
        "-0.1 * dot(vec4(a, 0.5, a, b), vec4(c))",
        [0x40500000, 0x40300000, 0xC0500000],
        lambda a, b, c: (F(-0.1) * c) * ((a + F(0.5)) + (a + b)),
    ),
    "beside": (
        "max((a + b) + (c + d), -100.0) + d * d + 1.0",
        [0xC066EDFC, 0x3FD7C6AC, 0xBFB55D36, 0x3F81D4C1],
        lambda a, b, c, d: ((a + c) + (b + d)) + d * d + F(1.0),
    ),
    "four": (
        "(a + b) + (c + d)",
        [0x447A0000, 0xC47A0000, 0x3DCCCCCD, 0x3E4CCCCD],
        lambda a, b, c, d: (a + c) + (b + d),
    ),
}


@pytest.mark.parametrize("name", SHARED)
def test_sums_with_shared_factors_are_explained(name: str, tmp_path: Path) -> None:
    """And what is sixteen steps of the largest number away from one of their forms is not."""
    text, words, form = SHARED[name]
    values = [np.array([word], np.uint32).view(np.float32) for word in words]
    inputs = dict(zip("abcd", values, strict=False))
    parameters = ", ".join(f"{letter}: X" for letter in inputs)
    library = library_of(tmp_path, f"def probe({parameters}) -> f32:\n    return {text}\n")
    got = form(*values)
    steps = 16.0 * np.spacing(np.abs([got, *values]).max())
    for table in ("wgsl", "glsl", "vulkan"):
        assert not permitted(library, "probe", inputs, table).contains(got).any(), table
        assert explained(library, "probe", inputs, "", got, table).all(), table
        for wrong in (got - steps, got + steps):
            assert not explained(library, "probe", inputs, "", wrong, table).any(), table
    assert not explained(library, "probe", inputs, "", got, "opencl").any()


SEEN_THROUGH = {
    "a choice": """def probe(a: X, b: V, up: bool) -> f32:
    s = b + vec3(a)
    if up:
        s = s.zxz
    return s.z - -1.0
""",  # random program 23502 of seed 2
    "a choice of two sums": """def probe(a: X, b: V, up: bool) -> f32:
    s = b + vec3(a)
    if not up:
        s = vec3(a)
    return s.z - -1.0
""",
    "a loop with an end that a run tells": """def probe(a: X, b: V, n: i32) -> f32:
    for i in range(min(n, 4)):
        if b.z * f32(i) > 0.5:
            return a + b.z + 1.0
    return (a - a) / (abs(b.z) + 0.125)
""",  # 1529
}


@pytest.mark.parametrize("name", SEEN_THROUGH)
def test_sums_are_seen_through(name: str, tmp_path: Path) -> None:
    library = library_of(tmp_path, SEEN_THROUGH[name])
    same = np.array([0x3E21ECFC], np.uint32).view(np.float32)
    beside = {"up": np.array([True])} if "choice" in name else {"n": np.array([7], np.int32)}
    if "n" in beside:
        same = same + F(0.25)
    inputs = {"a": same, "b": np.array([[0.0, 0.0, same[0]]], np.float32), **beside}
    got = same + (same + F(1.0))
    for table in ("wgsl", "glsl"):
        assert not permitted(library, "probe", inputs, table).contains(got).any(), table
        assert explained(library, "probe", inputs, "", got, table).all(), table
        assert not explained(library, "probe", inputs, "", got + 16 * np.spacing(got), table).any(), table


def test_multiples_of_one_value_are_gathered(tmp_path: Path) -> None:
    """3.3 x - y - 3.3 x, in which the multiples of x become one."""
    source = "def probe(x: X, y: X) -> f32:\n    a = x * 1.1\n    return a * 3.0 - y - x * 3.3\n"
    library = library_of(tmp_path, source)
    straight = straightened(library, "probe").function
    in_order, made = gathered(straight)
    inputs = {"x": np.array([1.7], np.float32), "y": np.array([0.3], np.float32)}
    for form, times in ((in_order, 2), (made, 1)):
        found = [e for e in ir.expressions(form.body) if isinstance(e, ir.Var) and e.name == "x"]
        assert len(found) == times
        wanted = evaluate(library, "probe", inputs, "float64")
        got = evaluate(library.with_functions([form]), "probe", inputs, "float64")
        assert all(np.abs(a - b).max() <= SAME for a, b in zip(columns(wanted), columns(got), strict=True))


@pytest.mark.parametrize(
    ("sum_", "names"),
    [
        ("a * b * c + a * b * d", "aabbcd"),  # a local that is not used any more holds a * b
        ("a * b + c * d + (a * c + d * b)", "abbccd"),
        ("a * b - c * d + (a * 3.0 - c * 0.7)", "abcd"),
        ("a * d + b * d + a", "aabd"),
        ("a * d + a * (b + c)", "abcd"),
    ],
)
def test_factors_are_taken_out_of_one_another(sum_: str, names: str, tmp_path: Path) -> None:
    """One of the forms has just these variables."""
    library = library_of(tmp_path, f"def probe(a: X, b: X, c: X, d: X) -> f32:\n    return {sum_}\n")
    found = [
        "".join(sorted(e.name for e in ir.expressions(form.body) if isinstance(e, ir.Var)))
        for form in gathered(straightened(library, "probe").function)
    ]
    assert names in found


def test_components_are_known_through_swizzles(tmp_path: Path) -> None:
    """z x + x y is x (z + y)."""
    library = library_of(tmp_path, "def probe(v: V) -> f32:\n    return dot(v.zx, v.zxy.yz)\n")
    made = [form for form in gathered(straightened(library, "probe").function)][-1]
    inputs = {"v": np.array([[2.0, 3.0, 5.0]], np.float32)}
    assert evaluate(library.with_functions([made]), "probe", inputs) == 2.0 * (5.0 + 3.0)
    assert sum(isinstance(e, ir.Var) for e in ir.expressions(made.body)) == len("xyz")


@pytest.mark.parametrize("more", ["s * y + x * y", "s * y + s + s"])
def test_sums_through_long_loops_are_looked_at_in_time(more: str, tmp_path: Path) -> None:
    """Written out, one has 3^16 terms, the other products with sums of hundreds."""
    source = f"def probe(x: X, y: X) -> f32:\n    s = x\n    for k in range(16):\n        s = s + {more}\n"
    library = library_of(tmp_path, f"{source}    return s\n")
    inputs = {"x": np.array([1.0], np.float32), "y": np.array([0.5], np.float32)}
    got = np.asarray(evaluate(library, "probe", inputs))
    assert explained(library, "probe", inputs, "glsl", got).all()
    assert not explained(library, "probe", inputs, "glsl", got * np.float32(1.01)).any()


def test_constant_moved_outwards_is_explained(tmp_path: Path) -> None:
    library = library_of(tmp_path, "def probe(a: X, b: X) -> f32:\n    return a + (b - 1.0)\n")
    a, b = (np.array([x], np.float32) for x in (0.155840933, 0.155642539))
    got = (a + b) - np.float32(1.0)
    inputs = {"a": a, "b": b}
    assert not permitted(library, "probe", inputs, "opencl_relaxed").contains(got).any()
    assert explained(library, "probe", inputs, "opencl", got, "opencl_relaxed").all()


def test_wrong_results_are_not_explained(tmp_path: Path) -> None:
    library = library_of(tmp_path, LOOP)
    inputs = {"x": np.linspace(1.0, 3.0, 50, dtype=np.float32)}
    got = in_one_sum(inputs["x"]) * np.float32(1.0 + 2e-6)
    assert not explained(library, "probe", inputs, "", got, "glsl").any()


def test_a_specification_that_keeps_the_order_explains_nothing(tmp_path: Path) -> None:
    library = library_of(tmp_path, LOOP)
    inputs = {"x": np.linspace(-9.01, -8.99, 50, dtype=np.float32)}
    assert not explained(library, "probe", inputs, "", in_one_sum(inputs["x"]), "opencl").any()


@pytest.mark.parametrize("constants_first", [False, True])
def test_constants_of_a_product_come_together(constants_first: bool, tmp_path: Path) -> None:
    library = library_of(tmp_path, PRODUCT)
    made = chained(straightened(library, "probe").function, constants_first)
    (constants,) = [
        e
        for e in ir.expressions(made.body)
        if isinstance(e, ir.Binary) and isinstance(e.left, ir.Binary) and _of_constants(e)
    ]
    assert [round(c.value, 3) for c in ir.walk(constants) if isinstance(c, ir.Const)] == [0.1, 0.3, 0.7]


def _of_constants(e: ir.Expr) -> bool:
    return all(isinstance(part, ir.Const | ir.Binary | ir.Unary) for part in ir.walk(e))


FORMS: dict[str, Callable[[ir.Function], Iterable[ir.Function]]] = {
    "constants first": lambda function: [chained(function, True)],
    "constants last": lambda function: [chained(function, False)],
    "gathered": gathered,
}


CONSTANT = """@helper
def beside(x: X, y: X) -> f32:
    for k in range(2):
        return x - (y - y)
    return y

def probe(z: X) -> f32:
    return beside(0.1, 2.2)
"""


def test_a_sum_of_constants_in_another_order_is_explained(tmp_path: Path) -> None:
    """Whoever inlines first and folds last sees no number in it that varies."""
    library = library_of(tmp_path, CONSTANT)
    inputs = {"z": np.zeros(1, np.float32)}
    got = np.float32(0.1) - np.float32(2.2) + np.full(1, np.float32(2.2))
    assert not permitted(library, "probe", inputs, "wgsl").contains(got).any(), "this needs no explanation"
    assert explained(library, "probe", inputs, "wgsl", got).all()
    assert not explained(library, "probe", inputs, "opencl", got).any()
    beyond = np.full(1, np.float32(0.1)) - 16 * np.spacing(np.float32(2.2))
    assert not explained(library, "probe", inputs, "wgsl", beyond).any()


@pytest.mark.parametrize("form", FORMS)
def test_forms_mean_what_they_were_made_of(form: str, tmp_path: Path) -> None:
    cases = [make_case(5, number) for number in range(24)]
    library = write(tmp_path, cases)
    changed = 0
    for case in cases:
        straight = straightened(library, case.entry)
        inputs = draw_inputs(case, library.function(case.entry).parameters, 32)
        wanted = evaluate(library, case.entry, inputs, "float64")
        for made in FORMS[form](straight.function):
            changed += made.body != straight.function.body
            got = evaluate(library.with_functions([made]), case.entry, straight.arguments(inputs), "float64")
            assert mostly_near(wanted, got), case.text
    assert changed > 3


def mostly_near(wanted: Value, got: Value) -> bool:
    """Where a comparison or a conversion turns on the last bit, a few lanes may go the other way."""
    for a, b in zip(columns(wanted), columns(got), strict=True):
        near = np.abs(a.astype(np.float64) - b) <= SAME * (1.0 + np.abs(a.astype(np.float64)))
        if near.mean() <= 0.9:
            return False
    return True


def test_reordered_programs_mean_what_they_were_made_of(tmp_path: Path) -> None:
    cases = [make_case(5, number) for number in range(48)]
    library = write(tmp_path, cases)
    changed = 0
    for case in cases:
        functions = library.select([case.entry]).functions
        made = [reordered(function) for function in functions]
        changed += any(a.body != b.body for a, b in zip(made, functions, strict=True))
        inputs = draw_inputs(case, library.function(case.entry).parameters, 32)
        wanted = evaluate(library, case.entry, inputs, "float64")
        got = evaluate(library.with_functions(made), case.entry, inputs, "float64")
        assert mostly_near(wanted, got), case.text
    assert changed > 3
