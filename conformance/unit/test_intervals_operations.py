"""Interval operations one by one: rounding, flushing, sign, identity, forks, integers.

Plan.
  rounding    down and up give float32 neighbours and keep float32 numbers; sums see what float64 loses
  ulp         the spacing of float32, the larger one at powers of two
  operations  brute force over the ends: every result that a choice of neighbours can give lies inside
  identity    x - x is 0, x * x is not negative, equal expressions are one value
  integers    points are exact and wrap; intervals hold every result
  branches    early returns, loops and undecided conditions
  shortcuts   sums that float64 holds are told from those that it rounds; choosing by bits is np.where
  chunks      several at a time give what one after another gives, causes included; how many at a time
  normalize   a component of a vector that no interval knows is 1 at most, with its roundings
"""

from __future__ import annotations

import multiprocessing
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.intervals import load_table, numbers, permit, permitted, whole
from codegen.intervals.threads import threads
from codegen.intervals.values import Whole
from conformance.unit.support.sources import library_of
from conformance.unit.support.tolerances import tolerance

SEED = 20260802
LARGEST = 1e37
"""Numbers up to here, and their reciprocals, are normal in float32."""


def float32_numbers(count: int) -> Any:
    rng = np.random.default_rng(SEED)
    words = rng.integers(0, 2**32, 4 * count, dtype=np.uint64).astype(np.uint32)
    single = words.view(np.float32)
    normal = (np.abs(single) > 1.0 / LARGEST) & (np.abs(single) < LARGEST)
    return single[normal][:count].astype(np.float64)


def test_neighbours() -> None:
    x = float32_numbers(2000)
    assert np.array_equal(numbers.down(x), x)
    assert np.array_equal(numbers.up(x), x)
    single = x.astype(np.float32)
    above = np.nextafter(single, np.float32(np.inf)).astype(np.float64)
    inside = x + (above - x) / 3.0
    assert np.array_equal(numbers.down(inside), x)
    assert np.array_equal(numbers.up(inside), above)


def test_sums_see_what_float64_loses() -> None:
    one, tiny = np.array([1.0, 1.0, 1.0]), np.array([2.0**-70, -(2.0**-70), 0.0])
    step = 2.0**-23
    assert numbers.sum_down(one, tiny).tolist() == [1.0, 1.0 - step / 2, 1.0]
    assert numbers.sum_up(one, tiny).tolist() == [1.0 + step, 1.0, 1.0]


def test_spacing() -> None:
    x = np.array([1.0, 1.5, 2.0, 0.75, -3.0, 0.0])
    assert (numbers.ulp(x) / 2.0**-24).tolist() == [2.0, 2.0, 4.0, 1.0, 4.0, 2.0**-125]


OPERATIONS = (
    "a + b",
    "a - b",
    "a * b",
    "a / b",
    "max(a, b) - min(a, b)",
    "floor(a) + b",
    "abs(a) * b",
    "-a * a + b",
)


@pytest.mark.parametrize("text", OPERATIONS)
def test_every_choice_of_neighbours_lies_inside(text: str, tmp_path: Path) -> None:
    """The operation sees inputs that an addition before it, of something tiny, moves to either neighbour."""
    library = library_of(
        tmp_path,
        f"@helper\ndef plain(a: X, b: X) -> f32:\n    return {text}\n\n\n"
        "def probe(p: X, q: X, tiny: X) -> f32:\n    return plain(p + tiny, q - tiny)\n",
    )
    rng = np.random.default_rng(SEED)
    p, q = (rng.uniform(-4.0, 4.0, 500).astype(np.float32) for _ in range(2))
    tiny = np.full(500, 1e-12, np.float32)
    found: Any = permitted(library, "probe", {"p": p, "q": q, "tiny": tiny}, "wgsl")
    for a in (p, np.nextafter(p, np.float32(9.0))):
        for b in (q, np.nextafter(q, np.float32(-9.0))):
            assert found.contains(evaluate(library, "plain", {"a": a, "b": b})).all()


IDENTITIES = {
    "(a + b) - (a + b)": (0.0, 0.0),
    "(a + b) - (b + a)": (0.0, 0.0),
    "(a * b) - (b * a)": (0.0, 0.0),
    "(b + a) * (a + b)": (0.0, np.inf),
    "sqrt((a + b) * (b + a))": (0.0, np.inf),
    "length(vec2(a + b, a - b))": (0.0, np.inf),
    "sqrt(dot(vec2(a + b, a - b), vec2(b + a, a - b)))": (0.0, np.inf),
}


