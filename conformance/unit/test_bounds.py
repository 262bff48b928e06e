"""Declared bounds are read as they are written. (Files of a wrong shape: test_emit.)"""

from typing import Any

import pytest

from codegen.bounds import Bound, read_bounds
from codegen.errors import UserError

LEAST: dict[str, Any] = {"measure": "absolute", "bound": 1e-6, "domain": "all", "origin": "here"}


def read(**changes: Any) -> Bound:
    (found,) = read_bounds("file", {"probe": [{**LEAST, **changes}]})["probe"]
    return found


def test_entry_is_read_with_its_defaults() -> None:
    assert read() == Bound("probe", "absolute", 1e-6, "all", "here", 0.0, {}, "", ())
    assert read() == Bound("probe", "absolute", 1e-6, "all", "here")


def test_every_key_arrives() -> None:
    found = read(
        measure="relative",
        bound=2,
        floor=3,
        where={"x": [1, 4], "length(a)": [0, 2.5]},
        field="f",
        targets=["glsl"],
    )
    where = {"x": (1.0, 4.0), "length(a)": (0.0, 2.5)}
    assert found == Bound("probe", "relative", 2.0, "all", "here", 3.0, where, "f", ("glsl",))
    assert isinstance(found.bound, float)
    assert isinstance(found.where["x"][0], float)


def test_functions_and_entries_keep_their_order() -> None:
    found = read_bounds("file", {"b": [LEAST, {**LEAST, "bound": 2.0}], "a": [LEAST]})
    assert list(found) == ["b", "a"]
    assert [entry.bound for entry in found["b"]] == [1e-6, 2.0]
    assert {entry.function for entry in found["b"]} == {"b"}


def test_exact_needs_no_number() -> None:
    found = read_bounds("file", {"probe": [{"measure": "exact", "domain": "all", "origin": "here"}]})
    assert found["probe"][0].bound == 0.0


DESCRIBED: dict[str, dict[str, Any]] = {
    "absolute <= 1e-6: all": {},
    "relative <= 1e-6: all": {"measure": "relative"},
    "relative <= 1e-6 (floor 0.25): all": {"measure": "relative", "floor": 0.25},
    "absolute <= 1e-6: all, glsl and wgsl only": {"targets": ["glsl", "wgsl"]},
    "f: absolute <= 1e-6: all": {"field": "f", "floor": 0.25},
    "exact (all)": {"measure": "exact"},
    "f: exact (all)": {"measure": "exact", "field": "f"},
}


@pytest.mark.parametrize("text", DESCRIBED)
def test_description(text: str) -> None:
    assert read(**DESCRIBED[text]).describe() == text


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "a bound needs its number": ({"bound": None}, "bound"),
    "a bound needs measure": ({"measure": None}, "measure"),
    "a bound needs domain": ({"domain": None}, "domain"),
    "a bound needs origin": ({"origin": None}, "origin"),
    'unknown key "floors"; did you mean "floor"': ({"floors": 1.0}, ""),
    'unknown measure "exakt"; did you mean "exact"': ({"measure": "exakt"}, ""),
    "domain is ASCII": ({"domain": "\u00fc"}, ""),
    "origin is ASCII": ({"origin": "\u00fc"}, ""),
    "a value has the wrong type": ({"where": {"x": 1.0}}, ""),
}


@pytest.mark.parametrize("sentence", REFUSED)
def test_refusal_names_file_function_and_fault(sentence: str) -> None:
    changes, dropped = REFUSED[sentence]
    entry = {k: v for k, v in {**LEAST, **changes}.items() if k != dropped}
    with pytest.raises(UserError) as caught:
        read_bounds("file", {"probe": [entry]})
    assert str(caught.value).startswith(f"file: probe: {sentence}")


def test_several_faults_are_told_in_the_order_of_the_keys() -> None:
    odd = "\u00fc"
    for entry, sentence in (
        ({}, "a bound needs measure, domain, origin"),
        ({**LEAST, "domain": odd, "origin": odd}, "domain is ASCII: it is emitted into shaders"),
    ):
        with pytest.raises(UserError) as caught:
            read_bounds("file", {"probe": [entry]})
        assert str(caught.value) == f"file: probe: {sentence}"


@pytest.mark.parametrize("entries", [1.0, {"bound": 1.0}, [LEAST, 1.0], "text"])
def test_bounds_are_lists_of_tables(entries: Any) -> None:
    with pytest.raises(UserError, match=r"file: probe: bounds are tables, written \[\[probe\]\]"):
        read_bounds("file", {"probe": entries})
