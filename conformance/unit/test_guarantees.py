"""The guarantees on file fit the library, and changes of them are told.

Plan.
  file         one entry per public function and table, causes where lanes lack a guarantee; written as it is
               read
  differences  a changed share or error, a missing and an additional function are told; noise is not
  survey       a form with a known defect is found out: the cosine's sine is not bounded near 0
Not covered here: that the figures are those of today (`python -m conformance.guarantees --check`).
"""

from __future__ import annotations

from dataclasses import replace

from codegen.intervals import TABLES
from codegen.library import load_library
from conformance.guarantees import PATH, read
from conformance.guarantees.survey import Guarantee, drawn_for, survey
from conformance.guarantees.table import differences, text

LIBRARY = load_library()


def test_file_fits_the_library() -> None:
    found = read()
    assert set(found) == set(LIBRARY.public), "run python -m conformance.guarantees"
    for name, by_table in found.items():
        assert tuple(by_table) == TABLES
        for g in by_table.values():
            assert 0.0 <= g.uniform <= 1.0
            assert 0.0 <= g.hard <= 1.0
            assert bool(g.causes) == (not g.everywhere), name


def test_file_is_written_as_it_is_read() -> None:
    assert text(read()) == PATH.read_text(encoding="utf-8")


def test_differences_are_told() -> None:
    old = {"f": {"wgsl": Guarantee(1.0, 0.9, [1e-6, None], {"why": 0.1})}}

    def told(**changes: object) -> list[str]:
        return differences(old, {"f": {"wgsl": replace(old["f"]["wgsl"], **changes)}})  # type: ignore[arg-type]

    assert told() == told(hard=0.9001, errors=[1.05e-6, None]) == []
    assert told(uniform=0.99) == ["f under wgsl: guaranteed share (uniform) 1.0 became 0.99"]
    assert "guaranteed errors" in told(errors=[2e-6, None])[0]
    assert "guaranteed errors" in told(errors=[1e-6, 1.0])[0]
    assert differences(old, {}) == ["f: no longer there"]
    assert differences({}, old) == ["f under wgsl: not on file"]


def test_forms_of_a_sine_differ() -> None:
    errors = {}
    for name in ("sin_angle", "sin_angle_cosine"):
        g = survey(LIBRARY, name, "wgsl", drawn_for(LIBRARY, name))
        assert g.everywhere
        errors[name] = max(e for e in g.errors if e is not None)
    assert errors["sin_angle"] < 1e-6 < errors["sin_angle_cosine"]
