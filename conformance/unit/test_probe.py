"""Operations that are left for constants, asked one after the other, are those of specialising each time.

Plan. Functions with structs, branches and many parameters; a function whose loops change places with what is
constant; each question is held against a specialisation of its own.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from codegen.library import Library, load_library
from codegen.passes.analysis.operations import operations
from codegen.passes.probe import operations_left
from codegen.passes.specialise import specialise
from conformance.unit.support.sources import library_of

UNROLL = 4
QUESTIONS: dict[str, list[dict[str, Any]]] = {
    "fakefur_shade": [
        {"optics.exponent": 2.0},
        {"optics.rho_surface": 0.0},
        {"coat.density": 0.0},
        {"skin": (1.0, 1.0, 1.0)},
        {"n": (0.0, 0.0, 1.0)},
    ],
    "brushed_shade": [{"exponent": 0.0}, {"k_specular": (0.0, 0.0, 0.0)}, {"map_tangent": (1.0, 0.0, 0.0)}],
}
LOOPS = """def probe(x: Annotated[f32, Interval(0.0, 1.0)], y: X) -> f32:
    total = y
    if x > 0.5:
        for i in range(0, 6):
            total = total * min(f32(i), 20.0) + sin(total)
    for k in range(30, 37):
        total = total + sin(min(f32(k), 20.0) * total)
    return total
"""


def expected(library: Library, name: str, constants: dict[str, Any]) -> int:
    made = specialise(library, name, constants, new_name="alone", unroll=UNROLL)
    return sum(operations(made.function).values())


@pytest.mark.parametrize("name", QUESTIONS)
def test_functions_of_the_library(name: str) -> None:
    library = load_library()
    asked = [*QUESTIONS[name], *reversed(QUESTIONS[name])]
    assert operations_left(library, name, asked, UNROLL) == [expected(library, name, q) for q in asked]


def test_loops_that_take_the_place_of_others(tmp_path: Path) -> None:
    library = library_of(tmp_path, LOOPS)
    asked = [{"x": 0.25}, {"x": 0.75}, {"y": 1.0}, {"x": 0.0}]
    assert operations_left(library, "probe", asked, UNROLL) == [expected(library, "probe", q) for q in asked]
