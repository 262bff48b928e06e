"""The evaluator computes what the IR says, lane by lane.

Plan.
  float32     equals the same formula by hand in numpy float32, bit for bit: one rounding per operation
  branches    early returns, loops and nested conditions over many lanes equal scalar Python, lane by lane
  mpmath      goes beyond float64, and keeps quiet about lanes that a branch does not take
  inputs      structs, single values that repeat, no lanes at all; bad inputs get one sentence
  devices     functions made of exact operations only give the evaluator's bits on every target
"""

import pickle
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import numpy.typing as npt
import pytest

from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.execute import Runtime, execute
from codegen.ir import nodes as ir
from codegen.ir.types import F32
from codegen.library import Library
from conformance.unit.support.sources import library_of

SEED = 20260730
LANES = 1000
Floats = npt.NDArray[np.float32]

FORMULAS: dict[str, tuple[str, Callable[[Floats, Floats, Floats], Any]]] = {
    "sum": ("a + b + c", lambda a, b, c: a + b + c),
    "right_sum": ("a + (b + c)", lambda a, b, c: a + (b + c)),
    "product": ("a * b - b * c", lambda a, b, c: a * b - b * c),
    "quotient": ("a / (b * b + 1.0)", lambda a, b, c: a / (b * b + np.float32(1.0))),
    "root": ("sqrt(abs(a)) * b", lambda a, b, c: np.sqrt(np.abs(a)) * b),
    "tenth": ("a * 0.1 + 0.3", lambda a, b, c: a * np.float32(0.1) + np.float32(0.3)),
    "dot": (
        "dot(vec3(a, b, c), vec3(b, c, a))",
        lambda a, b, c: a * b + b * c + c * a,
    ),
    "cross": (
        "cross(vec3(a, b, c), vec3(b, c, a)).x",
        lambda a, b, c: b * a - c * c,
    ),
    "clamped": (
        "clamp(a, min(b, c), max(b, c))",
        lambda a, b, c: np.minimum(np.maximum(a, np.minimum(b, c)), np.maximum(b, c)),
    ),
    "chosen": ("a if b < c else -a", lambda a, b, c: np.where(b < c, a, -a)),
    "scaled": ("(vec2(a, b) * c).y", lambda a, b, c: b * c),
    "divided": ("(vec2(a, b) / c).x", lambda a, b, c: a / c),
    "floor": ("a - floor(a)", lambda a, b, c: a - np.floor(a)),
}


def three_floats() -> dict[str, Floats]:
    rng = np.random.default_rng(SEED)
    sizes = np.exp2(rng.uniform(-20.0, 20.0, (3, LANES)))
    return dict(zip("abc", (sizes * rng.choice((-1.0, 1.0), (3, LANES))).astype(np.float32), strict=True))


@pytest.mark.parametrize("name", FORMULAS)
def test_float32_rounds_every_operation(name: str, tmp_path: Path) -> None:
    text, by_hand = FORMULAS[name]
    library = library_of(tmp_path, f"def probe(a: X, b: X, c: X) -> f32:\n    return {text}\n")
    inputs = three_floats()
    got = evaluate(library, "probe", inputs)
    expected = by_hand(inputs["a"], inputs["b"], inputs["c"])
    assert isinstance(got, np.ndarray)
    assert got.dtype == expected.dtype == np.float32
    assert np.array_equal(got.view(np.uint32), expected.view(np.uint32))


BRANCHES = """
@helper
def collatz_like(n: u32, limit: u32) -> u32:
    m = n
    for i in range(8):
        if m > limit:
            return m + 1000
        if m % 2 == 0:
            m = m // 2
        else:
            if m == 1:
                return u32(i)
            m = 3 * m + 1
    return m

def probe(n: u32, limit: u32, x: X) -> f32:
    if x < 0.0:
        y = x
        if n > 50:
            return -1.0
        elif n > 25:
            y = 2.0 * x
        else:
            return f32(n) + x
        return y
    total = 0.0
    for i in range(2, 5):
        if i == 3 and x > 0.5:
            total += f32(collatz_like(n, limit))
        elif not (n < 10 or x > 0.75):
            total -= 1.0
        for k in range(3):
            if f32(k) > 3.0 * x:
                return total - 100.0
            total += f32(i * k)
    return total
"""


