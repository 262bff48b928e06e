"""The log of specialising tells every step: where, which pass, what became what, and why that is sound.

Each row is a function of which little is known, and all that the log says of it, word for word.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from codegen.errors import Place, UserError
from codegen.library import load_library
from codegen.passes.specialise import Specialised, specialise
from codegen.passes.subject import Fact
from conformance.unit.support.sources import library_of

PAIR = '@struct\nclass Pair:\n    """A pair."""\n    first: X\n    second: V\n\n\n'
GONE = "nothing that is left uses it"
ROWS: dict[str, tuple[str, str, dict[str, Any], list[str]]] = {
    "constants": (
        "a: X, p: bool, s: Pair",
        "a * s.first if p else s.second.y",
        {"constants": {"a": 0.5, "p": True, "s": {"first": 0.25, "second": (1.0, -2.0, 3.0)}}},
        [
            "f:2 substitute: a = 0.5; given as a constant",
            "f:2 substitute: p = true; given as a constant",
            "f:2 substitute: s = {first = 0.25, second = (1, -2, 3)}; given as a constant",
            "f:3 fold: 0.5 * 0.25 -> 0.125; constants, rounded once: the float32 nearest to the exact "
            "result, which every target permits",
            "f:3 scalars: vec3(1, -2, 3).y -> -2; exact: components are moved, nothing is computed",
            "f:3 fold: 0.125 if true else -2 -> 0.125; the condition is true",
        ],
    ),
    "equal parameters": (
        "d: D, e: D, a: X",
        "dot(d, e)",
        {"aliases": {"e": "d"}},
        [
            "f:2 substitute: e = d; given as equal",
            f"f:2 dead: parameter a is gone; {GONE}",
        ],
    ),
    "fact": (
        "d: D, e: D",
        "max(dot(d, e), 0.0)",
        {"facts": [Fact("dot(d, e)", 0.25, 1.0)]},
        [
            "f:2 facts: dot(d, e) in [0.25, 1]; given",
            "f:3 ranges: max(dot(d, e), 0) -> dot(d, e); proven on every target: dot(d, e) in [0.249998, 1]",
        ],
    ),
    "two facts of one expression": (
        "d: D, e: D",
        "min(max(dot(d, e), 0.0), 0.875)",
        {"facts": [Fact("dot(d, e)", 0.25, 1.0), Fact("dot(e, d)", -1.0, 0.75)]},
        [
            "f:2 facts: dot(d, e) in [0.25, 1]; given",
            "f:2 facts: dot(d, e) in [0.25, 0.75]; given",
            "f:3 ranges: max(dot(d, e), 0) -> dot(d, e); "
            "proven on every target: dot(d, e) in [0.249998, 0.750002]",
            "f:3 ranges: min(dot(d, e), 0.875) -> dot(d, e); "
            "proven on every target: dot(d, e) in [0.249998, 0.750002]",
        ],
    ),
    "range": (
        "a: X, b: X",
        "clamp(a, -2.0, 2.0) + clamp(b, 0.5, 2.0)",
        {"ranges": {"a": (0.0, 1.0), "b": (0.0, 1.0)}},
        [
            "f:3 ranges: clamp(a, -2, 2) -> a; proven on every target: a in [0, 1], inside the ends",
            "f:3 ranges: clamp(b, 0.5, 2) -> max(b, 0.5); proven on every target: b in [0, 1]",
        ],
    ),
    "two ranges": (
        "a: X, b: X",
        "1.0 if a < b else 2.0",
        {"ranges": {"a": (0.0, 1.0), "b": (2.0, 3.0)}},
        [
            "f:3 ranges: a < b -> true; proven on every target: a in [0, 1], b in [2, 3]",
            "f:3 fold: 1 if true else 2 -> 1; the condition is true",
            f"f:2 dead: parameter a is gone; {GONE}",
            f"f:2 dead: parameter b is gone; {GONE}",
        ],
    ),
    "zeros": (
        "v: V",
        "dot(v, vec3(0.0, 0.0, 2.5))",
        {},
        [
            "f:3 scalars: vec3(0, 0, 2.5).x -> 0; exact: components are moved, nothing is computed",
            "f:3 scalars: vec3(0, 0, 2.5).y -> 0; exact: components are moved, nothing is computed",
            "f:3 scalars: vec3(0, 0, 2.5).z -> 2.5; exact: components are moved, nothing is computed",
            "f:3 identities: v.x * 0 -> 0; x * 0 = 0, finite: 0 times a finite number is 0",
            "f:3 identities: v.y * 0 -> 0; x * 0 = 0, finite: 0 times a finite number is 0",
            "f:3 axes: dot(v, vec3(0, 0, 2.5)) -> v.z * 2.5; finite: products with 0 are 0; "
            "the sum that is left is one of the orders that targets may take",
        ],
    ),
    "terms that cancel": (
        "a: X, b: X",
        "(a + b) - b",
        {},
        [
            "f:3 sums: (a + b) - b -> a; real: terms cancel exactly when multiplied out, "
            "so the result is the same real number",
            f"f:2 dead: parameter b is gone; {GONE}",
        ],
    ),
    "alike components": (
        "a: X, b: X",
        "length(vec3(a) + vec3(b))",
        {},
        [
            "f:3 scalars: vec3(a) + vec3(b) -> vec3(a + b); "
            "exact: every component is the same operation on the same operands",
        ],
    ),
}
FLOW = """def twice(x: X) -> f32:
    return x * 2.0


