"""Compiled loops give the intervals that numpy gives, bit for bit.

Plan. One program of every operation that has a compiled loop, and functions of the library, over numbers
drawn from all bit patterns, ordinary ones and the ends of ranges: low, high, codes and causes are equal under
every table, with compiled loops for all lanes and with none.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.intervals import TABLES, Permitted, arithmetic, compiled, permitted
from codegen.library import Library, load_library
from conformance.cases.drawing import UNIFORM, draw
from conformance.metamorphic.pairs import columns
from conformance.unit.support.sources import library_of

SEED = 20261122
LANES = 3000
SPECIAL = (0.0, -0.0, 1.0, -1.0, 2.0**-126, 2.0**-127, 2.0**-149, 3.4028234e38, 1.8e19, 5e-20, 88.5, 1e-3)
PROGRAM = """def probe(a: X, b: X, c: X) -> vec4:
    sum = a + b
    product = sum * c + a * 0.7
    square = (a - c) * (a - c)
    quotient = product / (b + c) - 2.5 / sum + 1.0 / (square + 1.0e-30)
    root = sqrt(sum) + inverse_sqrt(square)
    power = exp(product * 0.1) * log(square) + exp2(a) - log2(square)
    turned = product if sum > 0.5 else square
    wide = vec3(sum, turned, c)
    more = quotient + dot(wide, vec3(a, b, c)) - dot(vec3(a, 0.5, c), vec3(b, 0.25, 1.0))
    return vec4(more, root * length(wide), power + sin(turned), normalize(wide).y)
"""
NARROWED = """def probe(x: X, y: X, z: X) -> f32:
    t = exp(1.0)
    r = y
    if {comparison}:
        r = 1.0
    q = z * t
    if t > {shared!r}:
        r = r + q
    return r
"""
FUNCTIONS = ("sin_angle", "fakefur_shade_printed", "ggx_sample", "hammersley", "safe_pow")


def numbers(rng: np.random.Generator) -> Any:
    """Ordinary numbers, all bit patterns that are finite, and special ones, in any order."""
    patterns = rng.integers(0, 2**32, LANES, dtype=np.uint64).astype(np.uint32).view(np.float32)
    finite = np.where(np.isfinite(patterns), patterns, np.float32(1.0))
    ordinary = rng.normal(0.0, 2.0, LANES).astype(np.float32)
    special = np.array(SPECIAL, np.float32)[rng.integers(0, len(SPECIAL), LANES)]
    return np.choose(rng.integers(0, 4, LANES), (ordinary, ordinary, finite, special))


def both(
    monkeypatch: pytest.MonkeyPatch, library: Library, name: str, inputs: dict[str, Any], table: str
) -> list[Permitted]:
    found = []
    for fewest in (2, 2**62):
        monkeypatch.setattr(compiled, "FEWEST", fewest)
        found.append(permitted(library, name, inputs, table))
    return found


def assert_equal(loops: Permitted, plain: Permitted) -> None:
    for a, b in zip(
        columns({"low": loops.low, "high": loops.high}),
        columns({"low": plain.low, "high": plain.high}),
        strict=True,
    ):
        assert np.array_equal(a, b, equal_nan=True)
    assert np.array_equal(loops.codes, plain.codes)
    assert loops.causes == plain.causes


@pytest.mark.parametrize("table", TABLES)
def test_every_operation(table: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numba")
    library = library_of(tmp_path, PROGRAM)
    rng = np.random.default_rng(SEED)
    inputs = {name: numbers(rng) for name in "abc"}
    loops, plain = both(monkeypatch, library, "probe", inputs, table)
    assert 0.1 < plain.guaranteed.mean() < 0.9, "both kinds of lanes are seen"
    assert_equal(loops, plain)
    guaranteed = {name: value[plain.guaranteed] for name, value in inputs.items()}
    assert_equal(*both(monkeypatch, library, "probe", guaranteed, table))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_of_the_library(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numba")
    library = load_library()
    inputs = draw(library.function(name), UNIFORM, LANES)
    for table in ("wgsl", "opencl"):
        assert_equal(*both(monkeypatch, library, name, inputs, table))


def test_numbers_beside_powers_of_two() -> None:
    """Ends some float64 beside a power of two, where the spacing doubles: the same floats are in reach."""
    pytest.importorskip("numba")
    beside = np.array([1.0 + k * 2.0**-53 for k in (-64, -9, -8, -7, -2, 0, 2, 14, 16, 18, 64)])
    wider = np.array([0.0, 2.0**-50, 2.0**-30, 2.0**-24, 2.0**-23, 2.0**-20])
    low, more, sign = (a.ravel() for a in np.meshgrid(beside, wider, (-1.0, 1.0), indexing="ij"))
    for power in (0, -3, 40):
        ends = sign * low * 2.0**power, sign * (low + more) * 2.0**power
        low_end, high_end = np.minimum(*ends), np.maximum(*ends)
        for ulps in (0.0, 0.5, 1.0, 2.5):
            with np.errstate(over="ignore"):
                plain = arithmetic.within_ulp(low_end, high_end, ulps, ulps)
            first, last = np.empty(len(low_end)), np.empty(len(low_end))
            look = compiled.kernels().within_ulp(low_end, high_end, ulps, ulps, first, last)
            assert not look
            assert np.array_equal(first, plain[0]) and np.array_equal(last, plain[1])


@pytest.mark.parametrize("comparison", ["x > t", "x < t"])
@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("table", ["wgsl", "opencl"])
def test_shared_value_that_a_way_narrows(
    comparison: str, side: int, table: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A value that all lanes share becomes one of each lane, at either end, once a lane's way narrows it."""
    pytest.importorskip("numba")
    shared = np.float32(np.exp(1.0))
    library = library_of(tmp_path, NARROWED.format(comparison=comparison, shared=float(shared)))
    rng = np.random.default_rng(SEED)
    steps = side * rng.integers(1, 12, LANES) * np.spacing(shared)
    inputs = {"x": (shared + steps).astype(np.float32)}
    inputs |= {name: rng.uniform(1.0, 2.0, LANES).astype(np.float32) for name in "yz"}
    loops, plain = both(monkeypatch, library, "probe", inputs, table)
    low, high = plain.low, plain.high
    assert isinstance(low, np.ndarray) and isinstance(high, np.ndarray)
    assert (high - low > 1.0).any(), "some lanes go either way"
    assert_equal(loops, plain)
