"""Definitions of emitted files: what they are equal by, their guards, their reach, and their text.

Plan. Small definitions written by hand: equality by name, comment and code alone; guards by code alone; words
without comments; what a definition reaches through others, through a circle, in the order of the file; text
of GLSL and of WGSL made of definitions and read back, with headers, directives, blank lines and braces.
"""

import re
from dataclasses import replace

import pytest

from codegen.backends import dialect
from codegen.emit.definition import Definition, guarded, plain, reached, read_definitions

BASE = Definition("vair_base", ("// The base.",), ("float vair_base(float x) {", "    return x;", "}"))
TWICE = Definition(
    "vair_twice",
    ("// Twice.", "//   x  a number"),
    ("float vair_twice(float x) {", "    return x + vair_base(x); // not vair_alone", "}"),
)
PAIR = Definition("vair_Pair", (), ("struct vair_Pair {", "    float first;", "};"))
TOP = Definition("vair_top", (), ("float vair_top(vair_Pair p) {", "    return vair_twice(p.first);", "}"))
ALONE = Definition("vair_alone", (), ("float vair_alone(float x) {", "    return x;", "}"))
ALL = [PAIR, ALONE, BASE, TWICE, TOP]


def test_where_a_definition_comes_from_makes_no_difference() -> None:
    for change in ({"path": "b.py"}, {"lines": (1, 2, 3)}, {"paths": ("b.py",) * 3}, {"source": "base"}):
        moved = replace(BASE, **change)
        assert moved == BASE
        assert hash(moved) == hash(BASE)
    assert replace(BASE, name="vair_other") != BASE
    assert replace(BASE, comment=()) != BASE
    assert replace(BASE, code=BASE.code[:2]) != BASE


def test_a_guard_is_that_of_the_code() -> None:
    assert re.fullmatch(r"VAIR_BASE_[0-9A-F]{8}", BASE.guard)
    assert replace(BASE, comment=("// Said otherwise.",)).guard == BASE.guard
    changes = [
        ("float vair_base(float x) {", "    return x;}"),
        ("float vair_base(float x) {", "    return x; ", "}"),
        ("float vair_base(float x) {", "", "    return x;", "}"),
    ]
    guards = {BASE.guard, *(replace(BASE, code=code).guard for code in changes)}
    assert len(guards) == 1 + len(changes)


def test_words_are_those_of_the_code_alone() -> None:
    assert TWICE.words == {"float", "vair_twice", "x", "return", "vair_base"}
    half = Definition("half", (), ("float half(float x) {", "    return x / 2.0; // half", "}"))
    assert half.words == {"float", "half", "x", "return", "2", "0"}


@pytest.mark.parametrize(
    ("name", "names"),
    [
        ("vair_top", ["vair_Pair", "vair_base", "vair_twice", "vair_top"]),
        ("vair_twice", ["vair_base", "vair_twice"]),
        ("vair_alone", ["vair_alone"]),
        ("vair_nobody", []),
        ("return", []),
    ],
)
def test_what_a_definition_reaches(name: str, names: list[str]) -> None:
    assert [d.name for d in reached(name, ALL)] == names
    assert [d.name for d in reached(name, iter(ALL))] == names


def test_a_circle_is_reached_once() -> None:
    back = replace(BASE, code=("float vair_base(float x) {", "    return vair_twice(x);", "}"))
    assert [d.name for d in reached("vair_base", [TWICE, back])] == ["vair_twice", "vair_base"]


def test_lines_of_definitions_have_an_empty_one_between() -> None:
    assert plain([BASE, ALONE]) == [*BASE.comment, *BASE.code, "", *ALONE.code]
    assert plain([]) == []


def test_guards_enclose_comment_and_code() -> None:
    lines = guarded([BASE, ALONE], dialect("glsl"))
    assert lines == [
        *(f"#ifndef {BASE.guard}", f"#define {BASE.guard}", *BASE.comment, *BASE.code, "#endif", ""),
        *(f"#ifndef {ALONE.guard}", f"#define {ALONE.guard}", *ALONE.code, "#endif"),
    ]
    assert guarded([BASE, ALONE], dialect("wgsl")) == plain([BASE, ALONE])


@pytest.mark.parametrize("target", ["glsl", "opencl", "wgsl"])
def test_text_reads_back_as_its_definitions(target: str) -> None:
    text = "\n".join(["// A header.", "//", "// More.", "", *guarded(ALL, dialect(target))])
    assert read_definitions(text) == ALL


WGSL = """// A header of what follows.
enable f16;
fn vair_first(x: f32) -> f32 {
    if (x > 0.0) {
        return 1.0;
    }

    return x;
}
// A note that an empty line parts from what follows.

struct vair_Pair {
    first: f32,
}

// Looks up.
@must_use
fn vair_second(x: f32) -> f32 {
    return x;
}
}
"""


def test_what_is_no_definition_is_left_out() -> None:
    first, pair = read_definitions(WGSL)
    assert (first.name, first.comment, len(first.code)) == ("vair_first", (), 7)
    assert (pair.name, pair.comment) == ("vair_Pair", ())
    assert pair.code == ("struct vair_Pair {", "    first: f32,", "}")
    assert read_definitions("") == read_definitions("// Nothing.\n") == []
    assert [d.name for d in read_definitions("}\n" + "\n".join(BASE.code))] == ["vair_base"]
