"""Whole evaluations: every kind of statement and expression, shapes of results, ways followed, chunks.

Plan. Functions whose arithmetic is exact on small whole numbers, so that what is permitted is one value, that
of the evaluator; then functions of a sum that lies between two floats, where the ways can be listed by hand.
  one value  vectors, structs, members, swizzles, arrays, loops with limits, returns within branches, calls,
             conversions, truth values; under tables of either rounding
  ways       hull of what the sides give, or each way on its own; how many ways are followed
  chunks     any number of lanes at a time gives the same, with forks and causes
  told       causes by frequency, what lies inside, lanes without guarantee
"""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.intervals import Permitted, permit, permitted
from codegen.intervals.causes import Cause
from conformance.metamorphic.pairs import columns
from conformance.unit.support.sources import library_of

SEED = 20_267
I32 = "Annotated[i32, Interval(-100, 100)]"
U32 = "Annotated[u32, Finite()]"

EXACT = {
    "vectors": (
        "a: V, b: V",
        "vec3",
        "c = a + b * 2.0\n    d = a.zyx\n    return vec3(c.y, d.x + c.x, -b.z)",
    ),
    "joined": ("a: V, x: X", "vec4", "p = vec4(a.xy, x, a.z)\n    return p * x - vec4(1.0, x, a.yz)"),
    "one for all": ("x: X", "vec3", "return vec3(x) + vec3(1.0, x, 2.0) * x"),
    "cross": ("a: V, b: V", "vec3", "return cross(a, b)"),
    "dot": ("a: V, b: V", "f32", "return dot(a, b) + dot(a.xy, b.yz)"),
    "branches": (
        "x: X, y: X",
        "f32",
        "r = 0.0\n    if x > y:\n        r = x\n        if x > 4.0:\n            return r * 8.0\n"
        "    else:\n        r = y + 1.0\n        if not (y > 2.0 and x < 1.0):\n            r -= x\n"
        "    return r",
    ),
    "loop": (
        "x: X",
        "f32",
        "t = x\n    for i in range(2, 6):\n        t = t + f32(i) * x\n        if t > 50.0:\n"
        "            return t\n    return -t",
    ),
    "loops": (
        "x: X",
        "f32",
        "t = 0.0\n    for i in range(3):\n        for j in range(2):\n            t += f32(i) * x + f32(j)\n"
        "    return t",
    ),
    "unsigned loop": (
        "n: U",
        "u32",
        "t = n\n    for i in range(4):\n        t = t * 3 + u32(i)\n    return t ^ n >> 1",
    ),
    "integers": ("n: I, m: I", "i32", "return max(n * m - n, min(n, m)) + clamp(n, -2, 3)"),
    "words": ("n: U, m: U", "u32", "return ((n << 3) | (m & 255)) + ~n % (m | 1) - (n // (m | 1))"),
    "conversions": (
        "x: X, n: I",
        "f32",
        "return f32(i32(x * 0.5)) + f32(n) + f32(u32(abs(x))) + floor(x * 0.25)",
    ),
    "bits": ("x: X", "u32", "return float_to_bits(x + 200.0) ^ u32(7)"),
    "floats of bits": ("x: X", "f32", "return bits_to_float(float_to_bits(x + 200.0)) * 2.0"),
    "choices": (
        "x: X, y: X",
        "vec3",
        "a = vec3(x) if x < y else vec3(y, x, 1.0)\n    return a if x >= 0.0 else -a",
    ),
    "truth": ("x: X, y: X", "bool", "return x > 1.0 if x != y else not (x <= 2.0 or y > x)"),
    "truths": ("x: X, y: X", "bool", "return x > y and not (y > 1.0) or x == y"),
    "extremes": ("x: X, y: X", "f32", "return min(x, y) * 3.0 + max(x, 2.0) - clamp(x, -1.0, 2.0) + abs(y)"),
    "integer branches": (
        "n: I",
        "i32",
        "r = n\n    if n >= 2:\n        r = n - 7\n    if r == n:\n        r = -n\n    return r",
    ),
}
WHERE = {"I": I32, "U": U32}


def source(name: str) -> str:
    parameters, returns, body = EXACT[name]
    for short, kind in WHERE.items():
        parameters = parameters.replace(f": {short}", f": {kind}")
    return f"def probe({parameters}) -> {returns}:\n    {body}\n"


def inputs_of(name: str, lanes: int = 60) -> dict[str, Any]:
    rng = np.random.default_rng(SEED)
    made: dict[str, Any] = {}
    for parameter in EXACT[name][0].split(", "):
        given, kind = parameter.split(": ")
        shape = (lanes, 3) if kind == "V" else (lanes,)
        numbers = rng.integers(-6, 7, shape)
        made[given] = {
            "I": numbers.astype(np.int32),
            "U": rng.integers(0, 2**32, shape, dtype=np.uint64).astype(np.uint32),
        }.get(kind, numbers.astype(np.float32))
    return made


