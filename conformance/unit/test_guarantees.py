"""The guarantees on file fit the library, and changes of them are told.

Plan.
  file         every public function, in the form it has now; every table; causes where lanes lack a
               guarantee; written as it is read
  exceptions   every function is guaranteed on its whole domain under every table, or a named entry says why
               not; every entry excuses something
  meaning      words and places of a source do not make a guarantee stale, arithmetic and bounds do
  differences  a changed share or error, a missing and an additional function are told; noise is not
  phrases      share, errors in turn, their measures, of other targets none
  texts        emitted comments, `vair show` and the page say what is on file
  survey       a form with a known defect is found out: the cosine's sine is not bounded near 0
Nightly: the figures are those of today.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from codegen.backends import dialect
from codegen.bounds import Bound
from codegen.describe import as_data, describe
from codegen.emit.module import emit
from codegen.guarantee_page import page
from codegen.guarantees import Guarantee, Surveyed, exempt, phrase
from codegen.intervals import TABLES
from codegen.ir.nodes import Function
from codegen.library import load_library
from conformance.guarantees import PATH, read, stale
from conformance.guarantees.survey import drawn_for, survey
from conformance.guarantees.table import MAKERS, differences, made_with, meaning, surveyed, text
from conformance.unit.support.tolerances import tolerance

LIBRARY = load_library()
RENEW = "run python -m conformance.guarantees, then python -m codegen.generate"


def test_file_fits_the_library() -> None:
    found = read()
    assert stale(LIBRARY, found) == [], RENEW
    assert set(found) == set(LIBRARY.public), RENEW
    for name, entry in found.items():
        assert tuple(entry.tables) == TABLES
        for g in entry.tables.values():
            assert 0.0 <= g.uniform <= 1.0
            assert 0.0 <= g.hard <= 1.0
            assert len(g.errors) == len(LIBRARY.bounds.get(name, ()))
            assert bool(g.causes) == (not g.everywhere), name


def test_all_is_stale_when_intervals_points_or_references_change(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    other = tmp_path / "made_with.txt"
    other.write_text("0123456789abcdef\n", encoding="ascii")
    monkeypatch.setattr("conformance.guarantees.table.MADE_WITH", other)
    assert stale(LIBRARY, read()) == list(LIBRARY.public)
    for folder in MAKERS:
        (tmp_path / folder).mkdir(parents=True)
    monkeypatch.setattr("conformance.sources.PROJECT", tmp_path)
    known = {made_with()}
    for folder in MAKERS:
        (tmp_path / folder / "more.py").write_text(f"# {folder}", encoding="ascii")
        known.add(made_with())
    assert len(known) == 1 + len(MAKERS)


def test_file_is_written_as_it_is_read() -> None:
    assert text(read()) == PATH.read_text(encoding="utf-8")


def test_what_is_not_guaranteed_is_explained() -> None:
    open_ = [(n, t) for n, e in read().items() for t, g in e.tables.items() if not g.everywhere]
    entries = exempt(LIBRARY)
    unexplained = [pair for pair in open_ if not any(e.covers(*pair) for e in entries)]
    assert not unexplained, "improve the form, or explain it in shaderlib/guarantees.toml"
    for entry in entries:
        assert any(entry.covers(*pair) for pair in open_), f"{entry.function} under {entry.table}: all closed"


def test_only_meaning_makes_a_guarantee_stale() -> None:
    function = LIBRARY.function("safe_sqrt")
    reworded = replace(function, doc=replace(function.doc, summary="Another."))
    moved = replace(reworded, place=replace(function.place, line=function.place.line + 7))
    assert meaning(LIBRARY.with_functions([moved]), "safe_sqrt") == meaning(LIBRARY, "safe_sqrt")
    other = replace(LIBRARY.function("lambert_value"), name="safe_sqrt")
    assert meaning(LIBRARY.with_functions([other]), "safe_sqrt") != meaning(LIBRARY, "safe_sqrt")
    assert "safe_sqrt" in stale(LIBRARY.with_functions([other]), read())


def of(**tables: Guarantee) -> Mapping[str, Surveyed]:
    """Guarantees of one function f."""
    return {"f": Surveyed("0", tables)}


def test_differences_are_told() -> None:
    g = Guarantee(1.0, 0.9, [1e-6, None], {"why": 0.1})

    def told(**changes: object) -> list[str]:
        return differences(of(wgsl=g), of(wgsl=replace(g, **changes)))  # type: ignore[arg-type]

    assert told() == told(hard=0.9001, errors=[1.05e-6, None]) == []
    assert told(uniform=0.99) == ["f under wgsl: guaranteed share (uniform) 1.0 became 0.99"]
    assert "guaranteed errors" in told(errors=[2e-6, None])[0]
    assert "guaranteed errors" in told(errors=[1e-6, 1.0])[0]
    assert differences(of(wgsl=g), {}) == ["f: no longer there"]
    assert differences({}, of(wgsl=g)) == ["f under wgsl: not on file"]


ABSOLUTE = Bound("f", "absolute", 1e-6, "everywhere", "none")
RELATIVE = replace(ABSOLUTE, measure="relative")
OF_GLSL = replace(ABSOLUTE, targets=("glsl",))
WHOLE = "100 % of the domain by the WGSL specification"


@pytest.mark.parametrize(
    ("bounds", "errors", "shown"),
    [
        ([ABSOLUTE], [1e-6], f"{WHOLE}, to 1e-6 absolute"),
        ([ABSOLUTE, ABSOLUTE], [1e-6, None], f"{WHOLE}, to 1e-6, nothing in turn"),
        ([RELATIVE, ABSOLUTE], [1e-6, float("inf")], f"{WHOLE}, to 1e-6 relative, any error in turn"),
        ([replace(ABSOLUTE, measure="exact")], [0.0], f"{WHOLE}, to exact"),
        ([OF_GLSL], [None], WHOLE),
        ([OF_GLSL, ABSOLUTE], [None, 2e-7], f"{WHOLE}, to 2e-7 absolute"),
    ],
)
def test_phrases(bounds: list[Bound], errors: list[float | None], shown: str) -> None:
    assert phrase("wgsl", Guarantee(1.0, 1.0, errors), bounds, "wgsl") == shown


def test_a_share_is_never_rounded_up() -> None:
    found = Guarantee(0.99999, 0.56, [1e-6])
    assert phrase("glsl_es", found, [ABSOLUTE]) == (
        "99.99 % of the domain, 56 % of the hard cases by the OpenGL ES specification, to 1e-6 absolute"
    )


def test_texts_say_what_is_on_file() -> None:
    tables = read()["sin_angle"].tables
    data = as_data(LIBRARY, LIBRARY.function("sin_angle"))["guaranteed"]
    assert data == {table: g.as_data() for table, g in tables.items()}
    shown = "\n".join(describe(LIBRARY, LIBRARY.function("sin_angle")))
    for table, g in tables.items():
        assert phrase(table, g, LIBRARY.bounds["sin_angle"]) in shown
    emitted = emit(LIBRARY, dialect("glsl", "es300"), ["sin_angle"])
    assert "guaranteed  100 % of the domain by the OpenGL ES specification" in emitted
    unknown = LIBRARY.with_functions([renamed("safe_sqrt")])
    assert "guaranteed  " not in emit(unknown, dialect("wgsl"), ["g"])
    assert "| `sin_angle` |" in page(LIBRARY)


def renamed(name: str) -> Function:
    """A function under a name that was never surveyed."""
    return replace(LIBRARY.function(name), name="g")


def test_forms_of_a_sine_differ() -> None:
    errors = {}
    for name in ("sin_angle", "sin_angle_cosine"):
        g = survey(LIBRARY, name, "wgsl", drawn_for(LIBRARY, name))
        assert g.everywhere
        errors[name] = max(e for e in g.errors if e is not None)
    assert errors["sin_angle"] < tolerance("forms_of_a_sine") < errors["sin_angle_cosine"]


@pytest.mark.nightly
def test_figures_are_those_of_today() -> None:
    assert differences(read(), surveyed(LIBRARY, LIBRARY.public)) == []
