"""What is said of parameters, at its edges: paths that begin alike, arrays, slack, ends that touch.

Plan. Beside test_passes_subject, one function with parameters that are easily confused.
  paths      a name that begins as another one does is another parameter; structs are known by their fields
  arrays     rows in order or by number, each held to its kind and domain, and told by its number
  slack      a constant may miss its domain by the rounding of a float32, in proportion to the ends, on
             either side, in each component
  mistakes   the first one in the order constants, equals, ranges is told
"""

from __future__ import annotations

from dataclasses import replace
from math import inf
from typing import Any

import numpy as np
import pytest

from codegen.errors import UserError
from codegen.ir import nodes as ir
from codegen.ir.domains import Finite, Interval, Unit
from codegen.ir.types import F32, I32, UVEC2, VEC3, array_of
from codegen.library import Library
from codegen.passes.ssa.values import PARAMETER, Hint, Values, constant_components
from codegen.passes.subject import Fact, Subject
from conformance.unit.support.sources import library_of

SOURCE = '''
@struct
class Pair:
    """A pair."""

    first: X
    second: X


def f(
    a: Annotated[f32, Interval(0.0, 1.0)],
    ab: Annotated[f32, Interval(1.0, 2.0)],
    wide: Annotated[f32, Interval(-100.0, 1.0)],
    high: Annotated[f32, Interval(10.0, 100.0)],
    below: Annotated[f32, Interval(-100.0, -10.0)],
    share: Annotated[vec3, Interval(0.0, 1.0)],
    d: D,
    w: Annotated[vec3, Length(1.0, 3.0)],
    pair: Pair,
    pair_b: Pair,
) -> f32:
    """F."""
    return a + ab + wide + high + below + dot(share, d) + dot(w, d) + pair.first + pair_b.second
'''


@pytest.fixture(scope="module")
def function(tmp_path_factory: pytest.TempPathFactory) -> ir.Function:
    return library_of(tmp_path_factory.mktemp("given"), SOURCE).function("f")


def test_paths_that_begin_alike_are_others(function: ir.Function) -> None:
    for one, other in (("a", "ab"), ("ab", "a"), ("pair", "pair_b"), ("pair_b", "pair")):
        assert Subject(function, {}, {one: other}).aliases == {one: other}
    values = Values()
    given = Subject(function, {"pair": {"first": 1.0, "second": 2.0}}).arguments(values)
    assert given["pair"] == {"first": ir.Const(F32, 1.0), "second": ir.Const(F32, 2.0)}
    assert given["pair_b"] == {key: ir.Var(F32, f"pair_b.{key}") for key in ("first", "second")}


def test_structs_are_known_by_their_fields(function: ir.Function) -> None:
    values = Values()
    Subject(function).arguments(values)
    assert list(values.parameters) == [
        *("a", "ab", "wide", "high", "below", "share", "d", "w"),
        *("pair.first", "pair.second", "pair_b.first", "pair_b.second"),
    ]
    assert values.parameters["a"] == ir.Parameter("a", F32, Interval(0.0, 1.0))


def test_domains_that_touch_have_a_number_in_common(function: ir.Function) -> None:
    assert Subject(function, {}, {"a": "ab"}).domains["ab"] == Interval(1.0, 1.0)
    assert Subject(function, {}, {"ab": "a"}).domains["a"] == Interval(1.0, 1.0)
    for one, other in (("high", "a"), ("a", "high")):
        with pytest.raises(UserError, match=f'"{one}" .* cannot be "{other}"'):
            Subject(function, {}, {one: other})


