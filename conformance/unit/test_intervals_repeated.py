"""An evaluation that is recorded and repeated over other lanes gives the intervals of the interpreter.

Plan. Chunks are made small, so that the first is recorded and the rest repeated, and held against every chunk
evaluated by the interpreter: low, high, codes and causes are equal. Functions of the library, some of which
fork, under a table that rounds either way and one that rounds to nearest; a program of every operation; lanes
that what was recorded does not hold for: causes, conditions that other lanes decide otherwise, loops of other
lengths. And all instructions of the machine are seen to run.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.errors import UserError
from codegen.intervals import TABLES, Permitted, permit, permitted
from codegen.intervals.opcodes import NAMES
from codegen.intervals.program import Program, Segment
from codegen.intervals.threads import VARIABLE, threads
from codegen.library import Library, load_library
from conformance.cases.drawing import UNIFORM, draw
from conformance.metamorphic.pairs import columns
from conformance.unit.support.sources import library_of

SEED = 20261122
LANES = 4096
CHUNK = 1024
FUNCTIONS = ("poulin_fournier_value_eight", "fakefur_shade_printed", "hammersley", "sin_angle", "ward_sample")
PROGRAM = """def probe(a: X, b: X, c: X) -> vec4:
    sum = a + b
    product = sum * c + a * 0.7
    square = (a - c) * (a - c) + product * product
    quotient = product / (sum * sum + 1.0) - 2.5 * a * (b * c)
    root = sqrt(square) + inverse_sqrt(square + 1.0) + floor(a) + floor(product) + abs(c)
    power = exp(min(product, 1.0) * 0.1) * log(square + 2.0) + exp2(min(a, max(b, c)))
    turned = product if sum > 0.5 and not a == b or c >= 0.25 else -square
    chosen = a if a < c else b
    wide = vec3(sum, turned, chosen)
    more = quotient + dot(wide, vec3(a, b, c)) - clamp(product, a, 2.0) + abs(turned)
    whole = floor(abs(a)) * 2.0 if b <= c else b
    return vec4(more, root * length(wide), power + whole, square * c + wide.y * a)
"""
TURNS = """def probe(a: X, b: X) -> f32:
    chosen = a if a > 0.0 else b
    return chosen - a
"""


def both(
    monkeypatch: pytest.MonkeyPatch, library: Library, name: str, inputs: dict[str, Any], table: str
) -> tuple[list[bool], set[str]]:
    """Whether each repetition applied, and the instructions that ran; results are equal."""
    applied: list[bool] = []
    instructions: set[str] = set()
    plain = Program.run

    def run(self: Program, *given: Any) -> Any:
        found = plain(self, *given)
        applied.append(found is not None)
        segments = [p for p in self.parts if isinstance(p, Segment)]
        instructions.update(NAMES[op] for s in segments for op in s.code[:, 0])
        return found

    with monkeypatch.context() as patched:
        patched.setattr(permit, "CHUNK", CHUNK)
        patched.setattr(Program, "run", run)
        found = []
        for fewest in (2, 2**62):
            patched.setattr(permit, "FEWEST_REPEATED", fewest)
            found.append(permitted(library, name, inputs, table))
    assert_equal(*found)
    return applied, instructions


def assert_equal(repeated: Permitted, plain: Permitted) -> None:
    ends = [columns({"low": p.low, "high": p.high}) for p in (repeated, plain)]
    assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(*ends, strict=True))
    assert np.array_equal(repeated.codes, plain.codes)
    assert repeated.causes == plain.causes


def uniform(rng: np.random.Generator, low: float, high: float) -> Any:
    return rng.uniform(low, high, LANES).astype(np.float32)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_of_the_library(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numba")
    library = load_library()
    inputs = draw(library.function(name), UNIFORM, LANES)
    for table in ("wgsl", "opencl"):
        applied, _ = both(monkeypatch, library, name, inputs, table)
        assert any(applied)


def test_every_instruction(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numba")
    library = library_of(tmp_path, PROGRAM)
    rng = np.random.default_rng(SEED)
    inputs = {name: uniform(rng, -2.0, 2.0) for name in "abc"}
    seen: set[str] = set()
    for table in TABLES:
        applied, instructions = both(monkeypatch, library, "probe", inputs, table)
        assert any(applied), table
        seen |= instructions
    assert seen == set(NAMES)


def test_lanes_that_need_the_interpreter(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Overflow, numbers below the normal ones and what is not finite, in chunks after the recorded one."""
    pytest.importorskip("numba")
    library = library_of(tmp_path, PROGRAM)
    rng = np.random.default_rng(SEED)
    inputs = {name: uniform(rng, -2.0, 2.0) for name in "abc"}
    for at, value in ((CHUNK + 5, 3e38), (2 * CHUNK + 7, 1e-40), (2 * CHUNK + 9, 0.0)):
        for name in "abc":
            inputs[name][at] = np.float32(value)
    for table in ("wgsl", "opencl"):
        applied, _ = both(monkeypatch, library, "probe", inputs, table)
        assert True in applied and False in applied


def test_conditions_decided_otherwise(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where all lanes choose a, the difference is 0, but only there."""
    pytest.importorskip("numba")
    library = library_of(tmp_path, TURNS)
    rng = np.random.default_rng(SEED)
    a, b = uniform(rng, 0.5, 1.0), uniform(rng, 0.5, 1.0)
    a[CHUNK : 2 * CHUNK] -= np.float32(0.75)
    for table in ("wgsl", "opencl"):
        applied, _ = both(monkeypatch, library, "probe", {"a": a, "b": b}, table)
        assert True in applied and False in applied


def test_number_of_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numba")
    library = load_library()
    inputs = draw(library.function("ward_sample"), UNIFORM, LANES)
    monkeypatch.setattr(permit, "CHUNK", CHUNK)
    monkeypatch.setattr(permit, "FEWEST_REPEATED", 2)
    found = []
    for number in (1, 2):
        monkeypatch.setenv(VARIABLE, str(number))
        found.append(permitted(library, "ward_sample", inputs, "wgsl"))
    assert_equal(*found)


@pytest.mark.parametrize("told", ["", "0", "-1", "two", "1.5", "99999"])
def test_odd_numbers_of_threads(told: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, told)
    with pytest.raises(UserError, match=VARIABLE):
        threads()
