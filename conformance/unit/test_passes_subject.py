"""What may be said of a function's parameters, and what becomes of it: constants, equals, ranges, facts.

Plan. One function with a parameter of every kind. (Mistakes in a function of the library:
test_specialise_refusals.)
  constants  each kind at the ends of its type and of its domain, and just beyond
  equals     a parameter that stands for another one lies in both domains
  ranges     narrow what is known; ends that are the domain's own are taken
  log        says what was given, in the words of a person
  result     names, documentation and domains of the parameters that are left
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.ir.domains import Finite, Interval, Unit
from codegen.library import Library
from codegen.passes.specialise import Specialised, specialise
from codegen.passes.subject import Subject
from conformance.unit.support.sources import library_of

SOURCE = '''
@struct
class Pair:
    """A pair.

    first    a share
    second   a direction
    """

    first: Annotated[f32, Interval(0.0, 1.0)]
    second: D


def f(
    s: Annotated[f32, Interval(0.0, 1.0)],
    t: Annotated[f32, Interval(0.5, 4.0, scale="log")],
    high: Annotated[f32, Interval(7.0, 9.0)],
    x: X,
    d: D,
    e: D,
    v: V,
    w: Annotated[vec3, Length(1.0, 3.0)],
    n: u32,
    k: i32,
    p: bool,
    pair: Pair,
    other: Pair,
    map: Annotated[Texture, Edges("clamp", "repeat")],
) -> f32:
    """A function of everything.

    s        a share
    t        another number
    high      a number further up
    x        any number
    d        a direction
    e        another direction
    v        any vector
    w        a vector of some length
    n        a count
    k        a number with a sign
    p        a truth value
    pair     a pair
    other    another pair
    map      a map
    returns  something of all of them
    source   this test
    """
    scaled = s * t + high * x + dot(d, v) * dot(e, w) + f32(n) - f32(k)
    parts = pair.first * dot(pair.second, v) - other.first * dot(other.second, e)
    return (scaled if p else parts) + lookup(map, vec2(s, t)).x
'''


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Library:
    return library_of(tmp_path_factory.mktemp("subject"), SOURCE)


def made(library: Library, **known: Any) -> Specialised:
    return specialise(library, "f", new_name="g", **known)


ACCEPTED: dict[str, list[Any]] = {
    "s": [0.0, 1.0, 1.0 + 5e-7, -5e-7, np.float32(0.5), [0.25]],
    "t": [0.5, 4.0],
    "x": [-3.4028234663852886e38, 0, 1e-45, -0.0],
    "d": [(1.0, 0.0, 0.0), (0.6, 0.0, 0.8), np.array([0.0, -1.0, 0.0]), [1.0 + 9e-7, 0.0, 0.0]],
    "v": [(1e30, 0.0, -7.0)],
    "w": [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 3.0, 0.0), (2.0, 0.0, 2.0)],
    "n": [0, 2**32 - 1, np.uint32(5)],
    "k": [-(2**31), 2**31 - 1],
    "p": [True, False, np.bool_(True)],
    "pair": [{"first": 0.5, "second": (0.0, 0.0, 1.0)}],
    "pair.first": [1.0],
}
REFUSED: dict[str, list[tuple[Any, str]]] = {
    "s": [
        (1.25, r"f: s is 1\.25, which is not in \[0, 1\]"),
        (1.0001, "which is not in"),
        (-0.0001, "which is not in"),
        (None, "None is no f32"),
        ("1", "'1' is no f32"),
        ([], r"\[\] is no f32"),
        ([0.5, 0.5], "is no f32"),
        ([[0.5]], "is no f32"),
        ({}, "is no f32"),
    ],
    "x": [
        (float("inf"), "is no finite float32"),
        (float("nan"), "is no finite float32"),
        (1e39, "is no finite float32"),
    ],
    "d": [
        ((1.0, 1.0, 0.0), r"d is \(1, 1, 0\), which is no unit vector"),
        ((1.00001, 0.0, 0.0), "no unit vector"),
        ((1.0, 0.0), "is no vec3"),
        ([[1.0, 0.0, 0.0]], "is no vec3"),
        ([1.0, [0.0, 0.0]], "is no vec3"),
        ((1.0, 0.0, "0"), "is no vec3"),
    ],
    "w": [
        ((0.5, 0.0, 0.0), r"w is \(0\.5, 0, 0\), which is not length in \[1, 3\]"),
        ((0.0, 3.1, 0.0), "which is not length"),
    ],
    "n": [(-1, "-1 is no u32"), (2**32, "is no u32"), (1.5, "1.5 is no u32"), (True, "True is no u32")],
    "k": [(2**31, "is no i32"), (-(2**31) - 1, "is no i32"), (0.5, "0.5 is no i32"), (False, "is no i32")],
    "p": [(1, "1 is no truth value"), (0.0, "is no truth value"), ("yes", "'yes' is no bool")],
    "pair": [
        (1.0, "pair is a Pair: give its fields"),
        ({"first": 0.5}, "pair lacks second"),
        ({"first": 2.0, "second": (0.0, 0.0, 1.0)}, r"pair\.first is 2|pair is 2"),
        ({"first": 0.5, "second": (0.0, 0.0, 1.0), "third": 1}, 'unknown field of pair "third"'),
    ],
    "map": [(1.0, "map is a map, which no constant can be")],
    "pear": [(1.0, 'unknown parameter of f "pear"; did you mean "pair"')],
}


@pytest.mark.parametrize(
    ("path", "value"), [(p, v) for p, values in ACCEPTED.items() for v in values], ids=str
)
def test_constant_inside_its_domain_is_taken(path: str, value: Any, library: Library) -> None:
    found = made(library, constants={path: value})
    assert not any(p == path or p.startswith(f"{path}.") for p in found.parameters)
    assert any(s.name == "substitute" and s.what.startswith(f"{path} = ") for s in found.log)


@pytest.mark.parametrize(
    ("path", "value", "sentence"), [(p, v, s) for p, rows in REFUSED.items() for v, s in rows], ids=str
)
def test_other_constants_are_refused(path: str, value: Any, sentence: str, library: Library) -> None:
    with pytest.raises(UserError, match=sentence):
        made(library, constants={path: value})


def test_log_says_what_was_given(library: Library) -> None:
    found = made(
        library,
        constants={
            "x": 0.5,
            "d": (0.0, -1.0, 0.0),
            "p": True,
            "n": 7,
            "pair": {"first": 0.25, "second": (0.0, 0.0, 1.0)},
        },
        aliases={"other.second": "e"},
        facts=[("dot(e, v)", 0.05, 1.0)],
    )
    steps = {s.what: s.why for s in found.log if s.name in ("substitute", "facts")}
    assert steps == {
        "x = 0.5": "given as a constant",
        "d = (0, -1, 0)": "given as a constant",
        "p = true": "given as a constant",
        "n = 7": "given as a constant",
        "pair = {first = 0.25, second = (0, 0, 1)}": "given as a constant",
        "other.second = e": "given as equal",
        "dot(e, v) in [0.05, 1]": "given",
    }
    gone = [s.what for s in found.log if s.name == "dead"]
    assert gone == ["parameter other.first is gone"]
    assert {s.why for s in found.log if s.name == "dead"} == {"nothing that is left uses it"}


def test_equal_parameters_lie_in_both_domains(library: Library) -> None:
    function = library.function("f")
    both = Subject(function, {}, {"s": "t"})
    assert both.domains["t"] == Interval(0.5, 1.0, scale="log")
    assert Subject(function, {}, {"t": "s"}).domains["s"] == Interval(0.5, 1.0)
    assert Subject(function, {}, {"x": "s"}).domains["s"] == Interval(0.0, 1.0)
    assert Subject(function, {}, {"s": "x"}).domains["x"] == Interval(0.0, 1.0)
    assert Subject(function, {}, {"v": "d"}).domains["d"] == Unit()
    assert Subject(function, {}, {"d": "v"}).domains["v"] == Unit()
    assert Subject(function, {}, {"e": "w"}).domains["w"] == Unit()
    assert Subject(function, {}, {"v": "w"}).domains["w"] != Finite()
    with pytest.raises(UserError, match=r'"s" \(in \[0, 1\]\) cannot be "high" \(in \[7, 9\]\)'):
        Subject(function, {}, {"s": "high"})
    narrowed = Subject(function, {}, {"s": "t"}, {"t": (0.75, 2.0)})
    assert narrowed.domains["t"] == Interval(0.75, 1.0, scale="log", least=0.75)
    assert narrowed.domains["s"] == Interval(0.0, 1.0)


def test_struct_stands_for_a_struct(library: Library) -> None:
    found = made(library, aliases={"other": "pair"})
    assert "pair.first" in found.parameters
    assert not any(path.startswith("other") for path in found.parameters)


RANGES: dict[str, tuple[tuple[float, float], str]] = {
    "s": ((0.0, 1.0), ""),
    "t": ((1.0, 1.0), ""),
    "x": ((-5.0, 5.0), ""),
    "v": ((-1.0, 1.0), ""),
    "n": ((0, 7), ""),
    "k": ((-3, 3), ""),
    "pair.first": ((0.25, 0.5), ""),
    "high": ((6.9, 8.0), r"the range \[6\.9, 8\] leaves the domain, in \[7, 9\]"),
    "d": ((0.0, 1.0), "is a vec3 and has no range"),
    "w": ((0.0, 1.0), "is a vec3 and has no range"),
    "p": ((0, 1), "is a bool and has no range"),
    "pair": ((0.0, 1.0), "is a Pair and has no range"),
}


@pytest.mark.parametrize("path", RANGES)
def test_range_narrows_a_number(path: str, library: Library) -> None:
    ends, sentence = RANGES[path]
    if sentence:
        with pytest.raises(UserError, match=sentence):
            made(library, ranges={path: ends})
        return
    found = Subject(library.function("f"), {}, {}, {path: ends}).domains[path]
    assert isinstance(found, Interval)
    assert (found.low, found.high) == ends


@pytest.mark.parametrize(
    ("ends", "sentence"),
    [
        ((float("-inf"), 1.0), "a range has finite ends"),
        ((0.0, float("nan")), "a range has finite ends"),
        ((2.0, 1.0), "the range starts at 2 and ends below, at 1"),
    ],
)
def test_range_with_wrong_ends_is_refused(ends: tuple[float, float], sentence: str, library: Library) -> None:
    with pytest.raises(UserError, match=f"^f: x.*{sentence}$"):
        made(library, ranges={"x": ends})


@pytest.mark.parametrize(
    "given", [{"constants": {"x": 1.0}}, {"aliases": {"x": "s"}}], ids=["constant", "equal"]
)
def test_range_of_what_is_no_parameter_is_refused(given: dict[str, Any], library: Library) -> None:
    with pytest.raises(UserError, match="has a range although it is not a parameter any more"):
        made(library, ranges={"x": (0.0, 1.0)}, **given)


def test_least_of_a_logarithmic_range_stays_inside_it(library: Library) -> None:
    function = library.function("f")
    assert Subject(function, {}, {}, {"t": (1.0, 2.0)}).domains["t"] == Interval(1.0, 2.0, "log", 1.0)


@pytest.mark.parametrize(
    ("fact", "sentence"),
    [
        (("pair + 1.0", 0.0, 1.0), "pair is a Pair"),
        (("x +", 0.0, 1.0), "is no expression of built-ins and parameters"),
        (("sine(x)", 0.0, 1.0), "is no expression of built-ins and parameters"),
        (("cross(x, x)", 0.0, 1.0), "is no expression of built-ins and parameters"),
        (("[x]", 0.0, 1.0), "is no expression of built-ins and parameters"),
        (("s * y", 0.0, 1.0), 'unknown parameter in .* "y"'),
        (("x", 1.0, 0.0), "nothing is at least 1 and at most 0"),
        (("s", 2.0, 3.0), "contradicts the ranges, which give"),
    ],
)
def test_wrong_fact_is_refused(fact: tuple[str, float, float], sentence: str, library: Library) -> None:
    with pytest.raises(UserError, match=sentence):
        made(library, facts=[fact])


def test_fact_of_constants_is_compared_with_them(library: Library) -> None:
    known = {"s": 0.5}
    made(library, constants=known, facts=[("s", 0.5, 0.5), ("s * 2.0", 0.9, 1.1)])
    for fact in (("s", 0.6, 1.0), ("s", 0.0, 0.4), ("s * 2.0", 1.1, 2.0)):
        with pytest.raises(UserError, match=r"contradicts the constants, which make it (0\.5|1)$"):
            made(library, constants=known, facts=[fact])


def test_what_is_left_keeps_its_names_domains_and_words(library: Library) -> None:
    found = made(library, constants={"p": False, "other.first": 0.5}, ranges={"pair.first": (0.25, 0.5)})
    assert found.parameters == {
        "s": "s",
        "t": "t",
        "e": "e",
        "v": "v",
        "pair.first": "first",
        "pair.second": "pair_second",
        "other.second": "other_second",
        "map": "map",
    }
    by_name = {p.name: p for p in found.function.parameters}
    assert by_name["first"].domain == Interval(0.25, 0.5, least=0.25)
    assert by_name["pair_second"].domain == Unit()
    assert by_name["t"].domain == Interval(0.5, 4.0, scale="log")
    entries = found.function.doc.entries
    assert entries["first"] == "a share"
    assert entries["other_second"] == "a direction"
    assert entries["v"] == "any vector"
    assert entries["returns"] == "something of all of them"
    assert entries["source"] == "this test"
    assert "x" not in entries
    assert set(found.dropped) == {"high", "x", "d", "w", "n", "k", "p", "other.first"}
    assert found.function.name == "g"
    assert specialise(library, "f").function.name == "f_specialised"


def test_arguments_and_imposed_inputs_fit(library: Library) -> None:
    found = made(library, constants={"pair.second": (0.0, 0.0, 1.0), "p": True}, aliases={"e": "d"})
    lanes = 3
    up = np.tile(np.array([0.0, 1.0, 0.0], np.float32), (lanes, 1))
    numbers = {name: np.full(lanes, 0.75, np.float32) for name in ("s", "t", "x")}
    inputs: dict[str, Any] = {
        **numbers,
        "high": np.full(lanes, 8.0, np.float32),
        **dict.fromkeys(("d", "e", "v", "w"), up),
        "n": np.full(lanes, 3, np.uint32),
        "k": np.full(lanes, -3, np.int32),
        "p": np.zeros(lanes, np.bool_),
        "pair": {"first": numbers["s"], "second": up},
        "other": {"first": numbers["s"], "second": up},
        "map": np.ones((2, 2, 4), np.float32),
    }
    imposed = found.impose(inputs)
    assert imposed["pair"]["second"] == (0.0, 0.0, 1.0)
    assert inputs["pair"]["second"] is up
    assert imposed["p"] is True
    special = evaluate(library.with_functions([found.function]), "g", found.arguments(imposed), "float64")
    general = evaluate(library, "f", imposed, "float64")
    assert isinstance(special, np.ndarray)
    np.testing.assert_array_equal(special, general)


def test_variant_of_another_shape_is_refused(library: Library, tmp_path: Path) -> None:
    text = (
        "@helper\ndef one(x: X) -> f32:\n    return x\n"
        "@helper\ndef two(x: X, y: X) -> f32:\n    return x + y\n"
        "@helper\ndef three(x: X) -> vec2:\n    return vec2(x)\n@helper\ndef four(y: X) -> f32:\n"
        "    return y * 2.0\ndef f(x: X) -> f32:\n    return one(x)\n"
    )
    several = library_of(tmp_path, text)
    for other in ("two", "three"):
        with pytest.raises(UserError, match=f'"{other}" takes other parameters than "one"'):
            specialise(several, "f", variants={"one": other})
    found = specialise(several, "f", variants={"one": "four"}, new_name="g")
    got = evaluate(several.with_functions([found.function]), "g", {"x": np.array([1.5], np.float32)})
    assert got == np.array([3.0], np.float32)
    assert ("one -> four", "asked for") in [(s.what, s.why) for s in found.log if s.name == "variants"]
    whole = specialise(several, "one", variants={"one": "four"}, new_name="g")
    assert list(whole.parameters) == ["y"]