TAKEN: list[tuple[str, Any]] = [
    ("high", 100.00005),
    ("high", 9.99995),
    ("wide", -100.00005),
    ("wide", 1.00005),
    ("below", -100.00005),
    ("below", -9.99995),
    ("a", -5e-7),
    ("share", (0.0, 1.0, 0.5)),
    ("share", (1.0 + 5e-7, -5e-7, 0.0)),
    ("d", (1.0 - 9e-7, 0.0, 0.0)),
    ("w", (3.0000019, 0.0, 0.0)),
    ("w", (0.9999995, 0.0, 0.0)),
]
LEFT: list[tuple[str, Any, str]] = [
    ("high", 100.001, r"in \[10, 100\]"),
    ("high", 9.999, r"in \[10, 100\]"),
    ("wide", -100.001, r"in \[-100, 1\]"),
    ("wide", 1.001, r"in \[-100, 1\]"),
    ("a", 1.0 + 2e-6, r"in \[0, 1\]"),
    ("a", -2e-6, r"in \[0, 1\]"),
    ("share", (0.5, 0.5, 1.1), r"in \[0, 1\]"),
    ("share", (-0.5, 0.5, 0.5), r"in \[0, 1\]"),
    ("d", (1.0 + 1.6e-6, 0.0, 0.0), "unit vector"),
    ("d", (1.0 - 1.6e-6, 0.0, 0.0), "unit vector"),
    ("d", (0.5, 0.0, 0.0), "unit vector"),
    ("d", (0.0, 0.0, 0.0), "unit vector"),
    ("w", (3.00001, 0.0, 0.0), "length"),
    ("w", (0.99999, 0.0, 0.0), "length"),
]


@pytest.mark.parametrize(("path", "value"), TAKEN, ids=str)
def test_rounding_may_leave_a_domain(path: str, value: Any, function: ir.Function) -> None:
    found = Subject(function, {path: value}).arguments(Values())[path]
    assert not isinstance(found, dict)
    assert constant_components(found) == tuple(np.atleast_1d(np.float32(value)).tolist())


@pytest.mark.parametrize(("path", "value", "domain"), LEFT, ids=str)
def test_more_may_not(path: str, value: Any, domain: str, function: ir.Function) -> None:
    with pytest.raises(UserError, match=rf"^f: {path} is .*, which is (not|no) .*{domain}"):
        Subject(function, {path: value}).arguments(Values())


def test_first_mistake_is_told(function: ir.Function) -> None:
    def told(*known: dict[str, Any]) -> str:
        with pytest.raises(UserError) as error:
            Subject(function, *known)
        return str(error.value)

    assert '"one"' in told({"one": 1.0}, {"two": "a"}, {"three": (0.0, 1.0)})
    assert '"two"' in told({}, {"two": "a"}, {"three": (0.0, 1.0)})
    assert '"three"' in told({}, {}, {"three": (0.0, 1.0)})
    assert '"nobody"' in told({}, {"a": "nobody"})
    assert "is a vec3 and cannot be" in told({"d": (1.0, 0.0, 0.0)}, {"d": "a"})
    assert "as a constant and as" in told({"a": 1.0}, {"a": "ab"})
    assert told({}, {"a": "a"}) == 'f: "a" cannot be given as equal to itself'


def test_facts_without_an_end_are_open_there(function: ir.Function) -> None:
    subject = Subject(function)
    for fact, ends in (
        (Fact("a"), (-inf, inf)),
        (Fact("a", low=0.5), (0.5, inf)),
        (Fact("a", high=0.5), (-inf, 0.5)),
        (Fact("a", 0.5, 0.5), (0.5, 0.5)),
    ):
        assert subject.fact(Values(), fact) == (ir.Var(F32, "a"), *ends)


def test_wrong_facts_are_told_in_a_sentence(function: ir.Function) -> None:
    def told(fact: Fact) -> str:
        with pytest.raises(UserError) as error:
            Subject(function).fact(Values(), fact)
        return str(error.value)

    assert told(Fact("a", 1.0, 0.0)) == 'f: fact "a": nothing is at least 1 and at most 0'
    assert told(Fact("pair")) == 'f: fact "pair": pair is a Pair'
    assert told(Fact("a +")) == 'f: fact "a +" is no expression of built-ins and parameters'
    unknown = told(Fact("six + five + four * three - two + one"))
    assert unknown.startswith('unknown parameter in f: fact "six + five'), "the first by its letters"
    assert '"five"' in unknown


