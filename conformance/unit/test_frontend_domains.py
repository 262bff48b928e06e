"""Domains at the ends of what they may state are read as they stand; one step further is refused.

Plan. The whole range of each type, a single number, ends of one sign with the largest `least` that they
allow, lengths from 0 and up to the largest number, both edges of a texture. What is refused has its case in
data/bad_sources.toml; here stand the neighbours of what is accepted.
"""

from pathlib import Path

import pytest

from codegen.errors import SourceError
from codegen.ir.domains import Domain, Edges, Interval, Length
from conformance.unit.support.sources import library_of

LARGEST = 3.4028235e38
NO_LEAST = '"least" of Interval is a magnitude'
BODY = "def probe(q: Annotated[{}, {}]) -> f32:\n    return 1.0\n"

ACCEPTED: dict[str, tuple[str, str, Domain]] = {
    "all of f32": ("f32", "Interval(-3.4028235e38, 3.4028235e38)", Interval(-LARGEST, LARGEST)),
    "all of i32": ("i32", "Interval(-2147483648, 2147483647)", Interval(-(2.0**31), 2.0**31 - 1.0)),
    "all of u32": ("u32", "Interval(0, 4294967295)", Interval(0.0, 2.0**32 - 1.0)),
    "one number": ("f32", "Interval(0.5, 0.5)", Interval(0.5, 0.5)),
    "one whole number": ("u32", "Interval(3, 3)", Interval(3.0, 3.0)),
    "one whole number between ends": ("i32", "Interval(0.5, 1.5)", Interval(0.5, 1.5)),
    "least of positive ends": ("f32", "Interval(1.0, 2.0, 'log', 2.0)", Interval(1.0, 2.0, "log", 2.0)),
    "least of negative ends": ("f32", "Interval(-2.0, -1.0, 'log', 2.0)", Interval(-2.0, -1.0, "log", 2.0)),
    "least at the lower end": ("f32", "Interval(-3.0, 1.0, 'log', 3.0)", Interval(-3.0, 1.0, "log", 3.0)),
    "a length from 0": ("vec3", "Length(0.0, 3.4028235e38)", Length(0.0, LARGEST)),
    "one length": ("vec2", "Length(1.0, 1.0)", Length(1.0, 1.0)),
    "both edges": ("Texture", "Edges('clamp', 'repeat')", Edges("clamp", "repeat")),
}

REFUSED: dict[str, tuple[str, str, str]] = {
    "the first of two unknown edges": ("Texture", "Edges('first', 'second')", 'unknown edge "first"'),
    "the second edge": ("Texture", "Edges('clamp', 'second')", 'unknown edge "second"'),
    "least beyond positive ends": (
        "f32",
        "Interval(1.0, 2.0, 'log', 2.5)",
        NO_LEAST,
    ),
    "least beyond negative ends": ("f32", "Interval(-2.0, -1.0, 'log', 2.5)", NO_LEAST),
    "least beyond double precision": ("f32", "Interval(0.0, 1.0, 'log', (10 ** 64) ** 64)", NO_LEAST),
    "a length below 0": ("vec3", "Length(-1e-30, 1.0)", "a length is 0 or more"),
    "no length but 0": ("vec3", "Length(0.0, 0.0)", "a length is 0 or more"),
}


@pytest.mark.parametrize("case", ACCEPTED)
def test_a_domain_is_read_as_it_stands(case: str, tmp_path: Path) -> None:
    type_, text, expected = ACCEPTED[case]
    (parameter,) = library_of(tmp_path, BODY.format(type_, text)).function("probe").parameters
    assert parameter.domain == expected


@pytest.mark.parametrize("case", REFUSED)
def test_what_lies_beyond_is_refused(case: str, tmp_path: Path) -> None:
    type_, text, sentence = REFUSED[case]
    with pytest.raises(SourceError) as caught:
        library_of(tmp_path, BODY.format(type_, text)).function("probe")
    assert caught.value.sentence.startswith(sentence)
