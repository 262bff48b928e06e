"""Measured factored reflectances: the record follows the plan, the page the record, fits come out again.

Plan.
  record   one entry per fit of the plan, with its settings; the promised errors
  page     README.md is what the record makes it
  again    the first fit gives the recorded errors; all of them at night
  direct   the functions that factored shades are timed against are what was fitted, times the cosine
  timing   the kernels of a table and of the direct form run, and the measurement says what it should
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from codegen.evaluate import evaluate
from conformance.bench.timing import QUICK, Bench
from conformance.factored import page, speed
from conformance.factored.fits import KEPT, fit_row, material_row
from conformance.factored.plan import Fit, library, read_plan
from conformance.factored.published import WATERLOO
from conformance.unit.support.drivers import need
from conformance.unit.support.tolerances import tolerance
from targets import open_runtime

PLAN = read_plan()
RECORD = page.read_fits()
ERRORS = page.ERRORS


def fit_id(fit: Fit) -> str:
    return f"{fit.function}-{fit.p}-{fit.q}-{fit.r}-{fit.emphasis:g}"


def recorded(fit: Fit) -> dict[str, float]:
    wanted = {**{key: getattr(fit, key) for key in KEPT}, "set": dict(fit.set)}
    (row,) = (row for row in RECORD["fits"] if all(row[key] == x for key, x in wanted.items()))
    return {key: row[key] for key in ERRORS}


def test_the_record_holds_the_plan() -> None:
    assert len(RECORD["fits"]) == len(PLAN.fits)
    assert {key: RECORD[key] for key in ("samples", "fresh", "above")} == {
        "samples": PLAN.samples,
        "fresh": PLAN.fresh,
        "above": PLAN.above,
    }
    for fit in PLAN.fits:
        assert recorded(fit)


def least(function: str, error: str, *, third: bool) -> float:
    """The least recorded error of a reflectance, with a factor r or without."""
    return min(recorded(f)[error] for f in PLAN.fits if f.function == function and bool(f.r) == third)


def test_the_promised_errors_are_kept() -> None:
    assert least("strand_specular_half", "rms", third=False) <= tolerance("half_vector_fit")
    assert least("strand_specular", "rms", third=False) <= tolerance("strand_fit")
    assert least("strand_specular", "rms", third=True) <= tolerance("strand_fit_with_cosines")
    assert least("poulin_fournier_value", "seen", third=True) <= tolerance("satin_fit")


def test_the_page_shows_the_record() -> None:
    assert page.PAGE.read_text(encoding="utf-8") == page.recorded()


def again(fit: Fit) -> None:
    found = fit_row(library(), PLAN, fit)
    for key, expected in recorded(fit).items():
        assert abs(found[key] / expected - 1.0) <= tolerance("refitted"), (key, found[key], expected)


def test_the_first_fit_comes_out_again() -> None:
    again(PLAN.fits[0])


@pytest.mark.nightly
@pytest.mark.parametrize("fit", PLAN.fits[1:], ids=fit_id)
def test_every_fit_comes_out_again(fit: Fit) -> None:
    again(fit)


@pytest.mark.skipif(not WATERLOO.is_dir(), reason="the Waterloo data are not carried; see CREDITS.md")
def test_the_recorded_materials_are_the_published_ones() -> None:
    found = [material_row(WATERLOO / name) for name in ("satin", "garnetred")]
    for row, expected in zip(found, RECORD["materials"], strict=True):
        assert {**row, "asymmetry": 0.0} == {**expected, "asymmetry": 0.0}
        assert row["asymmetry"] <= tolerance("exact_interpolation")


@pytest.mark.parametrize("fit", [fit for fit in PLAN.fits if fit.direct], ids=fit_id)
def test_the_direct_functions_are_what_was_fitted(fit: Fit) -> None:
    drawn = fit.drawn(library(), 500, 4)
    for name in fit.direct:
        own = {p.name for p in library().function(name).parameters}
        held = {
            key: x
            for key, x in {**fit.set, "diffuse": fit.diffuse, "scale": np.ones(3)}.items()
            if key in own
        }
        got = np.asarray(evaluate(library(), name, {"l": drawn.l, "v": drawn.v, **held}, "float64"))
        off = np.abs(got - drawn.value * drawn.l[:, 2:]).max() / drawn.value.max()
        assert off <= tolerance("direct_eight" if name.endswith("eight") else "rounded"), name


def test_the_timing_says_what_it_should() -> None:
    need("glsl")
    runtime = open_runtime("glsl")
    effort = replace(QUICK, rounds=2, most=2, seconds=1e-4, launches=1.0)
    bench = Bench(library(), runtime, effort)
    rows = speed.rows(bench, speed.table_rival(library()))["members"]
    assert [row["function"] for row in rows] == ["direct_cosine", "strand_cosine_table"]
    for row in rows:
        assert row["error"]["not_finite"] == 0
        assert row["error"]["largest"] <= tolerance("banks_table")
        assert set(row["speed"]) == set(page.MODES)
        assert all(s["rounds"] == 2 and np.isfinite(s["net_ns"]) for s in row["speed"].values())