@pytest.mark.parametrize("text", IDENTITIES)
def test_one_value_is_one_value(text: str, tmp_path: Path) -> None:
    library = library_of(tmp_path, f"def probe(a: X, b: X) -> f32:\n    return {text}\n")
    a = np.array([0.1, 1.0, -1e-3, 1e10, 0.1], np.float32)
    b = np.where(np.arange(5) < 4, -a + np.float32(1e-9), np.float32(0.7))  # the last sum has to be rounded
    found: Any = permitted(library, "probe", {"a": a, "b": b}, "wgsl")
    least, most = IDENTITIES[text]
    assert found.guaranteed.all()
    assert (found.low >= least).all()
    assert (found.high <= most).all()


@pytest.mark.parametrize(
    ("table", "steps"),
    [("opencl", 0.5), ("opencl_relaxed", 0.5), ("glsl", 1.0), ("glsl_es", 1.0), ("vulkan", 1.0)],
)
def test_product_less_itself_may_be_what_rounding_lost(table: str, steps: float, tmp_path: Path) -> None:
    """fma(a, b, -(a b)) is a contraction of a b - a b; nothing farther than rounding or flushing.

    WGSL fuses only what stays as accurate: there it is 0.
    """
    library = library_of(tmp_path, "def probe(a: X, b: X) -> f32:\n    return a * b - a * b\n")
    rng = np.random.default_rng(SEED)
    a, b = (rng.uniform(0.5, 2.0, 500).astype(np.float32) for _ in "ab")
    a[:100] *= np.float32(2.0**-126)
    exact = a.astype(np.float64) * b
    rounded = exact.astype(np.float32).astype(np.float64)
    lost = exact - rounded
    found: Any = permitted(library, "probe", {"a": a, "b": b}, table)
    assert found.guaranteed.all() and (lost[100:] != 0.0).any()
    either = (
        exact
        - rounded
        - np.where(lost > 0.0, 1.0, -1.0) * np.spacing(np.abs(rounded).astype(np.float32)).astype(np.float64)
    )
    for value in (lost, -lost, np.zeros(500), *((either,) if steps == 1.0 else ())):
        assert ((found.low <= value) & (value <= found.high))[100:].all()
    most = steps * np.spacing(np.abs(rounded[100:]).astype(np.float32)).astype(np.float64)
    assert (found.high[100:] <= most).all() and (found.low[100:] >= -most).all()
    flushed = np.where(np.abs(exact) < numbers.SMALLEST, exact, 0.0)[:100]
    assert (
        (flushed > 0.0).any() and (found.high[:100] >= flushed).all() and (found.low[:100] <= -flushed).all()
    )


def test_denormals_may_be_read_as_zero(tmp_path: Path) -> None:
    library = library_of(tmp_path, "def probe(a: X) -> f32:\n    return 1.0 if a > 0.0 else 2.0\n")
    found: Any = permitted(library, "probe", {"a": np.array([1e-40, 1.0, 0.0], np.float32)}, "wgsl")
    assert found.low.tolist() == [1.0, 1.0, 2.0]
    assert found.high.tolist() == [2.0, 1.0, 2.0]


def test_results_below_the_normal_numbers_lie_on_their_grid(tmp_path: Path) -> None:
    """Where a table keeps them; their spacing is 2^-149."""
    library = library_of(tmp_path, "def probe(x: X, y: X) -> f32:\n    return x * y\n")
    inputs = {
        "x": np.geomspace(1e-25, 1e-20, 200, dtype=np.float32),
        "y": np.geomspace(3e-20, 1e-19, 200, dtype=np.float32),
    }
    found = permitted(library, "probe", inputs, replace(load_table("opencl"), flush=False))
    exact = inputs["x"].astype(np.float64) * inputs["y"]
    for end in (np.asarray(found.low, np.float64), np.asarray(found.high, np.float64)):
        assert np.array_equal(np.round(end * 2.0**149), end * 2.0**149)
        assert (np.abs(end - exact) <= 2.0**-149).all()
    assert found.contains(inputs["x"] * inputs["y"]).all()


