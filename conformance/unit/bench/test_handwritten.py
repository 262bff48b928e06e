"""The hand-written fur beside which scenes are timed: it is the same model, on every target.

A record is shown as tables, and the page shows what is recorded.
"""

from __future__ import annotations

import numpy as np
import pytest

from codegen.library import load_library
from codegen.scene.description.document import read_scene
from codegen.scene.general import general_function
from codegen.scene.proof.errors import reference_values
from codegen.scene.proof.points import draw
from conformance.bench.handwritten import beside, record
from conformance.unit.support.drivers import need
from targets import TARGETS, open_runtime

MODEL = 0.5
"""Half steps of 8 bits: what the hand-written forms lose at ordinary points; another model is far off."""


@pytest.mark.parametrize("target", TARGETS)
def test_the_hand_written_functions_are_the_same_model(target: str) -> None:
    need(target)
    runtime = open_runtime(target)
    library = load_library()
    scene = read_scene(beside.SCENE, library)
    general = general_function(scene)
    extended = library.with_functions([general.function])
    points = draw(scene, general, 2000)
    exact, _ = reference_values(extended, general.function.name, points)
    named = extended.with_functions([beside.stand_in(general.function, beside.BY_HAND)])
    found = beside.values(named, beside.BY_HAND, runtime, target, points.inputs, beside.prefixed(target))
    ordinary = ~points.hard
    off = np.abs(np.asarray(found)[ordinary] - exact[ordinary]).max(axis=1) / beside.HALF_STEP
    # Light and viewer on one side of the hair leave few digits of a plain sine, so the median judges.
    assert np.median(off) <= MODEL
    assert np.quantile(off, 0.99) <= MODEL


def row(name: str, ns: float, operations: int | None) -> beside.Row:
    return beside.Row(name, ns, ns / 2.0, ns * 2.0, 0.123456, 2.0, 3, operations)


def test_a_record_as_tables() -> None:
    rows = [row("scene_shade", 1.5, 96), row(beside.BY_HAND, 3.0, None)]
    told = record.tables(
        {"method": "So", "date": "today", **record.as_data({}, {"glsl": ("a driver", rows)})}
    )
    assert told.splitlines() == [
        "**glsl**, a driver",
        "",
        "| function | ns [quartiles] | of by hand | operations | ordinary | hard | not finite |",
        "|---|---:|---:|---:|---:|---:|---:|",
        "| `scene_shade` | 1.5 [0.75, 3] | 0.50 | 96 | 0.12 | 2 | 3 |",
        "| by hand | 3 [1.5, 6] | 1.00 |  | 0.12 | 2 | 3 |",
        "",
        "So. today.",
    ]


def test_the_page_shows_what_is_recorded() -> None:
    assert record.tables(record.read()) in record.README.read_text(encoding="utf-8")
