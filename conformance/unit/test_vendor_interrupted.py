"""An interrupted `vair vendor` leaves the old set or the new one; runs at the same time do not mix.

Plan.
  every step  a fault before and after each step of the file system, one at a time; the folder then holds one
              set. Where other files share the folder, the set is moved file by file: there one set is whole
              after the next run, and until then verify says so
  kills       processes that write two sets in turn are killed at random moments
  together    several processes write into one folder, a reader that takes its turn finds one whole set
"""

import contextlib
import os
import random
import shutil
import signal
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from codegen.errors import UserError
from codegen.vendor import install as installing
from codegen.vendor.exclusive import exclusive
from codegen.vendor.install import install
from codegen.vendor.lock import NAME, read_lock
from codegen.vendor.state import UNFINISHED, states
from conformance.unit.support.stopped import Stop, forked, stopping
from conformance.unit.support.vendored import content, expected, other_plan, small_plan

STEPS = ((os, "rename"), (os, "replace"), (shutil, "rmtree"), (installing, "exchange"), (Path, "write_text"))
MOST_STEPS = 60
KILLS = [20, pytest.param(200, marks=pytest.mark.nightly)]
LONGEST = 0.02
"""Seconds until a kill, at most: several updates take that long."""


@pytest.mark.parametrize("after", [False, True])
@pytest.mark.parametrize("shared", [False, True])
def test_every_step_leaves_one_set(shared: bool, after: bool, tmp_path: Path) -> None:
    small, other = small_plan(), other_plan()
    kept = {"README": "mine"} if shared else {}
    mixed = 0
    for at in range(1, MOST_STEPS):
        folder = tmp_path / str(at) / "v"
        folder.parent.mkdir()
        install(folder, small)
        for name, text in kept.items():
            (folder / name).write_text(text)
        with pytest.MonkeyPatch.context() as patch, contextlib.suppress(Stop):
            steps = stopping(patch, STEPS, at, after=after)
            install(folder, other)
        found = content(folder)
        whole = [{**expected(plan), **kept} for plan in (small, other)]
        unfinished = (folder / UNFINISHED).exists()
        assert found in whole or (shared and unfinished)
        if unfinished and (folder / NAME).read_text() == small.lock_text:
            mixed += 1
            found_states = states(folder, small.lock, small.files)
            assert any("vair vendor finishes it" in s.note for s in found_states)
        install(folder, small)
        assert content(folder.parent) == {f"v/{name}": text for name, text in whole[0].items()}
        if steps() < at:
            break
    else:
        pytest.fail(f"more than {MOST_STEPS} steps")
    assert at > 5
    assert (mixed > 0) == shared


def test_a_finished_set_that_somebody_damaged_is_dropped_only_by_force(tmp_path: Path) -> None:
    folder = tmp_path / "v"
    install(folder, small_plan())
    (folder / UNFINISHED).mkdir()
    (folder / UNFINISHED / NAME).write_text("format = 1\n")
    with pytest.raises(UserError, match=f"{UNFINISHED}/{NAME}"):
        install(folder, small_plan())
    install(folder, small_plan(), force=True)
    assert content(tmp_path) == {f"v/{name}": text for name, text in expected(small_plan()).items()}


@pytest.mark.parametrize("count", KILLS)
def test_killed_processes_leave_one_set(count: int, tmp_path: Path) -> None:
    plans = [small_plan(), other_plan()]
    folder = tmp_path / "v"
    install(folder, plans[0])

    def work() -> None:
        while True:
            for plan in reversed(plans):
                install(folder, plan)

    seed = count
    print(f"seed {seed}")
    drawn = random.Random(seed)
    whole = [expected(plan) for plan in plans]
    for _ in range(count):
        with forked(work) as child:
            time.sleep(drawn.uniform(0.0, LONGEST))
            os.kill(child, signal.SIGKILL)
            status = os.waitpid(child, 0)[1]
        assert os.waitstatus_to_exitcode(status) == -signal.SIGKILL
        assert content(folder) in whole
    install(folder, plans[0])
    assert content(tmp_path) == {f"v/{name}": text for name, text in whole[0].items()}


def test_runs_at_the_same_time_do_not_mix(tmp_path: Path) -> None:
    plans = [small_plan(), other_plan()]
    folder = tmp_path / "v"

    def work(first: int) -> Callable[[], None]:
        def updates() -> None:
            for k in range(10):
                install(folder, plans[(first + k) % 2])

        return updates

    with contextlib.ExitStack() as stack:
        children = [stack.enter_context(forked(work(k))) for k in range(4)]
        for _ in range(20):
            with exclusive(folder):
                if folder.exists():
                    lock = read_lock(folder / NAME)
                    files = next(plan.files for plan in plans if plan.lock == lock)
                    assert states(folder, lock, files) == []
        assert [os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) for child in children] == [0] * 4
    assert content(tmp_path) in [{f"v/{n}": t for n, t in expected(plan).items()} for plan in plans]
