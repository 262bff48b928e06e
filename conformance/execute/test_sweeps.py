"""Every number around the critical ones, and in the nightly run every number, on every target."""

from __future__ import annotations

from pathlib import Path

import pytest

from codegen.library import load_library
from conformance.executor import Here, Processes, available
from conformance.executor.state import State
from conformance.sweep import record
from conformance.sweep.plan import SHORT_TOTAL, pieces, short
from conformance.sweep.positions import sweepable
from conformance.sweep.sweep import sweep
from targets import TARGETS

LIBRARY = load_library()
SWEPT = sweepable(LIBRARY)


def test_short_sweep_keeps_the_bounds(target: str) -> None:
    """2^24 numbers around the critical ones of all functions; the rest is for the nightly run."""
    jobs = short(LIBRARY, SWEPT, target)
    assert SHORT_TOTAL // 2 < sum(job.stop - job.start for job in jobs) <= SHORT_TOTAL
    entries, failed = sweep(LIBRARY, SWEPT, jobs, Here())
    assert not failed
    assert not [e for e in entries if not record.passed(e)]


@pytest.mark.nightly
@pytest.mark.spreads
@pytest.mark.timeout(0)
def test_every_number_keeps_the_bounds() -> None:
    """All numbers of all functions, on two processes and every target whose driver is here.

    What an earlier run did with the same sources is not done again.
    """
    targets = [target for target in TARGETS if not available(target)]
    if not targets:
        pytest.skip("no target has a driver here")
    jobs = [job for name, where in SWEPT.items() for target in targets for job in pieces(name, target, where)]
    state = State(Path("build/sweep/state.jsonl"))
    entries, failed = sweep(LIBRARY, SWEPT, jobs, Processes(2), state)
    assert not failed
    assert all(e["kind"] == record.BOUND for e in entries)
    assert not [e for e in entries if not record.passed(e)]