def collatz_like(n: int, limit: int) -> int:
    m = n
    for i in range(8):
        if m > limit:
            return m + 1000
        if m % 2 == 0:
            m = m // 2
        else:
            if m == 1:
                return i
            m = 3 * m + 1
    return m


def branches(n: int, limit: int, x: float) -> float:
    if x < 0.0:
        if n > 50:
            return -1.0
        elif n > 25:
            y = 2.0 * x
        else:
            return n + x
        return y
    total = 0.0
    for i in range(2, 5):
        if i == 3 and x > 0.5:
            total += collatz_like(n, limit)
        elif not (n < 10 or x > 0.75):
            total -= 1.0
        for k in range(3):
            if k > 3.0 * x:
                return total - 100.0
            total += i * k
    return total


def branch_inputs() -> dict[str, npt.NDArray[Any]]:
    """Whole numbers and sixteenths, on which every operation is exact."""
    rng = np.random.default_rng(SEED)
    return {
        "n": rng.integers(0, 100, LANES).astype(np.uint32),
        "limit": rng.integers(1, 200, LANES).astype(np.uint32),
        "x": (rng.integers(-16, 17, LANES) / 16).astype(np.float32),
    }


@pytest.mark.parametrize("arithmetic", ["float32", "float64", "mpmath"])
def test_divergent_branches_equal_scalar_python(arithmetic: str, tmp_path: Path) -> None:
    inputs = branch_inputs()
    got = evaluate(library_of(tmp_path, BRANCHES), "probe", inputs, arithmetic)
    rows = zip(*(inputs[name].tolist() for name in ("n", "limit", "x")), strict=True)
    assert np.asarray(got).astype(np.float64).tolist() == [branches(*row) for row in rows]


def test_mpmath_keeps_digits_that_double_loses(tmp_path: Path) -> None:
    library = library_of(tmp_path, "def probe(x: X) -> f32:\n    return (1.0 + x) - 1.0\n")
    with mpmath.workdps(60):
        (got,) = evaluate(library, "probe", {"x": np.float32(1e-30)}, "mpmath")
        assert got == mpmath.mpf(float(np.float32(1e-30)))
    assert evaluate(library, "probe", {"x": np.float32(1e-30)}, "float64") == 0.0


def test_types_that_are_equal_are_one(tmp_path: Path) -> None:
    """Functions travel between processes, where a type arrives as another object."""
    probe = library_of(tmp_path, "def probe(x: X, y: X) -> f32:\n    return x + y\n").function("probe")
    added = ir.Binary(F32, "+", pickle.loads(pickle.dumps(ir.Var(F32, "x"))), ir.Var(F32, "y"))
    library = library_of(tmp_path, "").with_functions([replace(probe, body=(ir.Return(added),))])
    found: Any = evaluate(library, "probe", {"x": [1.0, 2.0], "y": [4.0, 8.0]})
    assert found.tolist() == [5.0, 10.0]


QUIET = {
    "division": ("1.0 / x", "1.0"),
    "zero over zero": ("x / x", "1.0"),
    "root": ("sqrt(x - 1.0)", "1.0"),
    "reciprocal root": ("inverse_sqrt(x)", "1.0"),
    "logarithm": ("log(x)", "1.0"),
    "direction": ("normalize(vec3(x)).x", "1.0"),
    "integer": ("f32(u32(1.0 / x))", "1.0"),
    "sine": ("sin(1.0 / x)", "1.0"),
}


@pytest.mark.parametrize("arithmetic", ["float32", "float64", "mpmath"])
@pytest.mark.parametrize("name", QUIET)
def test_lane_that_a_branch_avoids_does_no_harm(name: str, arithmetic: str, tmp_path: Path) -> None:
    text, otherwise = QUIET[name]
    source = (
        f"def probe(x: X) -> f32:\n    y = {otherwise}\n    if x > 0.0:\n        y = {text}\n    return y\n"
    )
    got = evaluate(library_of(tmp_path, source), "probe", {"x": np.array([0.0, 2.0], np.float32)}, arithmetic)
    assert np.asarray(got)[0] == 1.0
    assert np.isfinite(float(np.asarray(got)[1]))