@pytest.mark.parametrize("table", ["wgsl", "opencl"])
@pytest.mark.parametrize("name", EXACT)
def test_exact_functions_have_one_value(name: str, table: str, tmp_path: Path) -> None:
    if table == "opencl" and name in ("cross", "dot"):
        return  # whose promise is absolute there
    library = library_of(tmp_path, source(name))
    inputs = inputs_of(name)
    single: Any = evaluate(library, "probe", inputs)
    found: Any = permitted(library, "probe", inputs, table)
    assert found.guaranteed.all() and found.causes == ()
    assert found.low.shape == found.high.shape == single.shape
    assert np.array_equal(found.low, single) and np.array_equal(found.high, single)
    kinds = {"f32": np.float64, "bool": np.bool_}
    returns = EXACT[name][1]
    assert found.low.dtype == found.high.dtype == kinds.get("f32" if "vec" in returns else returns, np.int64)


STRUCTS = """@struct
class Pair:
    first: X
    at: P
    which: Annotated[u32, Finite()]
    sure: bool


def made(x: X, n: Annotated[u32, Finite()]) -> Pair:
    return Pair(x + 1.0, vec2(x, 2.0), n + 1, x > 0.0)


def probe(x: X, n: Annotated[u32, Finite()]) -> Pair:
    p = made(x, n)
    if p.sure:
        p = Pair(p.at.y, p.at.yx, p.which * 2, p.first > 3.0)
    return p
"""


def test_structs_have_one_value_a_field(tmp_path: Path) -> None:
    library = library_of(tmp_path, STRUCTS)
    inputs = {"x": np.arange(-3, 6).astype(np.float32), "n": np.arange(9).astype(np.uint32)}
    single: Any = evaluate(library, "probe", inputs)
    found: Any = permitted(library, "probe", inputs, "wgsl")
    assert list(found.low) == list(found.high) == ["first", "at", "which", "sure"]
    for name, value in single.items():
        assert np.array_equal(found.low[name], value) and np.array_equal(found.high[name], value)
    assert found.contains(single).all()
    for name in single:
        other = {**single, name: ~single[name] if name == "sure" else single[name] + 1}
        assert not found.contains(other).any()


STEP = 2.0**-23
TINY = 1e-12
BETWEEN = "def probe(x: X, y: X, t: X) -> f32:\n    p = x + t\n    q = y + t\n"
"""p and q are each one of two floats, 1 and the next one where x and y are 1."""


def between(folder: Path, body: str, follow: bool = True, lanes: int = 1) -> tuple[float, float]:
    library = library_of(folder, BETWEEN + body)
    one = np.ones(lanes, np.float32)
    found: Any = permitted(
        library,
        "probe",
        {"x": one, "y": one, "t": np.full(lanes, TINY, np.float32)},
        "wgsl",
        follow_forks=follow,
    )
    assert found.guaranteed.all()
    assert (found.low == found.low[0]).all() and (found.high == found.high[0]).all()
    return float(found.low[0]), float(found.high[0])


WAYS = {
    "    return 3.0 if p > 1.0 else 5.0\n": ((3.0, 5.0), (3.0, 5.0)),
    "    a = 3.0 if p > 1.0 else 5.0\n    b = 10.0 if p > 1.0 else 20.0\n    return a + b\n": (
        (13, 25),
        (13, 25),
    ),
    "    a = 3.0 if p > 1.0 else 5.0\n    return a - a\n": ((0.0, 0.0), (0.0, 0.0)),
    "    a = 3.0 if p > 1.0 else 5.0\n    b = -1.0 if q > 1.0 else 1.0\n    return a * b\n": (
        (-5, 5),
        (-5, 5),
    ),
    "    a = 8.0 if p > 1.0 else -8.0\n    return a * a\n": ((64.0, 64.0), (0.0, 64.0)),
    "    s = 1.0 if p > 1.0 else -1.0\n    return 4.0 / s\n": ((-4.0, 4.0), None),
    "    if p > 1.0:\n        return 2.0\n    return 7.0\n": ((2.0, 7.0), (2.0, 7.0)),
    "    r = 1.0\n    if p > 1.0:\n        r = 6.0\n"
    "        if q > 1.0:\n            r = 7.0\n    return r\n": (
        (1.0, 7.0),
        (1.0, 7.0),
    ),
    "    return floor(p - 0.00000001) * 4.0\n": ((0.0, 4.0), (0.0, 4.0)),
    "    k = i32(p * 5.0 - 0.0000005)\n    return f32(k) * 4.0\n": ((16.0, 20.0), (16.0, 20.0)),
}


