"""What specialising gives besides a body: names, places, documentation, inputs, and which rules are tried.

Plan.
  names     a path's last part where that is unambiguous, else the whole path; never a reserved word
  told      which parameters are gone and why; paths that begin alike are others
  inputs    constants and equals are put in at every depth, and arguments found there
  words     summary and entries of what is left, in order; the place and lines of the source
  rules     cancellation only where reals are asked for, loops to the depth asked for, powers only when asked
  facts     beside constants to within a rounding, in every component; met in order
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from codegen.errors import Place, UserError
from codegen.ir import nodes as ir
from codegen.ir.domains import Interval
from codegen.ir.types import F32
from codegen.library import Library, load_library
from codegen.passes.analysis.operations import operations
from codegen.passes.specialise import Specialised, parameter_names, specialise
from conformance.unit.support.sources import library_of

SOURCE = '''
@struct
class Pair:
    """A pair.

    first    what comes first
    x        a field called like a parameter
    """

    first: X
    x: X


@struct
class Sized:
    """Something with a size.

    FragColor     how large it is
    """

    FragColor: X


def f(x: X, xs: X, pair: Pair, other: Pair, v: V, w: V) -> f32:
    """A function.

    x        a number
    xs       another number
    pair     a pair
    other    another pair
    v        a vector
    w        another vector
    returns  a sum
    source   this test
    """
    return x + xs + pair.first * other.first + pair.x * other.x + dot(v, w)


def sizes(gl: Sized, other: Sized) -> f32:
    return gl.FragColor + other.FragColor


def sums(a: X, b: X) -> f32:
    return (a + b) - b


def turns(x: X) -> f32:
    y = x
    for i in range(8):
        y = y * 0.5 + x
    return y


def more_turns(x: X) -> f32:
    y = x
    for i in range(9):
        y = y * 0.5 + x
    return y


def vectors(v: V) -> f32:
    return dot(v, vec3(1.0) + vec3(2.0))
'''


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Library:
    return library_of(tmp_path_factory.mktemp("results"), SOURCE)


def made(library: Library, *zeros: str, **known: Any) -> Specialised:
    constants = {path: (0.0, 0.0, 0.0) if path in ("v", "w") else 0.0 for path in zeros}
    return specialise(library, "f", constants={**constants, **known.pop("constants", {})}, **known)


NAMES: list[tuple[Sequence[str], dict[str, str]]] = [
    (["x", "pair.first"], {"x": "x", "pair.first": "first"}),
    (["pair.first", "other.first"], {"pair.first": "pair_first", "other.first": "other_first"}),
    (["pair.first", "other.x"], {"pair.first": "first", "other.x": "other_x"}),
    (["x", "pair.x", "other.x"], {"x": "x", "pair.x": "pair_x", "other.x": "other_x"}),
    ([], {}),
]


@pytest.mark.parametrize(("paths", "wanted"), NAMES, ids=str)
def test_names_are_short_where_they_can_be(
    paths: Sequence[str], wanted: dict[str, str], library: Library
) -> None:
    assert parameter_names(paths, library.function("f")) == wanted


def test_no_parameter_is_called_by_a_reserved_word(library: Library) -> None:
    found = specialise(library, "sizes", constants={"other.FragColor": 1.0})
    assert found.parameters == {"gl.FragColor": "FragColor"}
    with pytest.raises(UserError) as error:
        specialise(library, "sizes")
    sentence = 'sizes: parameter gl.FragColor would be called "gl_FragColor", which is a macro of engines'
    assert str(error.value) == sentence


def test_what_is_gone_is_told_once_and_not_what_was_given(library: Library) -> None:
    found = made(library, "x", "pair.first", "v", aliases={"other.x": "pair.x"})
    assert set(found.dropped) == {"x", "pair.first", "v", "other.first", "w", "other.x"}
    assert [s.what for s in found.log if s.name == "dead"] == [
        "parameter other.first is gone",
        "parameter w is gone",
    ]
    product = made(library, "x", "pair", constants={"pair": {"first": 0.0, "x": 0.0}})
    gone = [s.what for s in product.log if s.name == "dead"]
    assert gone == ["parameter other.first is gone", "parameter other.x is gone"]
    assert set(product.dropped) == {"x", "pair.first", "pair.x", "other.first", "other.x"}


def test_paths_that_begin_alike_are_others(tmp_path: Path) -> None:
    text = "def f(x: X, xs: X) -> f32:\n    return x * xs\n"
    found = specialise(library_of(tmp_path, text), "f", constants={"x": 0.0})
    assert [s.what for s in found.log if s.name == "dead"] == ["parameter xs is gone"]


def test_inputs_are_put_in_and_found_at_every_depth(library: Library) -> None:
    found = made(library, "pair.first", constants={"x": 2.0}, aliases={"other.x": "pair.x", "w": "v"})
    inputs = {"xs": 1.0, "pair": {"x": 3.0}, "other": {"first": 4.0, "x": 5.0}, "v": 6.0}
    imposed = found.impose(inputs)
    assert imposed == {
        "x": 2.0,
        "xs": 1.0,
        "pair": {"first": 0.0, "x": 3.0},
        "other": {"first": 4.0, "x": 3.0},
        "v": 6.0,
        "w": 6.0,
    }
    assert found.parameters == {"xs": "xs", "pair.x": "pair_x", "v": "v"}
    assert found.arguments(imposed) == {"xs": 1.0, "pair_x": 3.0, "v": 6.0}
    assert found.impose({"v": 1.0, "pair": {"x": 7.0}})["other"] == {"x": 7.0}
    assert inputs["pair"] == {"x": 3.0}


def test_what_was_asked_for_is_kept_with_the_result(library: Library) -> None:
    found = made(library, constants={"x": 2.0, "pair.first": 1.0}, aliases={"w": "v"})
    assert (found.source, found.constants, found.aliases) == ("f", {"x": 2.0, "pair.first": 1.0}, {"w": "v"})
    assert not found.whole
    plain = specialise(library, "sums")
    assert (plain.constants, plain.aliases, plain.source) == ({}, {}, "sums")


def test_words_of_what_is_left_in_order(library: Library) -> None:
    found = made(library, "x", "v", "other.x").function
    assert found.doc.summary == library.function("f").doc.summary
    assert list(found.doc.entries.items()) == [
        ("xs", "another number"),
        ("pair_first", "what comes first"),
        ("other_first", "what comes first"),
        ("returns", "a sum"),
        ("source", "this test"),
    ]
    assert (found.name, found.kind, found.base) == ("f_specialised", "base", None)
    source = library.function("f").place
    assert found.place == Place(source.path, source.line)
    assert [p.name for p in found.parameters] == ["xs", "pair_first", "other_first"]
    assert "returns" not in specialise(library, "sums").function.doc.entries


def test_lines_lead_to_the_source(library: Library) -> None:
    found = specialise(library, "turns", unroll=0).function
    lines = [s.line for s in ir.statements(found.body)]
    assert min(lines) > found.place.line
    assert len(set(lines)) == len(lines)
    start = library.function("turns").place.line
    assert [found.source_of(s.line).line for s in found.body if isinstance(s, ir.Let)] == [start + 3]
    assert {found.source_of(line).line for line in lines} <= set(range(start, start + 5))


def test_rules_that_are_asked_for(library: Library) -> None:
    assert specialise(library, "sums").parameters == {"a": "a"}
    assert specialise(library, "sums", kinds=("exact", "finite")).parameters == {"a": "a", "b": "b"}
    for name, loops in (("turns", 0), ("more_turns", 1)):
        body = specialise(library, name).function.body
        assert sum(isinstance(s, ir.For) for s in body) == loops
    log = [(s.name, s.what) for s in specialise(library, "vectors").log]
    assert log[:2] == [("fold", "1 + 2 -> 3"), ("scalars", "vec3(1) + vec3(2) -> vec3(3)")]


@pytest.mark.parametrize("exponent", [1.0, 2.0, 4.0])
def test_powers_stay_until_they_are_asked_for(exponent: float) -> None:
    """And whether one was left is told."""
    shared = load_library()
    for name, path in (("pow_one_minus", "p"), ("safe_pow", "y")):
        left = specialise(shared, name, constants={path: exponent})
        assert operations(left.function)["special"] > 0
        assert left.whole
        multiplied = specialise(shared, name, constants={path: exponent}, powers=4)
        assert operations(multiplied.function)["special"] == 0
        assert not multiplied.whole
        assert specialise(shared, name, constants={path: 8.0}, powers=4).whole
        for other in ({path: 2.5}, {}):
            assert not specialise(shared, name, constants=other).whole


def test_facts_hold_beside_constants_to_within_a_rounding(library: Library) -> None:
    known: dict[str, Any] = {"x": 0.5, "v": (0.0, 1.0, 0.0), "w": (2.0, 2.0, 2.0)}
    for fact in (
        ("x", 0.5 + 9e-7, 1.0),
        ("x", 0.0, 0.5 - 9e-7),
        ("v", 0.0, 1.0),
        ("x * 2.0", 1.0, 1.0),
        ("length(w - w)", 0.0, 0.0),
    ):
        specialise(library, "f", constants=known, facts=[fact])
    for fact, value in (
        (("x", 0.5 + 1.5e-6, 1.0), "0.5"),
        (("x", 0.0, 0.5 - 1.5e-6), "0.5"),
        (("v", 0.5, 1.0), r"vec3\(0, 1, 0\)"),
        (("v", 0.0, 0.5), r"vec3\(0, 1, 0\)"),
        (("w", 0.0, 1.0), r"vec3\(2\)|vec3\(2, 2, 2\)"),
    ):
        expected = rf'^f: fact "{fact[0]}" contradicts the constants, which make it ({value})$'
        with pytest.raises(UserError, match=expected):
            specialise(library, "f", constants=known, facts=[fact])


def test_facts_are_simplified_as_bodies_are(library: Library) -> None:
    known = {"v": (1.0, 1.0, 1.0), "w": (2.0, 2.0, 2.0)}
    log = specialise(library, "f", constants=known, facts=[("length(v + w) * x", 0.0, 1.0)]).log
    steps = [(s.name, s.what) for s in log if s.name in ("fold", "scalars") and "+" in s.what]
    assert steps[:2] == [("fold", "1 + 2 -> 3"), ("scalars", "vec3(1) + vec3(2) -> vec3(3)")]


def test_facts_of_one_expression_meet(library: Library) -> None:
    def told(*facts: tuple[str, float, float]) -> list[str]:
        return [s.what for s in specialise(library, "f", facts=facts).log if s.name == "facts"]

    assert told(("x", 0.0, 2.0), ("x", 1.0, 3.0)) == ["x in [0, 2]", "x in [1, 2]"]
    assert told(("x", 1.0, 3.0), ("x", 0.0, 2.0)) == ["x in [1, 3]", "x in [1, 2]"]
    assert told(("x", 1.0, 2.0), ("x", 2.0, 3.0)) == ["x in [1, 2]", "x in [2, 2]"]
    with pytest.raises(UserError, match=r'^f: fact "x" contradicts another fact$'):
        told(("x", 1.0, 2.0), ("x", 2.5, 3.0))


VARIANTS = """
@helper
def one(x: X, v: V) -> f32:
    return x + v.x


@helper
def same(y: X, w: V) -> f32:
    return y * w.y


@helper
def fewer(x: X) -> f32:
    return x


@helper
def turned(v: V, x: X) -> f32:
    return x + v.x


@helper
def wider(x: X, v: V) -> vec3:
    return v * x


def f(x: X, v: V) -> f32:
    return one(x, v)
"""


def test_only_what_takes_and_gives_the_same_can_stand_in(tmp_path: Path) -> None:
    several = library_of(tmp_path, VARIANTS)
    assert specialise(several, "f", variants={"one": "same"}).parameters == {"x": "x", "v": "v"}
    for other in ("fewer", "turned", "wider"):
        with pytest.raises(UserError, match=f'^"{other}" takes other parameters than "one" and cannot stand'):
            specialise(several, "f", variants={"one": other})


def test_ranges_become_domains(library: Library) -> None:
    found = specialise(library, "sums", ranges={"a": (0.0, 1.0)}, new_name="short")
    assert found.function.name == "short"
    assert found.function.parameters == (ir.Parameter("a", F32, Interval(0.0, 1.0)),)
