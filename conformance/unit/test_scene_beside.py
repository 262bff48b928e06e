"""Work beside the search: what it makes, what it raises, and that a scene is the same with and without.

Plan.
  results  arrays and objects come back as they are, from a process or from whoever waits; one process does
           works in turn, each on what those before left
  errors   an error of the work is raised where its result is asked for
  ends     a process that ends without a result is made up for; one that nobody waits for is ended
  scenes   the files of a scene that has a map are the same to the byte
"""

from __future__ import annotations

import multiprocessing
import os
import time
from pathlib import Path

import numpy as np
import pytest

from codegen.cli import run
from codegen.errors import UserError
from codegen.maps.image import exr
from codegen.scene.beside import Beside

SCENE = """
[scene]
budget = "exact"
targets = ["wgsl"]
[shade]
model = "brushed"
[view]
min_n_dot_v = 0.05
[lights]
environment = "sky.exr"
environment_lights = 2
"""


REFUSED = """
[scene]
budget = 1e-12
[shade]
model = "kajiya_kay"
"""


@pytest.mark.parametrize("forked", [False, True])
def test_results_come_back(forked: bool) -> None:
    with Beside(forked=forked) as beside:
        process, numbers = beside.one(lambda: (os.getpid(), np.arange(300_000)))()
    assert (process != os.getpid()) == (forked and (os.cpu_count() or 1) > 1)
    assert np.array_equal(numbers, np.arange(300_000))


@pytest.mark.parametrize("forked", [False, True])
def test_works_in_turn_go_on_from_each_other(forked: bool) -> None:
    made: list[int] = []

    def work() -> int:
        made.append(len(made))
        return made[-1]

    with Beside(forked=forked) as beside:
        assert [wait() for wait in beside.in_turn(work, work, work)] == [0, 1, 2]
    assert bool(made) == (not forked or os.cpu_count() == 1)


@pytest.mark.parametrize("forked", [False, True])
def test_errors_are_raised_where_the_result_is_asked_for(forked: bool) -> None:
    def refused() -> None:
        raise UserError("no")

    with Beside(forked=forked) as beside, pytest.raises(UserError, match="no"):
        beside.one(refused)()


def test_a_process_that_ends_is_made_up_for() -> None:
    here = os.getpid()

    def ends() -> int:
        if os.getpid() != here:
            os._exit(1)
        return 7

    with Beside(forked=True) as beside:
        assert beside.one(ends)() == 7


def test_what_nobody_waits_for_is_given_up(tmp_path: Path) -> None:
    """Neither a process that still works nor one that holds more than a pipe takes goes on."""
    with pytest.raises(UserError), Beside(forked=True) as beside:
        beside.one(lambda: np.zeros(1_000_000))
        beside.one(lambda: time.sleep(600))
        assert os.cpu_count() == 1 or len(multiprocessing.active_children()) == 2
        raise UserError("refused")
    assert not multiprocessing.active_children()
    (tmp_path / "scene.toml").write_text(REFUSED, encoding="utf-8")
    command = ["scene", str(tmp_path / "scene.toml"), "-o", str(tmp_path / "made"), "--no-drivers"]
    assert run(command) == 2
    assert not multiprocessing.active_children()


def test_a_scene_is_the_same_without_a_second_process(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = np.linspace(0.1, 1.0, 8)[:, None, None] * np.ones((8, 16, 3))
    (tmp_path / "sky.exr").write_bytes(exr(rows.astype(np.float32)))
    (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")

    def files(folder: str) -> dict[str, bytes]:
        made = tmp_path / folder
        assert run(["scene", str(tmp_path / "scene.toml"), "-o", str(made), "--no-drivers"]) == 0
        return {p.name: p.read_bytes() for p in made.iterdir()}

    apart = files("apart")

    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    assert files("alone") == apart
