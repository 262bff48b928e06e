"""What is computed once for all backends: shared in memory, between processes, and a few functions ahead.

Plan.
  prepared  the reference and the intervals of all lanes are those of direct calls, and are computed once
  shared    a second process waits for what the first one computes, and reads it; nothing half-written is seen
  files     other inputs have other files, whatever their families are called
  ahead     functions come in order, prepared in another process, with the same values
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from fnmatch import fnmatchcase
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
import pytest

from codegen.intervals import Cause, Permitted, permitted
from codegen.library import load_library
from conformance.check import ahead, prepared
from conformance.check.ahead import prepared_ahead
from conformance.check.draws import Draw, draws
from conformance.check.prepared import find_reference, has_reference, prepare, shared
from conformance.reference import ambiguous
from conformance.unit.support.sources import library_of

NAME = "half_vector"


def small(name: str = NAME) -> Any:
    return list(draws(load_library().function(name), 300, 40))


def equal(a: Any, b: Any) -> bool:
    return np.array_equal(a, b)


def test_prepared_values_are_those_of_direct_calls() -> None:
    library = load_library()
    ready = prepare(library, NAME, small())
    inputs = ready.sample.inputs
    reference = find_reference(library, library.function(NAME))
    assert reference is not None
    wanted = reference(*(v.astype(np.float64) for v in inputs.values()))
    assert equal(ready.truth.expected, wanted)
    assert equal(ready.truth.doubtful, ambiguous(NAME, inputs))
    allowed = permitted(library, NAME, inputs, "glsl")
    assert equal(ready.permitted("glsl").low, allowed.low)
    assert not equal(ready.permitted("opencl").high, allowed.high)
    assert ready.permitted("glsl") is ready.permitted("glsl")
    assert ready.truth is ready.truth


def test_costly_function_is_followed_in_part() -> None:
    library = load_library()
    name = next(n for n in library.public if fnmatchcase(n, prepared.COSTLY[0]))
    ready = prepare(library, name, small(name)[:1])
    found: Any = ready.permitted("wgsl")
    followed: Any = permitted(library, name, ready.sample.inputs, "wgsl")
    hull: Any = permitted(library, name, ready.sample.inputs, "wgsl", follow_forks=False)
    some = np.arange(ready.sample.lanes) % prepared.FOLLOWED == 0
    for wanted, lanes in ((followed, some), (hull, ~some)):
        assert equal(found.low[lanes], wanted.low[lanes]) and equal(found.high[lanes], wanted.high[lanes])
        assert equal(found.guaranteed[lanes], wanted.guaranteed[lanes])
        assert all(found.cause(k) == wanted.cause(k) for k in np.flatnonzero(lanes))


FORKS = """def probe(a: X, b: X) -> f32:
    x = a + b
    s = 1.0 if x >= 0.0 else -1.0
    return 1.0 / (s + x)