@pytest.mark.parametrize("lanes", [1, 3])
@pytest.mark.parametrize("body", WAYS)
def test_ways_of_a_sum_between_two_floats(body: str, lanes: int, tmp_path: Path) -> None:
    followed, hull = WAYS[body]
    near = 4.0 * 2.5 * STEP if "/" in body else 0.0
    assert between(tmp_path, body, lanes=lanes) == pytest.approx(followed, abs=near)
    if hull is not None:
        assert between(tmp_path, body, follow=False, lanes=lanes) == pytest.approx(hull, abs=near)


def spread_over(count: int) -> str:
    """So many comparisons that are open, and a square that no hull over its ways knows to be 1."""
    names = [f"s{k}" for k in range(count)]
    lines = [f"    {n} = 1.0 if x + {k + 1}.0 * t > x else -1.0\n" for k, n in enumerate(names)]
    total = " + ".join(f"{n} * {n}" for n in names)
    return "".join(lines) + f"    return {total}\n"


@pytest.mark.parametrize(("count", "is_followed"), [(1, True), (3, True), (5, True), (6, False)])
def test_so_many_ways_are_followed(count: int, is_followed: bool, tmp_path: Path) -> None:
    """32 ways of a lane at a time; beyond, the hull of all counts."""
    low, high = between(tmp_path, spread_over(count))
    assert (low, high) == ((count, count) if is_followed else (0.0, count))
    assert between(tmp_path, spread_over(count), follow=False) == (0.0, count)


MIXED = """def probe(x: X, t: X) -> vec2:
    p = x + t
    s = 1.0 if p > 1.0 else -1.0
    u = 2.0 if p > x else -1.0
    k = floor(p * 2.0)
    return vec2(1.0 / (s * s * x - 4.0), u * k + log(x - 1.0))
"""


def equal(a: Permitted, b: Permitted) -> bool:
    ends = zip(columns({"l": a.low, "h": a.high}), columns({"l": b.low, "h": b.high}), strict=True)
    lanes = range(len(a.codes))
    same = all(np.array_equal(p, q, equal_nan=True) for p, q in ends)
    return same and all(a.cause(k) == b.cause(k) for k in lanes) and set(a.causes) == set(b.causes)