def f(a: X, b: X, p: bool) -> f32:
    y = twice(a)
    if p:
        y = y + b
    for k in range(3):
        y = y * b
    return y
"""
FORMS = """def root(x: X) -> f32:
    return sqrt(abs(x))


@variant("root")
def root_plain(x: X) -> f32:
    return sqrt(x)


def f(a: X) -> f32:
    return root(a)
"""


def told(found: Specialised) -> list[str]:
    return [f"{s.where} {s.name}: {s.what}; {s.why}" for s in found.log]


@pytest.mark.parametrize("name", ROWS)
def test_every_step_is_told(name: str, tmp_path: Path) -> None:
    signature, text, known, lines = ROWS[name]
    library = library_of(tmp_path, f"def f({signature}) -> f32:\n    return {text}\n\n\n{PAIR}")
    assert told(specialise(library, "f", **known)) == lines


def test_steps_of_control_flow_are_told(tmp_path: Path) -> None:
    found = specialise(library_of(tmp_path, FLOW), "f", constants={"p": True}, unroll=4)
    assert told(found) == [
        "f:6 substitute: p = true; given as a constant",
        "f:8 branches: if true: one side is left; the condition is true",
        "f:10 unroll: 3 iterations over k; the bounds are constant",
    ]


def test_other_forms_of_calls_are_told(tmp_path: Path) -> None:
    found = specialise(library_of(tmp_path, FORMS), "f", variants={"root": "root_plain"})
    assert told(found) == ["f:12 variants: root -> root_plain; asked for"]


def test_facts_may_meet_in_one_number_and_miss_constants_by_rounding(tmp_path: Path) -> None:
    library = library_of(tmp_path, "def f(d: D, e: D) -> f32:\n    return dot(d, e)\n")
    met = specialise(library, "f", facts=[Fact("dot(d, e)", 0.25, 0.5), Fact("dot(d, e)", 0.5, 1.0)])
    assert told(met)[1] == "f:2 facts: dot(d, e) in [0.5, 0.5]; given"
    up = {"d": (0.0, 0.0, 1.0), "e": (0.0, 0.0, 1.0)}
    near = specialise(library, "f", constants=up, facts=[Fact("dot(d, e)", 1.0 + 0.9e-6, 2.0)])
    assert not near.parameters
    for low, high in ((1.0 + 1.5e-6, 2.0), (0.0, 1.0 - 1.5e-6)):
        with pytest.raises(UserError, match="contradicts the constants, which make it 1"):
            specialise(library, "f", constants=up, facts=[Fact("dot(d, e)", low, high)])


def test_what_is_made_of_a_variant_is_a_function_of_its_own() -> None:
    source = load_library().function("safe_normalize_dot")
    made = specialise(load_library(), source.name).function
    assert (made.name, made.kind, made.base) == ("safe_normalize_dot_specialised", "base", None)
    assert made.place == Place(source.place.path, source.place.line)  # a line, but not its text


def test_multiplied_powers_are_told() -> None:
    found = specialise(load_library(), "pow_one_minus", constants={"p": 5.0}, powers=8)
    assert [line.partition(" ")[2] for line in told(found)[1:]] == [
        "powers: pow_one_minus(q, 5) -> 3 multiplications; "
        "relative error at most 1.1e-06 (either-way rounding), or 8e-31",
    ]