"""


def test_any_other_function_is_followed_on_every_lane(tmp_path: Path) -> None:
    library = library_of(tmp_path, FORKS)
    lanes = 3 * prepared.FOLLOWED
    a = np.full(lanes, 2.0**-127, np.float32)  # may be read as 0, so that the sign of a sum is open
    ready = prepare(library, "probe", [Draw("uniform", lanes, 1, {"a": a, "b": -a / 2})])
    found: Any = ready.permitted("wgsl")
    assert found.guaranteed.all()
    assert not permitted(library, "probe", ready.sample.inputs, "wgsl", follow_forks=False).guaranteed.any()


@pytest.mark.parametrize("lanes", [1, 3 * prepared.FOLLOWED])
def test_one_lane_of_so_many_is_followed_where_any_glob_names_a_function(
    lanes: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(prepared, "COSTLY", ("another*", "prob*"))
    a = np.full(lanes, 2.0**-127, np.float32)
    ready = prepare(library_of(tmp_path, FORKS), "probe", [Draw("uniform", lanes, 1, {"a": a, "b": -a / 2})])
    found: Any = ready.permitted("wgsl")
    assert np.flatnonzero(found.guaranteed).tolist() == list(range(0, lanes, prepared.FOLLOWED))


def test_truth_without_a_reference_names_the_function(tmp_path: Path) -> None:
    one = np.ones(1, np.float32)
    ready = prepare(library_of(tmp_path, FORKS), "probe", [Draw("uniform", 1, 1, {"a": one, "b": one})])
    with pytest.raises(KeyError, match="probe"):
        _ = ready.truth


def test_narrower_intervals_bring_their_causes_along() -> None:
    """Codes of the lanes that are replaced count on after those of all lanes; 0 stays bounded."""
    first, second, third = (Cause("f", line, "/", "y", "the divisor may be 0") for line in (1, 2, 3))
    ends = np.array([0.0, 1.0, 2.0, 3.0])
    whole = Permitted(ends, ends + 4.0, np.array([1, 0, 1, 1], np.int16), (first,))
    part = Permitted(ends[:3] + 1.0, ends[:3] + 2.0, np.array([0, 1, 2], np.int16), (second, third))
    found: Any = prepared.narrowed(whole, np.array([0, 1, 2]), part)
    assert found.low.tolist() == [1.0, 2.0, 3.0, 3.0]
    assert found.high.tolist() == [2.0, 3.0, 4.0, 7.0]
    assert [found.cause(k) for k in range(4)] == ["", str(second), str(third), str(first)]


def test_fields_of_structs_are_replaced_each() -> None:
    ends, codes = np.array([0.0, 1.0, 2.0]), np.zeros(3, np.int16)
    whole = Permitted({"near": ends, "far": -ends}, {"near": ends + 9.0, "far": 9.0 - ends}, codes, ())
    zero = ends[:1]
    part = Permitted({"near": zero + 3, "far": zero - 3}, {"near": zero + 4, "far": zero}, codes[:1], ())
    found: Any = prepared.narrowed(whole, np.array([2]), part)
    assert {name: a.tolist() for name, a in found.low.items()} == {"near": [0, 1, 3], "far": [0, -1, -3]}
    assert {name: a.tolist() for name, a in found.high.items()} == {"near": [9, 10, 4], "far": [9, 8, 0]}


def test_costly_function_is_not_followed_on_all_lanes(monkeypatch: pytest.MonkeyPatch) -> None:
    library = load_library()
    name = next(n for n in library.public if fnmatchcase(n, prepared.COSTLY[0]))
    ready = prepare(library, name, small(name)[:1])
    called: list[tuple[int, bool]] = []

    def watched(library: Any, name: str, inputs: Any, table: str, follow_forks: bool = True) -> Any:
        called.append((len(next(iter(inputs.values()))), follow_forks))
        return permitted(library, name, inputs, table, follow_forks=False)

    monkeypatch.setattr(prepared, "permitted", watched)
    ready.permitted("wgsl")
    lanes = ready.sample.lanes
    assert called == [(lanes, False), (-(-lanes // prepared.FOLLOWED), True)]


def test_printed_form_has_a_reference_of_its_own_or_none() -> None:
    library = load_library()
    assert all(has_reference(library, name) for name in library.public)


@pytest.mark.parametrize("name", [NAME, "sin_angle"])
def test_other_process_reads_what_the_first_one_left(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    library = load_library()
    first = prepare(library, name, small(name), tmp_path)
    expected, low = first.truth.expected, first.permitted("wgsl").low
    monkeypatch.setattr(prepared, "expected_of", lambda *_: pytest.fail("computed again"))
    monkeypatch.setattr(prepared, "permitted", lambda *_: pytest.fail("computed again"))
    second = prepare(library, name, small(name), tmp_path)
    assert equal(second.truth.expected, expected)
    assert equal(second.permitted("wgsl").low, low)
    other = prepare(library, name, small(name)[:1], tmp_path)
    with pytest.raises(pytest.fail.Exception):
        _ = other.truth
    assert {p.suffix for p in tmp_path.iterdir()} == {".pickle", ".lock"}


def test_other_inputs_have_other_files(tmp_path: Path) -> None:
    """Whatever families are called: the digit at the end of one is none of its count."""
    inputs = small()[0].inputs
    drawn = [
        (("near", 12),),
        (("near1", 2),),
        (("near", 1), ("", 2)),
        (("near", 12), ("near1", 2)),
        ((".12", 1),),
    ]
    keys = {
        prepare(
            load_library(), NAME, [Draw(family, count, 1, inputs) for family, count in some], tmp_path
        ).key
        for some in drawn
    }
    assert len(keys) == len(drawn)


def test_nothing_half_written_is_shared(tmp_path: Path) -> None:
    path = tmp_path / "value.pickle"

    def interrupted() -> Any:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        shared(path, interrupted)
    assert not path.exists()
    assert shared(path, lambda: 7) == 7
    assert shared(path, lambda: 8) == 7


def test_who_comes_second_waits_for_the_first(tmp_path: Path) -> None:
    path, begun, go_on = tmp_path / "value.pickle", Event(), Event()

    def slowly() -> int:
        begun.set()
        assert go_on.wait(60.0)
        return 7

    with ThreadPoolExecutor(2) as pool:
        first = pool.submit(shared, path, slowly)
        assert begun.wait(60.0)
        second = pool.submit(shared, path, lambda: 8)
        with pytest.raises(TimeoutError):
            second.result(0.1)
        go_on.set()
        assert (first.result(60.0), second.result(60.0)) == (7, 7)


@pytest.mark.parametrize("worthwhile", [1, 99], ids=["in another process", "here"])
def test_functions_come_in_order_whoever_prepares_them(
    worthwhile: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ahead, "WORTHWHILE", worthwhile)
    names = ["safe_sqrt", "unit_float"]
    library = load_library()
    for (name, ready), wanted in zip(prepared_ahead(library, names, ["glsl"]), names, strict=True):
        assert (name, ready.name) == (wanted, wanted)
        plain = prepare(library, name)
        assert equal(ready.truth.expected, plain.truth.expected)
        assert equal(ready.permitted("glsl").low, plain.permitted("glsl").low)