@pytest.mark.parametrize("follow", [True, False])
def test_lanes_do_not_depend_on_each_other(
    follow: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All at once, some at a time, in another order, and each alone."""
    library = library_of(tmp_path, MIXED)
    x = np.array([0.5, 1.0, 2.0, 4.0, 1.5, 3.0, -1.0, 1.0, 5.0, 0.25, 1.0], np.float32)
    t = np.array([TINY, TINY, -TINY, TINY, 0.0, TINY, TINY, 0.0, 1e-9, TINY, -TINY], np.float32)
    every = permitted(library, "probe", {"x": x, "t": t}, "wgsl", follow_forks=follow)
    assert 0 < every.guaranteed.sum() < len(x)
    for chunk in (1, 2, 4, len(x)):
        for threads in ("1", "2"):
            monkeypatch.setattr(permit, "CHUNK", chunk)
            monkeypatch.setenv("VAIR_INTERVAL_THREADS", threads)
            found = permitted(library, "probe", {"x": x, "t": t}, "wgsl", follow_forks=follow)
            assert equal(every, found)
    back: Any = permitted(library, "probe", {"x": x[::-1], "t": t[::-1]}, "wgsl", follow_forks=follow)
    for k in range(len(x)):
        one: Any = permitted(
            library, "probe", {"x": x[k : k + 1], "t": t[k : k + 1]}, "wgsl", follow_forks=follow
        )
        whole: Any = every
        for a, b, c in ((one.low, whole.low, back.low), (one.high, whole.high, back.high)):
            assert np.array_equal(a[0], b[k], equal_nan=True) and np.array_equal(
                a[0], c[-1 - k], equal_nan=True
            )
        assert one.cause(0) == every.cause(k) == back.cause(len(x) - 1 - k)


def test_other_ways_leave_a_known_number_known(tmp_path: Path) -> None:
    """What differs from a number says nothing of it: as another type it has the same bits as before."""
    text = """def probe(x: X, n: Annotated[i32, Finite()]) -> f32:
    i = i32(x - 1.0)
    r = 0.0
    if i != n:
        r = f32(u32(n) >> 8)
        if i > n:
            r += 1.0
    return r
"""
    n = -(2**30) - 64  # x - 1 lies between floats 128 apart, too far for a way of each integer
    inputs = {"x": np.full(2, -(2.0**30), np.float32), "n": np.full(2, n, np.int32)}
    found: Any = permitted(library_of(tmp_path, text), "probe", inputs, "wgsl")
    assert found.low.tolist() == [0.0, 0.0]
    assert found.high.tolist() == [((n + 2**32) >> 8) + 1.0] * 2


def test_sources_are_read_before_threads_are_started(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also what only an added function calls: two threads that read one function find a recursion."""
    library = library_of(tmp_path, "def called(x: X) -> f32:\n    return x + 1.0\n")
    made = library_of(
        tmp_path / "made",
        "def called(x: X) -> f32:\n    return x\n\n\ndef probe(x: X) -> f32:\n    return called(x)\n",
    ).function("probe")
    read_in = []
    lower = library.resolver._lower

    def noted(*args: Any) -> Any:
        read_in.append(threading.current_thread())
        return lower(*args)

    monkeypatch.setattr(library.resolver, "_lower", noted)
    monkeypatch.setattr(permit, "CHUNK", 1)
    monkeypatch.setenv("VAIR_INTERVAL_THREADS", "2")
    found: Any = permitted(library.with_functions([made]), "probe", {"x": np.ones(4, np.float32)}, "wgsl")
    assert found.low.tolist() == [2.0] * 4
    assert read_in == [threading.main_thread()]


FORKS_BETWEEN = {
    "a value met again": "y = x if z > 0.0 else 0.5 - x\n    a = floor(x) + floor(y)",
    "a known number": "y = 3.0 if z > 0.0 else x * 0.7\n    a = floor(y)",
    "a known integer": "y = i32(3.5 if z > 0.0 else x * 0.7)\n    a = f32(y)",
    "iterations": "a = 0.0\n    for i in range(min(n, 4)):\n        a += floor(x + f32(i) * 0.7)",
}
"""Of the first lane alone there are fewer forks than of both: it has no second value, number or iteration."""


@pytest.mark.parametrize("between_forks", FORKS_BETWEEN)
def test_forks_are_those_of_the_lane(between_forks: str, tmp_path: Path) -> None:
    """A way is taken at the fork that it was told for, whichever lanes are evaluated beside it."""
    text = f"""def probe(x: X, z: X, t: X, u: X, n: {U32}) -> f32:
    {FORKS_BETWEEN[between_forks]}
    side = 0.0 if t + 1.0e-8 > 1.0 else 10.0
    steps = floor((u + 1.0e-8) * 1.0e8)
    return a + side + steps
"""
    library = library_of(tmp_path, text)
    lanes = {"x": [0.25] * 2, "z": [1.0, -1.0], "t": [1.0, 4.0], "u": [0.5, 4.0]}
    inputs: dict[str, Any] = {name: np.array(values, np.float32) for name, values in lanes.items()}
    inputs["n"] = np.array([1, 2], np.uint32)
    both: Any = permitted(library, "probe", inputs, "wgsl")
    for lane in (0, 1):
        alone: Any = permitted(library, "probe", {n: v[lane : lane + 1] for n, v in inputs.items()}, "wgsl")
        assert both.low[lane] == alone.low[0] and both.high[lane] == alone.high[0]


def test_causes_by_frequency() -> None:
    causes = tuple(Cause("f", line, "/", "y", "why") for line in (1, 2, 3, 4))
    zero = np.zeros(7)
    found = Permitted(zero, zero + 1.0, np.array([2, 3, 3, 0, 4, 2, 1], np.int16), causes)
    assert list(found.histogram().items()) == [(causes[1], 2), (causes[2], 2), (causes[0], 1), (causes[3], 1)]
    assert Permitted(zero, zero, np.array([2, 2, 0, 0, 0, 0, 0], np.int16), causes).histogram() == {
        causes[1]: 2
    }
    assert Permitted(zero, zero, np.zeros(7, np.int16), ()).histogram() == {}
    assert found.guaranteed.tolist() == [False, False, False, True, False, False, False]
    assert found.cause(3) == "" and found.cause(0) == str(causes[1]) and found.cause(6) == str(causes[0])


def test_what_lies_inside() -> None:
    low, high = np.array([[0.0, 1.0], [0.0, 1.0], [0.0, 1.0]]), np.array([[1.0, 2.0], [1.0, 2.0], [1.0, 2.0]])
    found = Permitted(low, high, np.array([0, 0, 1], np.int16), (Cause("f", 1, "/", "y", "why"),))
    for value, expected in (
        (low, [True, True, True]),
        (high, [True, True, True]),
        (high + np.array([0.0, 0.5]), [False, False, True]),
        (low - [0.5, 0.0], [False, False, True]),
        (np.full((3, 2), np.nan), [False, False, True]),
    ):
        assert found.contains(value).tolist() == expected
    struct = Permitted({"a": low, "b": low[:, 0]}, {"a": high, "b": high[:, 0]}, np.zeros(3, np.int16), ())
    assert struct.contains({"a": low, "b": np.array([0.5, 1.5, 1.0])}).tolist() == [True, False, True]
    assert struct.contains({"a": low + np.array([0.0, 9.0]), "b": low[:, 0]}).tolist() == [
        False,
        False,
        False,
    ]
