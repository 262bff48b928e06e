"""What is measured of the estimators of light, its records, and the section of the report about it.

Plan.
  plan      every lobe of the library is in it; quick is a part of it; points and viewers lie as they should
  curves    every estimator of a small plan has its errors, the emitted ones those of float64 but for rounding
  records   what is kept is read again; other files are refused with one sentence
  section   the best estimator of a row stands out, times lie on lines, figures join the promised ones
  command   options that do not go together are refused
Not covered here: the estimators themselves (test_light.py), measuring on drivers, the page in a browser
(test_page.py).
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.library import load_library
from codegen.maps import latlong
from conformance.light import emitted, estimators, modelled, plan, prefiltered
from conformance.light.__main__ import main
from conformance.light.environment import Environment, MapSampler
from conformance.light.lobes import Lobe
from conformance.light.plan import LOBES, Plan
from conformance.light.published import FIGURES
from conformance.light.record import keep, recorded
from conformance.light.worker import Job
from conformance.reference.lobes import LOBES as CATALOGUE
from conformance.report.light import at, light_view
from conformance.report.page import figures, light_page
from conformance.unit.support.light import small_section

SMALL = Plan((Lobe("phong", (10.0,)), Lobe("strand", (10.0,))), ("dawn",), (8, 32), (8,), views=2, shifts=2)


def sky() -> Environment:
    """A smooth sky."""
    w = latlong.directions(32, 64)
    pixels = np.stack([1.0 + 0.5 * w[..., 1], 1.2 + 0.3 * w[..., 0], 1.5 - 0.4 * w[..., 2]], axis=-1)
    return Environment(pixels, size=32, weighted=True)


def test_every_lobe_of_the_catalogue_is_measured() -> None:
    assert {lobe.name for lobe in LOBES} == set(CATALOGUE)
    assert set(Plan.quick().lobes) < set(LOBES)
    assert set(Plan.quick().counts) < set(Plan().counts) and set(Plan().timed) < set(Plan().counts)


def test_every_lobe_has_its_emitted_estimators() -> None:
    documented = load_library().documented
    for lobe in LOBES:
        for estimator in emitted.BY_LOBE:
            assert emitted.function_of(estimator, lobe) in documented
    assert emitted.PREFILTERED in documented


def test_viewers_stand_above_the_surface_and_points_lie_in_the_square() -> None:
    view = plan.repeated(Plan())
    assert len(view) == Plan().views * Plan().shifts and view.v[:, 2].min() >= 0.25
    u = plan.points(SMALL, 8)
    assert u.shape == (4, 8, 2) and u.min() >= 0.0 and u.max() < 1.0
    assert np.array_equal(plan.shifts(SMALL) * plan.GRID, np.round(plan.shifts(SMALL) * plan.GRID))


@pytest.mark.parametrize("lobe", SMALL.lobes, ids=str)
def test_curves_of_a_small_plan_are_whole(lobe: Lobe) -> None:
    here = sky()
    truth = modelled.truths(SMALL, lobe, {"dawn": here})["dawn"]
    found = modelled.curves(SMALL, lobe, here, MapSampler(here), truth, modelled.drawn(SMALL, lobe))
    wanted = {*emitted.BY_LOBE, modelled.HOST_SIDE, modelled.BIAS}
    assert set(found) - {prefiltered.NAME} == wanted
    assert (prefiltered.NAME in found) == (prefiltered.exponent_of(lobe) is not None)
    for curve in found.values():
        assert len(curve.samples) == len(curve.rms) and np.isfinite(curve.rms).all()


@pytest.mark.parametrize("estimator", ["monte_carlo", "filtered"])
def test_emitted_estimators_get_the_points_of_those_in_float64(estimator: str) -> None:
    here, lobe, library = sky(), SMALL.lobes[0], load_library()
    name = emitted.function_of(estimator, lobe)
    given = emitted.arguments(library, name, SMALL, lobe, (8,), emitted.texture(here))
    got = np.asarray(evaluate(library, name, given, "float32"))
    model = {"monte_carlo": estimators.plain, "filtered": estimators.filtered}[estimator]
    expected = model(here, plan.repeated(SMALL), lobe, plan.points(SMALL, 8))
    assert estimators.rms(got, expected) <= FIGURES["emitted"]


def test_a_job_survives_its_way_to_the_worker() -> None:
    job = Job("glsl", "", SMALL, {"dawn": {"phong 10": np.ones((2, 3))}})
    again = Job.from_json(job.to_json())
    assert again.plan == job.plan and np.array_equal(again.truths["dawn"]["phong 10"], np.ones((2, 3)))


def test_what_is_kept_is_read_again(tmp_path: Path) -> None:
    section = small_section()
    assert recorded(tmp_path) is None
    assert [path.name for path in keep(section, tmp_path)] == ["float64.json", "glsl-llvmpipe.json"]
    assert recorded(tmp_path) == section


@pytest.mark.parametrize("text", ["", "[]", '{"schema": 0}'])
def test_other_files_are_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / "float64.json").write_text(text, encoding="utf-8")
    with pytest.raises(UserError, match=r"float64\.json: no result"):
        recorded(tmp_path)


def test_the_table_tells_the_best_and_reads_times_off_lines() -> None:
    shown = light_view(small_section())
    assert shown is not None and shown["columns"] == ["monte_carlo", "filtered", "combined"]
    row = shown["rows"][0]
    assert [cell["best"] for cell in row["cells"]] == [False, True, False]
    assert row["cells"][0]["us"] == pytest.approx(6.4)
    assert row["cells"][2]["us"] is None
    assert at([1], [0.5]) == 0.5 and at([8, 16], [1.0, 1.0]) is None and at([8, 64], [None, 1.0]) is None
    assert light_view(None) is None


def test_the_page_alone_holds_the_section_and_its_figures() -> None:
    section = small_section()
    text = light_page(section)
    assert "phong 10" in text and "how the truth was made" in text and "Promised figures" in text
    (row,) = figures({"drivers": [], "emission": [], "light": section})
    assert row["met"] and row["values"][0][1]["measured"] == 0.025


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--record", "--quick"], "--record keeps whole measurements"),
        (["--driver", "llvmpip"], "llvmpip"),
    ],
)
def test_what_does_not_go_together_is_refused(arguments: list[str], told: str, tmp_path: Path) -> None:
    done = CliRunner().invoke(main, ["-o", str(tmp_path), *arguments])
    assert done.exit_code == 2 and told in done.output
    assert not list(tmp_path.iterdir())


def test_recorded_results_are_those_of_the_plan() -> None:
    section: dict[str, Any] | None = recorded()
    if section is None:
        pytest.skip("nothing is recorded: python -m conformance.light -o DIR --record")
    assert section["float64"]["lobes"] == [str(lobe) for lobe in LOBES]
    assert all(figure["met"] is not False for figure in section["float64"]["figures"])
    assert json.dumps(section, allow_nan=False)