def test_numbers_of_every_kind(function: ir.Function) -> None:
    values = Values()
    found = Subject(function, {"pair": {"first": -0.0, "second": 2}}).arguments(values)["pair"]
    assert isinstance(found, dict)
    assert [repr(e.value) for e in found.values() if isinstance(e, ir.Const)] == ["0.0", "2.0"]
    for given, sentence in (
        ((1.0, None, 0.0), "(1.0, None, 0.0) is no vec3"),
        ((0.0, {}, 1.0), "(0.0, {}, 1.0) is no vec3"),
        ((0.5, inf, 0.5), "(0.5, inf, 0.5) is no finite float32"),
        (("a", "b", "c"), "('a', 'b', 'c') is no vec3"),
    ):
        with pytest.raises(UserError) as error:
            Subject(function, {"share": given}).arguments(values)
        assert str(error.value) == f"f: share: {sentence}"


@pytest.fixture(scope="module")
def rows(function: ir.Function, tmp_path_factory: pytest.TempPathFactory) -> ir.Function:
    """A function of an array of shares and one of directions, as passes and scenes make them."""
    library: Library = library_of(tmp_path_factory.mktemp("rows"), "def g(x: X) -> f32:\n    return x\n")
    return replace(
        library.function("g"),
        parameters=(
            ir.Parameter("x", F32, Finite()),
            ir.Parameter("sky.shares", array_of(F32, 2), Interval(0.0, 1.0)),
            ir.Parameter("lights", array_of(VEC3, 2), Unit()),
            ir.Parameter("cell", UVEC2, None),
        ),
    )


def test_facts_of_arrays_hold_for_every_row(rows: ir.Function) -> None:
    e, low, high = Subject(rows).fact(Values(), Fact("sky.shares", 0.25, 0.5))
    assert e == ir.Index(F32, ir.Var(array_of(F32, 2), "sky.shares"), ir.Var(I32, "any element"))
    assert (low, high) == (0.25, 0.5)


def one(value: float) -> ir.Const:
    return ir.Const(F32, value)


@pytest.mark.parametrize("given", [[0.5, 0.25], (0.5, 0.25), {"0": 0.5, "1": 0.25}, np.array([0.5, 0.25])])
def test_arrays_are_given_row_by_row(given: Any, rows: ir.Function) -> None:
    values = Values()
    made = Subject(rows, {"sky.shares": given}).arguments(values)["sky.shares"]
    assert made == ir.Construct(array_of(F32, 2), (one(0.5), one(0.25)))
    assert values.hints[id(made)] == Hint(PARAMETER, "shares")


def test_arrays_of_directions(rows: ir.Function) -> None:
    values = Values()
    made = Subject(rows, {"lights": [(0.0, 0.0, 1.0), (0.6, 0.0, 0.8)]}).arguments(values)["lights"]
    assert isinstance(made, ir.Construct)
    assert made.args[0] == ir.Construct(VEC3, (one(0.0), one(0.0), one(1.0)))
    assert values.hints[id(made)] == Hint(PARAMETER, "lights")


@pytest.mark.parametrize(
    ("path", "given", "sentence"),
    [
        ("sky.shares", [0.5], "g: sky.shares needs 2 elements"),
        ("sky.shares", [0.5, 0.5, 0.5], "g: sky.shares needs 2 elements"),
        ("sky.shares", 0.5, "g: sky.shares needs 2 elements"),
        ("sky.shares", {"0": 0.5}, "g: sky.shares needs 2 elements"),
        ("sky.shares", [0.5, "high"], "g: sky.shares[1]: 'high' is no f32"),
        ("sky.shares", [0.5, 1.5], "g: sky.shares[1] is 1.5, which is not in [0, 1]"),
        ("cell", (1, -1), "g: cell: (1, -1) is no u32"),
        ("lights", [(1.0, 1.0, 0.0), (0.6, 0.0, 0.8)], "g: lights[0] is (1, 1, 0), which is no unit vector"),
    ],
)
def test_wrong_rows_are_told_by_their_number(path: str, given: Any, sentence: str, rows: ir.Function) -> None:
    with pytest.raises(UserError) as error:
        Subject(rows, {path: given}).arguments(Values())
    assert str(error.value) == sentence
