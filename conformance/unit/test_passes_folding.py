"""Constants are folded, and sums whose terms cancel become what is left of them.

Plan.
  folded   every operation on constant parameters becomes its value: the float32 next to what float64 gives
  kept     what would overflow, be no number, be denormal, or leave an integer type: targets differ there
  sums     products are multiplied out where a term then vanishes; the rest is the same real number, shorter
  zeros    products of vectors with constant zeros keep only what is left
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.ir import nodes as ir
from codegen.ir.verify import verify
from codegen.passes.analysis.operations import operations
from codegen.passes.specialise import Specialised, specialise
from conformance.unit.support.sources import library_of
from conformance.unit.support.trees import no_function

REAL = 2.0**-20
"""Distance in float32 of forms that are the same real number, relative to the largest term."""
VALUES = {"a": 0.3, "b": -1.7, "c": 2.5, "n": 29, "m": 3, "k": -7, "p": True}
SIGNATURE = "a: X, b: X, c: X, n: u32, m: u32, k: i32, p: bool"
FOLDED = {
    "f32": [
        *("a + b", "a - b", "a * b", "a / b", "-a", "a + 0.1", "min(a, b)", "max(a, b)", "clamp(b, a, c)"),
        *("abs(b)", "floor(b)", "sqrt(a)", "inverse_sqrt(a)", "exp(b)", "exp2(b)", "log(a)", "log2(a)"),
        *("sin(b)", "cos(b)", "atan2(a, b)", "atan2(b, a)", "dot(vec2(a, b), vec2(b, c))"),
        *("length(vec3(a, b, c))", "a if p else b", "a if a < b else b", "f32(n)", "f32(k)"),
        *("bits_to_float(float_to_bits(a) ^ u32(5))", "normalize(vec3(a, b, c)).z"),
    ],
    "vec3": [
        *("vec3(a, b, c) * 2.0", "a * vec3(a, b, c)", "vec3(a, b, c) / b", "vec3(a, b, c) + vec3(c)"),
        *("cross(vec3(a, b, c), vec3(c, a, b))", "abs(vec3(a, b, c))", "-vec3(a, b, c)", "vec3(a, b, c).zxy"),
        *("min(vec3(a, b, c), vec3(0.1))", "vec3(a, b, c) if p else vec3(b)", "vec3(vec2(a, b), c)"),
    ],
    "u32": [
        *("n + m", "m - n", "n * n", "n // m", "n % m", "n << m", "n >> m", "n & m", "n | m", "n ^ m", "~n"),
        *("min(n, m)", "max(n, m)", "float_to_bits(a)", "u32(c)", "u32(k)", "n if p else m"),
    ],
    "i32": ["k + k", "k - i32(n)", "k * k", "-k", "i32(b)", "i32(n)", "min(k, i32(m))", "max(k, 1)"],
    "bool": [
        *(
            "a < b",
            "a <= b",
            "a > b",
            "a >= b",
            "a == b",
            "a != b",
            "n < m",
            "k == -7",
            "not p",
            "p and a > b",
        ),
        *("a > b or p", "n != m"),
    ],
}


def made(folder: Path, returns: str, text: str, **known: Any) -> tuple[Any, Specialised]:
    library = library_of(folder, f"def f({SIGNATURE}) -> {returns}:\n    return {text}\n")
    found = specialise(library, "f", new_name="g", **known)
    verify(found.function, no_function)
    return library, found


@pytest.mark.parametrize(("returns", "text"), [(r, t) for r, texts in FOLDED.items() for t in texts])
def test_operation_on_constants_is_its_value(returns: str, text: str, tmp_path: Path) -> None:
    library, found = made(tmp_path, returns, text, constants=VALUES)
    assert not found.parameters
    assert sum(operations(found.function).values()) == 0
    assert {type(e) for e in ir.expressions(found.function.body)} <= {ir.Const, ir.Construct}
    types: dict[str, Any] = {"n": np.uint32, "m": np.uint32, "k": np.int32, "p": np.bool_}
    one = {name: np.array([value], types.get(name, np.float32)) for name, value in VALUES.items()}
    wanted = evaluate(library, "f", one, "float64")
    got = evaluate(library.with_functions([found.function]), "g", {}, "float64")
    assert isinstance(wanted, np.ndarray)
    if wanted.dtype.kind == "f":
        wanted = wanted.astype(np.float32)
    np.testing.assert_array_equal(got, wanted)
    assert {s.why.partition(":")[0] for s in found.log if s.name == "fold"} <= {
        "constants, rounded once",
        "constants of integers or truth values",
        "the condition is true",
        "the condition is false",
    }


KEPT = {
    "f32": (
        "c * a",
        "a / c",
        "sqrt(b)",
        "log(b)",
        "a - b * a",
        "exp(a)",
        "1.0 / c",
        "inverse_sqrt(c)",
        "log(c)",
    ),
    "u32": ("u32(a)", "n // m", "n % m", "u32(b)"),
    "i32": ("i32(a)", "i32(-a)"),
}
DIFFICULT = {"a": 3e38, "b": -3e38, "c": 0.0, "n": 7, "m": 0, "k": 0, "p": False}
TINY = {"a": 1e-30, "b": -1e-10, "c": 1.2e-38, "n": 7, "m": 0, "k": 0, "p": False}


@pytest.mark.parametrize(("returns", "text"), [(r, t) for r, texts in KEPT.items() for t in texts])
def test_what_has_no_value_on_every_target_stays(returns: str, text: str, tmp_path: Path) -> None:
    known = {**DIFFICULT, "c": 2.0} if text == "c * a" else DIFFICULT
    _, found = made(tmp_path, returns, text, constants=known)
    kinds = ir.Unary | ir.Binary | ir.Builtin | ir.Convert
    assert any(isinstance(e, kinds) for e in ir.expressions(found.function.body))


@pytest.mark.parametrize(
    ("type_", "number", "folded"),
    [
        *(("i32", x, True) for x in (2147483520.0, -2147483648.0, 63.5, -63.5)),
        *(("i32", x, False) for x in (2147483648.0, -2147483904.0)),
        *(("u32", x, True) for x in (4294967040.0, 65.0, 0.5, -0.5)),
        *(("u32", x, False) for x in (4294967296.0, -1.0)),
    ],
)
def test_conversions_are_folded_up_to_the_ends_of_the_type(
    type_: str, number: float, folded: bool, tmp_path: Path
) -> None:
    """The float32 next to an end, and the end itself or the one beyond."""
    _, found = made(tmp_path, type_, f"{type_}(a)", constants={"a": number})
    assert any(isinstance(e, ir.Convert) for e in ir.expressions(found.function.body)) != folded


@pytest.mark.parametrize("text", ["a * b", "c * 0.5", "c - c * 0.75"])
def test_what_may_be_flushed_stays(text: str, tmp_path: Path) -> None:
    _, found = made(tmp_path, "f32", text, constants=TINY)
    assert any(isinstance(e, ir.Binary) for e in ir.expressions(found.function.body))


CANCELS = {
    "(r + k) * (r + k) - r * r - k * k - 2.0 * r * k": 0,
    "-(r - k) + r": 0,
    "-(r + k) + r": 0,
    "(r + k) - (k + r)": 0,
    "(r + 0.1 * k) - 0.1 * k": 0,
    "((r + k) * (r + k) - k * k) - 2.0 * k * r": 1,
    "(r * r * r + k) - r * r * r": 0,
    "-(r * 3.0 + k) + r * 3.0": 0,
    "r * (k + 1.0) - r * k": 0,
    "k - (r + k)": 0,
    "0.5 * (r - k) + 0.5 * (k - r)": 0,
    "-r * -k + r * -k": 0,
    "sin(r) * (k + 1.0) - sin(r) * k": 1,
    "(sqrt(r * r + 1.0) + k) - k": 3,
    "(r + k) * 0.5 - k * 0.5": 1,
    "((((r + k) + 1.0) + 2.0) + 3.0) - k": 1,
    "(r - k) - (r + k)": 1,
    "3.0 * (r + k) - 3.0 * k - r": 2,
    "r * k + r * k + r * (k * -2.0)": 0,
}
"""A sum, and how many operations are left of it."""
REMAINS = {
    "(r + 4.0) - 4.0": "constants may be there to round",
    "(r + k) + r": "nothing cancels",
    "(r + k * 0.3333) * 0.1 - k * 0.03333": "the factors differ in their last digits",
    "(r + (k + (1.0 + (r + (k + (r + (k + (r + (k + r))))))))) - (r + k)": "too deep",
    "(r + k) * (r - k)": "a product is no sum",
    "(r + k) * (r + 2.0) * (k + 3.0) * (r + 4.0) * (k - 5.0) - r": "too many terms",
}


def sums(folder: Path, text: str) -> tuple[Any, Specialised]:
    library = library_of(folder, f"def f(r: X, k: X) -> f32:\n    return {text}\n")
    return library, specialise(library, "f", new_name="g")


@pytest.mark.parametrize("text", CANCELS)
def test_terms_that_cancel_are_gone(text: str, tmp_path: Path) -> None:
    library, found = sums(tmp_path, text)
    left = operations(found.function)
    counted = left["arithmetic"] + left["special"]
    assert counted == CANCELS[text]
    random = np.random.default_rng(11)
    x = {name: random.uniform(-1.0, 1.0, 200).astype(np.float32) for name in ("r", "k")}
    exact = evaluate(library, "f", x, "float64")
    special = evaluate(library.with_functions([found.function]), "g", found.arguments(x))
    assert isinstance(special, np.ndarray)
    assert np.abs(special - exact).max() <= 10.0 * REAL


@pytest.mark.parametrize("text", REMAINS)
def test_other_sums_stay(text: str, tmp_path: Path) -> None:
    _, found = sums(tmp_path, text)
    assert not [s for s in found.log if s.name == "sums"]


VECTORS = {
    "(v + u) - u": "v",
    "(x * v + u) - v * x": "u",
    "(v - u) + (u + v)": "2.0 * v",
    "v * (x + 1.0) - v * x": "v",
    "(v + vec3(x)) - vec3(x)": "v",
    "(v + vec3(0.5)) - vec3(0.5)": "",
    "(v + vec3(x, 0.5, 0.25)) - vec3(x, 0.5, 0.25)": "",
}


@pytest.mark.parametrize("text", VECTORS)
def test_sums_of_vectors(text: str, tmp_path: Path) -> None:
    bodies = []
    for k, written in enumerate((text, VECTORS[text] or text)):
        library = library_of(tmp_path / str(k), f"def f(v: V, u: V, x: X) -> vec3:\n    return {written}\n")
        found = specialise(library, "f", new_name="g")
        bodies.append([s.value for s in found.function.body if isinstance(s, ir.Return)])
        if not VECTORS[text]:
            assert not [s for s in found.log if s.name == "sums" and "0" not in s.what]
    assert bodies[0] == bodies[1]


AXES = [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 0.6, 0.8), (0.6, 0.0, -0.8), (0.0, -1.0, 0.0)]
PRODUCTS = {
    "dot(u, n)": "f32",
    "dot(n, u)": "f32",
    "cross(u, n)": "vec3",
    "cross(n, u)": "vec3",
    "n * dot(n, u)": "vec3",
}


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("text", PRODUCTS)
def test_products_with_zeros(text: str, axis: tuple[float, ...], tmp_path: Path) -> None:
    library = library_of(tmp_path, f"def f(u: D, n: D) -> {PRODUCTS[text]}:\n    return {text}\n")
    found = specialise(library, "f", constants={"n": axis}, new_name="g")
    verify(found.function, no_function)
    u = np.random.default_rng(3).normal(size=(50, 3)).astype(np.float32)
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    x = found.impose({"u": u, "n": u})
    exact = evaluate(library, "f", x, "float64")
    got = evaluate(library.with_functions([found.function]), "g", found.arguments(x), "float64")
    assert isinstance(got, np.ndarray)
    assert np.abs(got - exact).max() <= REAL
    assert not [e for e in ir.expressions(found.function.body) if isinstance(e, ir.Builtin)]
    zeros = sum(c == 0.0 for c in axis)
    most = {"f32": 5 - 2 * zeros, "vec3": 9 - 3 * zeros + (2 if text.startswith("n *") else 0)}
    assert operations(found.function)["arithmetic"] <= most[PRODUCTS[text]]
    assert any(s.name == "axes" for s in found.log)


SIDES = {
    "not p if p else p": "False",
    "p if p else not p": "True",
    "q if p else p": "q if p else False",
    "p if p else q": "True if p else q",
    "not p if p else q": "False if p else q",
    "q if p else not p": "q if p else True",
}


@pytest.mark.parametrize(("text", "same"), SIDES.items())
def test_each_side_of_a_choice_knows_its_condition(text: str, same: str, tmp_path: Path) -> None:
    bodies = []
    for k, form in enumerate((text, same)):
        library = library_of(tmp_path / str(k), f"def f(p: bool, q: bool) -> bool:\n    return {form}\n")
        found = specialise(library, "f", new_name="g")
        bodies.append(found.function.body)
        given = {"p": np.array([True, True, False, False]), "q": np.array([True, False, True, False])}
        got = evaluate(library.with_functions([found.function]), "g", found.arguments(given))
        wanted = evaluate(library, "f", given)
        assert isinstance(got, np.ndarray)
        assert (np.broadcast_to(got, 4) == wanted).all()
    assert bodies[0] == bodies[1]