def test_forks_are_followed(tmp_path: Path) -> None:
    """s + x with s the sign of x has no zero in it, whichever way the comparison goes."""
    library = library_of(
        tmp_path,
        "def probe(a: X, b: X) -> f32:\n"
        "    x = a + b\n    s = 1.0 if x >= 0.0 else -1.0\n    return 1.0 / (s + x)\n",
    )
    inputs = {"a": np.array([1e-3], np.float32), "b": np.array([-1e-3], np.float32)}
    tiny = {"a": np.array([2.0**-127], np.float32), "b": np.array([-(2.0**-128)], np.float32)}
    for given in (inputs, tiny):
        found: Any = permitted(library, "probe", given, "wgsl")
        assert found.guaranteed.all()
        assert np.abs(found.low[0]) <= 1.001
        assert np.abs(found.high[0]) <= 1.001
    assert not permitted(library, "probe", tiny, "wgsl", follow_forks=False).guaranteed.any()


BRANCHES = """
def probe(n: Annotated[u32, Finite()], x: X) -> f32:
    total = x
    for i in range(5):
        if n % 3 == 1:
            total = total * 0.5
        else:
            total += 0.1
        if total > 3.0:
            return -total
    return total
"""


def test_branches_and_loops(tmp_path: Path) -> None:
    library = library_of(tmp_path, BRANCHES)
    rng = np.random.default_rng(SEED)
    inputs = {
        "n": rng.integers(0, 100, 3000).astype(np.uint32),
        "x": rng.uniform(-4.0, 4.0, 3000).astype(np.float32),
    }
    found: Any = permitted(library, "probe", inputs, "wgsl")
    assert found.contains(evaluate(library, "probe", inputs)).all()
    assert ((found.high - found.low) < tolerance("narrow")).mean() > 0.99


@pytest.mark.parametrize("op", ["+", "-", "*", "//", "%", "<<", ">>", "&", "|", "^"])
def test_integers(op: str) -> None:
    rng = np.random.default_rng(SEED)
    limit = 40 if op in ("<<", ">>") else 2**32
    a = rng.integers(0, 2**32 - 8, 300)
    b = rng.integers(1, limit - 8 if limit > 40 else 24, 300)
    numpy_op = {"//": np.floor_divide, "%": np.remainder, "<<": np.left_shift, ">>": np.right_shift}
    plain = {"+": np.add, "-": np.subtract, "*": np.multiply, "&": np.bitwise_and, "|": np.bitwise_or}
    function = {**numpy_op, **plain, "^": np.bitwise_xor}[op]
    wide = whole.binary(op, Whole(a, a + 7, False), Whole(b, b + 7, False))
    for i in range(8):
        for j in range(8):
            exact = function((a + i).astype(np.uint32), (b + j).astype(np.uint32)).astype(np.int64)
            point = whole.binary(op, point_of(a + i), point_of(b + j))
            assert np.array_equal(point.low, exact)
            assert ((wide.low <= exact) & (exact <= wide.high)).all()


