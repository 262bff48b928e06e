"""The comment of an emitted function or struct says all that is known of it, in order, under emitted names.

Plan. One source with every entry against its whole comment, written by hand; what a target does not see;
notes of variants and printed forms; a struct with and without documentation; names of several words and of
structs are renamed in running text, plain words, constants and parts of other words are not.
"""

from dataclasses import replace

import pytest

from codegen.bounds import Bound
from codegen.emit.comment import function_comment, renamer, struct_comment
from codegen.ir.nodes import Doc
from codegen.library import Library
from conformance.unit.support.sources import FIRST_LINE, library_of

PREFIX = "fur_"
SOURCE = """def half_turn(x: X) -> f32:
    '''Half of a turn; see turn_twice and Turn.

    source      a paper on half_turn
    form        one product
    degenerate  x = 0: 0
    returns     the angle
    x           how far
    '''
    return 0.5 * x
@variant("half_turn")
def half_turn_quick(x: X, n: u32) -> f32:
    '''Quicker.'''
    return x
@printed("half_turn")
def half_turn_printed(x: X) -> f32:
    return x
def turn_twice(x: X) -> f32:
    return x
@struct
class Turn:
    '''An angle, as of half_turn.

    angle  in radians
    '''
    angle: X
    rest: X
"""


def rename(text: str) -> str:
    return renamer(("half_turn", "turn_twice", "Turn"), PREFIX)(text)


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Library:
    return library_of(tmp_path_factory.mktemp("sources"), SOURCE)


def bound(where: str, *targets: str) -> Bound:
    return Bound("half_turn", "absolute", 0.5, where, "this test", targets=targets)


def comment(library: Library, name: str, *bounds: Bound, guaranteed: str = "") -> list[str]:
    return function_comment(library.function(name), bounds, "glsl", rename, guaranteed)


def test_a_comment_says_everything_in_order(library: Library) -> None:
    bounds = bound("near 0"), bound("on another target", "wgsl"), bound("elsewhere", "glsl", "wgsl")
    assert comment(library, "half_turn", *bounds, guaranteed="100 % of the domain") == [
        "// Half of a turn; see fur_turn_twice and fur_Turn.",
        "//   x           how far; finite",
        "//   returns     the angle",
        "//   degenerate  x = 0: 0",
        "//   error       absolute <= 0.5: near 0; absolute <= 0.5: elsewhere, glsl and wgsl only",
        "//   guaranteed  100 % of the domain",
        "//   form        one product",
        "//   source      a paper on fur_half_turn",
        f"//   from        shaderlib/numeric/probe.py:{FIRST_LINE}",
    ]


def test_what_is_not_known_is_left_out(library: Library) -> None:
    assert comment(library, "turn_twice", bound("elsewhere", "wgsl")) == [
        "//",
        "//   x     finite",
        "//   from  shaderlib/numeric/probe.py:19",
    ]


def test_forms_name_their_base(library: Library) -> None:
    assert comment(library, "half_turn_quick") == [
        "// Quicker. Variant of fur_half_turn.",
        "//   x     finite",
        "//   n",
        "//   from  shaderlib/numeric/probe.py:13",
    ]
    assert comment(library, "half_turn_printed")[0] == "// As the lecture prints it; right: fur_half_turn."


def test_a_struct_says_its_fields(library: Library) -> None:
    assert struct_comment(library.struct("Turn"), rename) == [
        "// An angle, as of fur_half_turn.",
        "//   angle  in radians; finite",
        "//   rest   finite",
    ]


def test_long_lines_go_on_below_their_text(library: Library) -> None:
    long = "aword, " * 15 + "and one more"
    told = replace(library.function("half_turn_quick"), doc=Doc(long, {"x": long, "returns": "it"}))
    assert function_comment(told, (), "glsl", rename) == [
        "// " + "aword, " * 13 + "aword,",
        "// aword, and one more Variant of fur_half_turn.",
        "//   x        " + "aword, " * 11 + "aword,",
        "//            aword, aword, aword, and one more; finite",
        "//   n",
        "//   returns  it",
        "//   from     shaderlib/numeric/probe.py:13",
    ]


NAMES = ("half_turn", "lobe", "Lobe", "PI", "TWO_PI", "a1", "Angle")


@pytest.mark.parametrize(
    ("text", "renamed"),
    [
        ("half_turn, and half_turn", "fur_half_turn, and fur_half_turn"),
        ("the half_turn_quick and half", "the half_turn_quick and half"),
        ("a lobe, the Lobe", "a lobe, the fur_Lobe"),
        ("PI and TWO_PI", "PI and fur_TWO_PI"),
        ("a1", "a1"),
        ("an Angle: Angles", "an fur_Angle: Angles"),
        ("x.Angle is a field", "x.Angle is a field"),
        ("", ""),
    ],
)
def test_names_of_the_library_get_its_prefix(text: str, renamed: str) -> None:
    assert renamer(NAMES, PREFIX)(text) == renamed
