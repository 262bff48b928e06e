"""Intervals hold every result that is known to be permitted, for every function and table.

Plan. For each public function, random points of its domain and every family of hard cases that fits:
  evaluator  the value of float32 arithmetic, op by op, lies inside under every table (over the suite more
             than 1e6 lanes); under OpenCL except where its own built-ins promise more than that arithmetic
  exact      the value of exact arithmetic lies inside: as rigorous enclosures say (conformance.soundness),
             and 50 digits on some lanes that they leave open. It holds for rounding to either neighbour; a
             table that rounds to nearest leaves less freedom (0.1 + 0.2 is one float32, no exact sum), so
             it is tested with its rounding set to either. A million points: python -m conformance.soundness
  forks      following forks only narrows
  tightness  tables that promise too much are caught, operation by operation
Not covered here: devices (conformance/execute/test_functions.py).
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.intervals import TABLES, Table, load_table, permitted
from codegen.library import load_library
from conformance.check.engine import draws
from conformance.guarantees.sample import Sample, together
from conformance.soundness.held import either_way, held, holds, precisely
from conformance.soundness.walk import enclosed
from conformance.unit.support.sources import library_of
from conformance.unit.support.tight import TOO_TIGHT, tightened

LIBRARY = load_library()
UNIFORM, FAMILY, PRECISE = 1000, 80, 60
"""Random lanes, lanes of each family, and lanes in 50 digits at most, per function."""
FEWER = {"poulin_fournier_value": 4, "poulin_fournier_value_eight": 4}
"""By how much fewer lanes do for functions that sum a quadrature: their operations repeat."""
EXTENDED = {
    "latlong_uv": "OpenCL's length neither overflows nor loses small components; float32 squares underflow",
}
"""Functions whose float32 evaluation is no OpenCL result at some hard cases, and why."""


def drawn_for(name: str) -> Sample:
    """Points of a function's domain and of the families that fit."""
    fewer = FEWER.get(name, 1)
    return together(draws(LIBRARY.function(name), UNIFORM // fewer, FAMILY // fewer))


@pytest.mark.parametrize("name", LIBRARY.public)
def test_interval_holds_the_evaluator(name: str) -> None:
    drawn = drawn_for(name)
    single = evaluate(LIBRARY, name, drawn.inputs)
    for table in TABLES:
        if name in EXTENDED and table.startswith("opencl"):
            continue
        ok = permitted(LIBRARY, name, drawn.inputs, table, follow_forks=table == "wgsl").contains(single)
        told = f"{table}, {np.unique(drawn.family[~ok])} of {drawn.families}, lanes {np.flatnonzero(~ok)[:5]}"
        assert ok.all(), told


@pytest.mark.parametrize("name", LIBRARY.public)
def test_interval_holds_exact_arithmetic(name: str) -> None:
    drawn = drawn_for(name)
    value, lost = enclosed(LIBRARY, name, drawn.inputs)
    found = {
        t: permitted(LIBRARY, name, drawn.inputs, either_way(load_table(t)), follow_forks=t == "wgsl")
        for t in ("wgsl", "opencl")
    }
    verdicts = {t: held(f, value, lost) for t, f in found.items()}
    some = np.flatnonzero(np.logical_or.reduce([v.undecided for v in verdicts.values()]))[:PRECISE]
    precise = precisely(LIBRARY, name, drawn.inputs, some)
    for table, verdict in verdicts.items():
        outside = np.flatnonzero(verdict.outside)
        assert not len(outside), f"{table}, lanes {outside[:5]}"
        missed = some[~(holds(found[table], some, precise) | verdict.open[some])]
        assert not len(missed), f"50 digits, {table}, lanes {missed[:5]}"


@pytest.mark.parametrize("name", ["hammersley", "latlong_direction", "half_vector", "shell_strand_mask"])
def test_following_forks_only_narrows(name: str) -> None:
    drawn = together(draws(LIBRARY.function(name), UNIFORM, FAMILY))
    wide = permitted(LIBRARY, name, drawn.inputs, "wgsl", follow_forks=False)
    narrow = permitted(LIBRARY, name, drawn.inputs, "wgsl")
    assert (narrow.guaranteed >= wide.guaranteed).all()
    assert wide.contains(narrow.low).all()
    assert wide.contains(narrow.high).all()


@pytest.mark.parametrize("text", TOO_TIGHT)
def test_too_tight_a_row_is_caught(text: str, tmp_path: Path) -> None:
    library = library_of(tmp_path, f"def probe(a: X) -> f32:\n    return {text}\n")
    inputs = {"a": np.linspace(0.1, 2.9, 999).astype(np.float32)}
    single = evaluate(library, "probe", inputs)
    table = load_table("wgsl")
    assert permitted(library, "probe", inputs, table).contains(single).all()
    assert not permitted(library, "probe", inputs, tightened(table, text)).contains(single).all()


def changed(table: Table, **changes: Any) -> Table:
    return replace(table, **changes)


def test_too_tight_a_setting_is_caught(tmp_path: Path) -> None:
    library = library_of(tmp_path, "def probe(a: X, b: X, c: X) -> f32:\n    return a * b + c\n")
    rng = np.random.default_rng(20260801)
    a, b = (rng.uniform(1.0, 2.0, 2000).astype(np.float32) for _ in range(2))
    exact = a.astype(np.float64) * b.astype(np.float64)
    c = -exact.astype(np.float32)
    inputs = {"a": a, "b": b, "c": c}
    fused = (exact + c.astype(np.float64)).astype(np.float32)
    upward = np.nextafter(exact.astype(np.float32), np.float32(9.0)) + c
    wgsl, opencl = load_table("wgsl"), load_table("opencl")
    assert permitted(library, "probe", inputs, wgsl).contains(fused).all()
    assert permitted(library, "probe", inputs, opencl).contains(fused).all()
    assert not permitted(library, "probe", inputs, changed(opencl, fused=False)).contains(fused).all()
    above = exact > exact.astype(np.float32)
    assert permitted(library, "probe", inputs, wgsl).contains(upward)[above].all()
    assert (
        not permitted(library, "probe", inputs, changed(wgsl, rounding="nearest"))
        .contains(upward)[above]
        .all()
    )
    tiny = {"a": a, "b": np.full(2000, 2.0**-127, np.float32), "c": np.zeros(2000, np.float32)}
    flushed = np.zeros(2000, np.float32)
    assert permitted(library, "probe", tiny, wgsl).contains(flushed).all()
    assert not permitted(library, "probe", tiny, changed(wgsl, flush=False)).contains(flushed).any()