def test_hulls_of_integers_end_where_their_corners_do() -> None:
    """Without wrapping; where a result may wrap, the hull is every integer."""
    rng = np.random.default_rng(SEED)
    a, b = rng.integers(200, 1000, 300), rng.integers(1, 90, 300)
    ends = {
        "+": (a + b, a + b + 14),
        "-": (a - b - 7, a + 7 - b),
        "*": (a * b, (a + 7) * (b + 7)),
        "//": (a // (b + 7), (a + 7) // b),
    }
    for op, (low, high) in ends.items():
        wide = whole.binary(op, Whole(a, a + 7, False), Whole(b, b + 7, False))
        assert np.array_equal(wide.low, low), op
        assert np.array_equal(wide.high, high), op


def point_of(a: Any) -> Whole:
    return Whole(a, a, False)


def test_sums_called_exact_are_exact() -> None:
    rng = np.random.default_rng(SEED)
    for exponent in (0, 20, 26, 27, 28, 40, 60):
        x = np.ldexp(1.0 + rng.integers(0, 2**23, 400) * 2.0**-23, exponent)
        y = -(1.0 + rng.integers(0, 2**23, 400) * 2.0**-23)
        exact = numbers.exact_sums(numbers.reach(x, x), numbers.reach(y, y))
        assert exact == (exponent <= 26)
        if exact:
            total = x + y
            assert np.array_equal((total - x) - y, np.zeros(400))
    zero = np.zeros(3)
    assert not numbers.exact_sums(numbers.reach(zero, zero), numbers.reach(zero, zero))
    assert not numbers.usual(numbers.reach(np.array([1.0, np.nan]), np.array([1.0, 2.0])))
    assert not numbers.usual(numbers.reach(np.array([-np.inf, 1.0]), np.array([1.0, 2.0])))
    assert numbers.reach(np.array([-3.0, 1.0]), np.array([-2.0, 5.0])) == (-3.0, 5.0, 1.0)


def test_select_is_where() -> None:
    x, y = float32_numbers(500), -float32_numbers(500)
    mask = np.arange(500) % 3 == 0
    assert np.array_equal(numbers.select(mask, x, y), np.where(mask, x, y))
    assert np.array_equal(numbers.select(mask, x[:1], y), np.where(mask, x[:1], y))
    whole_numbers = np.arange(500)
    assert np.array_equal(
        numbers.select(mask, whole_numbers, -whole_numbers), np.where(mask, 1, -1) * whole_numbers
    )


CHUNKED = """def probe(x: X) -> f32:
    y = 1.0 / x if x > 0.5 else log(x)
    return y + normalize(vec3(x - 0.25, x, 0.0)).x
"""


def test_chunks_at_a_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    library = library_of(tmp_path, CHUNKED)
    x = np.linspace(-1.0, 1.0, 999, dtype=np.float32)
    monkeypatch.setattr(permit, "CHUNK", 100)
    found = []
    for count in (1, 3):
        monkeypatch.setenv("VAIR_INTERVAL_THREADS", str(count))
        found.append(permitted(library, "probe", {"x": x}, "wgsl"))
    one, three = found
    assert one.causes == three.causes and len(one.causes) > 0
    for name in ("low", "high", "codes"):
        assert np.array_equal(getattr(one, name), getattr(three, name), equal_nan=True)


@pytest.mark.parametrize(
    ("lanes", "sizes"),
    [(999, [84] * 11 + [75]), (300, [100] * 3), (301, [51] * 5 + [46]), (60, [40, 20]), (40, [40]), (0, [])],
)
def test_chunks_are_divided_evenly(
    lanes: int, sizes: list[int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Among three threads, none of more than 100 lanes, nor of less than 40 but for the last."""
    evaluated: list[int] = []
    evaluate = permit._Run.evaluate

    def noted(self: Any, part: Any, count: int, ways: Any) -> Any:
        evaluated.append(count)
        return evaluate(self, part, count, ways)

    monkeypatch.setattr(permit._Run, "evaluate", noted)
    monkeypatch.setattr(permit, "CHUNK", 100)
    monkeypatch.setattr(permit, "LEAST_CHUNK", 40)
    monkeypatch.setenv("VAIR_INTERVAL_THREADS", "3")
    x = np.linspace(0.5, 1.0, lanes, dtype=np.float32)
    permitted(library_of(tmp_path, "def probe(x: X) -> f32:\n    return x * x\n"), "probe", {"x": x}, "wgsl")
    assert sorted(evaluated, reverse=True) == sizes


def test_the_environment_sets_the_number_of_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    """By the name that codegen/README.md gives."""
    for told in ("1", "7", "1024"):
        monkeypatch.setenv("VAIR_INTERVAL_THREADS", told)
        assert threads() == int(told)


@pytest.mark.parametrize(
    ("is_worker", "processors", "expected"), [(False, 8, 2), (False, 1, 1), (False, None, 1), (True, 8, 1)]
)
def test_threads_that_nobody_asked_for(
    is_worker: bool, processors: int | None, expected: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two where there are processors; a worker has its own already."""
    monkeypatch.delenv("VAIR_INTERVAL_THREADS", raising=False)
    monkeypatch.setattr(multiprocessing, "parent_process", lambda: object() if is_worker else None)
    monkeypatch.setattr(os, "cpu_count", lambda: processors)
    assert threads() == expected


@pytest.mark.parametrize(
    "told", ["", "0", "1025", "-1", "1.5", "two", "\N{SUPERSCRIPT TWO}", "\N{ARABIC-INDIC DIGIT TWO}"]
)
def test_other_numbers_of_threads_are_refused(told: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("VAIR_INTERVAL_THREADS", told)
    with pytest.raises(UserError, match="give a number of threads from 1 to 1024"):
        threads()


WIDE = """def probe(x: X, y: X) -> vec3:
    unknown = (x + 1.0) - 1.0
    return normalize(vec3(unknown, unknown, y))
"""


@pytest.mark.parametrize("table", ["wgsl", "vulkan"])
def test_normalised_components_end_at_one(tmp_path: Path, table: str) -> None:
    y = np.array([1e-12, 1e-9], np.float32)
    inputs = {"x": np.full(2, 1e-8, np.float32), "y": y}
    found = permitted(library_of(tmp_path, WIDE), "probe", inputs, table)
    assert found.guaranteed.all()
    assert np.asarray(found.high).max() <= 1.0 + 2.0**-18
    assert np.asarray(found.high)[:, 0].min() > 0.99, "a component may be all there is"