STRUCTS = """
@struct
class Inner:
    angle: X
    axis: V
@struct
class Outer:
    inner: Inner
    count: u32
    flag: bool
def swapped(o: Outer, x: X) -> Outer:
    return Outer(count=o.count + 1, flag=not o.flag, inner=Inner(x, o.inner.axis.zyx * o.inner.angle))
"""


def outer(lanes: int) -> dict[str, Any]:
    angle = np.arange(lanes, dtype=np.float32)
    return {
        "inner": {"angle": angle, "axis": np.stack([angle, angle + 1, angle + 2], axis=-1)},
        "count": np.arange(lanes, dtype=np.uint32),
        "flag": angle % 2 == 0,
    }


def test_structs_go_in_and_out_as_dicts(tmp_path: Path) -> None:
    given = outer(4)
    got: Any = evaluate(library_of(tmp_path, STRUCTS), "swapped", {"o": given, "x": 7.0})
    assert np.array_equal(got["inner"]["angle"], np.full(4, 7.0))
    expected = given["inner"]["axis"][:, ::-1] * given["inner"]["angle"][:, None]
    assert np.array_equal(got["inner"]["axis"], expected)
    assert np.array_equal(got["count"], given["count"] + 1)
    assert np.array_equal(got["flag"], ~given["flag"])


def test_single_values_repeat(tmp_path: Path) -> None:
    library = library_of(tmp_path, "def probe(x: X, v: V, n: u32) -> f32:\n    return x * v.y + f32(n)\n")
    got: Any = evaluate(library, "probe", {"x": [1.0, 2.0, 3.0], "v": [1.0, 10.0, 100.0], "n": 5})
    assert np.array_equal(got, [15.0, 25.0, 35.0])


@pytest.mark.parametrize("arithmetic", ["float32", "float64", "mpmath"])
def test_no_lanes_give_no_lanes(arithmetic: str, tmp_path: Path) -> None:
    library = library_of(tmp_path, "def probe(x: X, v: V) -> vec3:\n    return normalize(v) * sqrt(x)\n")
    got = evaluate(library, "probe", {"x": np.zeros(0), "v": np.zeros((0, 3))}, arithmetic)
    assert np.asarray(got).shape == (0, 3)


BAD_INPUTS: dict[str, tuple[dict[str, Any], str]] = {
    "missing": ({"x": 1.0, "v": [0, 0, 1]}, "probe needs n"),
    "unknown": (
        {"x": 1.0, "w": [0, 0, 1], "n": 1},
        'probe has no parameter "w"; valid names: n, v, x',
    ),
    "scalar for a vector": ({"x": 1.0, "v": 1.0, "n": 1}, "probe: v has shape (), but vec3 needs (N, 3)"),
    "vector for a scalar": (
        {"x": [[1.0]], "v": [0, 0, 1], "n": 1},
        "probe: x has shape (1, 1), but f32 needs (N,)",
    ),
    "wrong width": ({"x": 1.0, "v": [[0, 1]], "n": 1}, "probe: v has shape (1, 2), but vec3 needs (N, 3)"),
    "lengths": (
        {"x": [1.0, 2.0], "v": np.zeros((3, 3)), "n": 1},
        "probe: inputs have different lengths: [1, 2, 3]",
    ),
    "text": ({"x": "one", "v": [0, 0, 1], "n": 1}, "probe: x holds str96, but f32 is needed"),
    "fraction": ({"x": 1.0, "v": [0, 0, 1], "n": 1.5}, "probe: n holds float64, but u32 is needed"),
    "negative": ({"x": 1.0, "v": [0, 0, 1], "n": -1}, "probe: n holds a number outside [0, 4294967295]"),
    "too large": (
        {"x": 1.0, "v": [0, 0, 1], "n": 2**32},
        "probe: n holds a number outside [0, 4294967295]",
    ),
    "ragged": (
        {"x": 1.0, "v": [[0, 0, 1], [0, 1]], "n": 1},
        "probe: v is not an array: its rows differ in length",
    ),
}


@pytest.mark.parametrize("name", BAD_INPUTS)
def test_bad_input_gets_one_sentence(name: str, tmp_path: Path) -> None:
    library = library_of(tmp_path, "def probe(x: X, v: V, n: u32) -> f32:\n    return x * v.y + f32(n)\n")
    inputs, sentence = BAD_INPUTS[name]
    with pytest.raises(UserError) as caught:
        evaluate(library, "probe", inputs)
    assert str(caught.value) == sentence


