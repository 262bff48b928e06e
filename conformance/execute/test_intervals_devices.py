"""Every result of a device lies in the interval that the target's specification permits.

Plan. For each public function and target, random points and every family of hard cases: each result inside
the interval under the target's table. Known exceptions of drivers stand in interval_exceptions.toml with
their cause; the share of lanes they may have is bounded.
Not covered here: how near results are (test_functions.py).
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.execute import execute
from codegen.intervals import DEFAULT_TABLES, permitted
from codegen.library import load_library
from conformance.check import show
from conformance.check.engine import draws
from conformance.guarantees.sample import together
from targets import TimedRuntime

LIBRARY = load_library()
UNIFORM, FAMILY = 2000, 200
EXCEPTIONS: list[dict[str, Any]] = tomllib.loads(
    Path(__file__).with_name("interval_exceptions.toml").read_text(encoding="utf-8")
)["exception"]


def allowed_share(name: str, runtime: TimedRuntime) -> float:
    """The share of results that a known fault of the driver may put outside."""
    device = f"{runtime.device.driver} {runtime.device.device}"
    fitting = [e for e in EXCEPTIONS if e["driver"] in device and name in e["functions"]]
    return float(max((e["share"] for e in fitting), default=0.0))


@pytest.mark.parametrize("name", LIBRARY.public)
def test_results_are_permitted(name: str, target: str, runtime: TimedRuntime) -> None:
    table = DEFAULT_TABLES[target]
    drawn = together(draws(LIBRARY.function(name), UNIFORM, FAMILY))
    found = permitted(LIBRARY, name, drawn.inputs, table)
    got = execute(LIBRARY, name, drawn.inputs, runtime)
    bad = np.flatnonzero(~found.contains(got))
    if len(bad) > allowed_share(name, runtime) * drawn.lanes:
        lane = int(bad[0])
        ends = f"[{show.one(found.low, lane)}, {show.one(found.high, lane)}]"
        told = f"{show.lane_inputs(drawn.inputs, lane)} gave {show.one(got, lane)}, not in {ends}"
        pytest.fail(
            f"{len(bad)} of {drawn.lanes} outside {table}; {drawn.where(lane)}: {told}", pytrace=False
        )