BAD_STRUCTS: dict[str, tuple[Any, str]] = {
    "array": (np.zeros(3), "swapped: o is a Outer: give its fields"),
    "missing": ({"inner": {"angle": 1.0, "axis": [0, 0, 1]}, "count": 1}, "swapped: o lacks flag"),
    "number": ({**outer(1), "flag": [1]}, "swapped: o.flag holds int64, but bool is needed"),
    "unknown": ({**outer(1), "flags": True}, 'swapped: o has no field "flags"; did you mean "flag"?'),
    "deep": ({**outer(1), "inner": {"angle": 1.0}}, "swapped: o.inner lacks axis"),
}


@pytest.mark.parametrize("name", BAD_STRUCTS)
def test_bad_struct_gets_one_sentence(name: str, tmp_path: Path) -> None:
    given, sentence = BAD_STRUCTS[name]
    with pytest.raises(UserError) as caught:
        evaluate(library_of(tmp_path, STRUCTS), "swapped", {"o": given, "x": 1.0})
    assert str(caught.value) == sentence


def test_unknown_function_and_arithmetic_name_the_nearest(tmp_path: Path) -> None:
    library = library_of(tmp_path, STRUCTS)
    with pytest.raises(UserError, match='unknown function "swaped"; did you mean "swapped"'):
        evaluate(library, "swaped", {})
    with pytest.raises(UserError, match='unknown arithmetic "float23"; did you mean "float32"'):
        evaluate(library, "swapped", {}, "float23")


EXACT = """
@struct
class Bundle:
    bits: u32
    flag: bool
    pair: P
def hashed(n: u32, m: u32) -> u32:
    h = (n ^ (m << 13)) * 0x9E3779B9
    for i in range(5):
        if (h & 1) == 0:
            h = (h >> 3) | (h << 29)
        else:
            h = ~h + n // (m | 1) + h % 17
    return h
def chosen(x: X, y: X, v: V) -> vec3:
    if x < y:
        return -v.zxy
    w = vec3(max(x, y), min(x, y), clamp(x, -1.0, 1.0))
    return abs(w) if float_to_bits(x) == float_to_bits(y) or v.x >= 0.0 else floor(w)
def bundle(n: u32, x: X) -> Bundle:
    flag = n > 1000 and not (x <= 0.0)
    return Bundle(float_to_bits(-x), flag, vec2(bits_to_float((n & 0x7FFFFF) | 0x3F800000), f32(n & 0xFFFF)))
"""


def exact_inputs() -> dict[str, npt.NDArray[Any]]:
    rng = np.random.default_rng(SEED)
    return {
        "n": rng.integers(0, 2**32, LANES, dtype=np.uint32),
        "m": rng.integers(0, 2**32, LANES, dtype=np.uint32),
        "x": rng.normal(0.0, 4.0, LANES).astype(np.float32),
        "y": rng.normal(0.0, 4.0, LANES).astype(np.float32),
        "v": rng.normal(0.0, 4.0, (LANES, 3)).astype(np.float32),
    }


def bits(value: Any) -> Any:
    """The value with its floats as bits, comparable by ==."""
    if isinstance(value, dict):
        return {name: bits(part) for name, part in value.items()}
    a = np.ascontiguousarray(value)
    return (a.view(np.uint32) if a.dtype == np.float32 else a).tolist()


@pytest.mark.parametrize("name", ["hashed", "chosen", "bundle"])
def test_exact_functions_agree_bit_for_bit_on_devices(name: str, tmp_path: Path, runtime: Runtime) -> None:
    library: Library = library_of(tmp_path, EXACT)
    inputs = exact_inputs()
    inputs["y"][::3] = inputs["x"][::3]
    own = {p.name: inputs[p.name] for p in library.function(name).parameters}
    assert bits(execute(library, name, own, runtime)) == bits(evaluate(library, name, own))


@pytest.mark.parametrize("lanes", [1, 65])
def test_device_takes_any_number_of_lanes(lanes: int, tmp_path: Path, runtime: Runtime) -> None:
    library = library_of(tmp_path, STRUCTS)
    inputs = {"o": outer(lanes), "x": 2.0}
    assert bits(execute(library, "swapped", inputs, runtime)) == bits(evaluate(library, "swapped", inputs))
