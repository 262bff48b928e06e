"""Work beside the search: what it makes, what it raises, and that a scene is the same with and without.

Plan.
  results  arrays and objects come back as they are, from a process or from whoever waits; one process does
           works in turn, each on what those before left
  errors   an error of the work is raised where its result is asked for
  ends     a process that ends without a result is made up for
  scenes   the files of a scene that has a map are the same to the byte
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from codegen.cli import run
from codegen.errors import UserError
from codegen.maps.image import exr
from codegen.scene.beside import beside, in_turn_beside

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


@pytest.mark.parametrize("forked", [False, True])
def test_results_come_back(forked: bool) -> None:
    made = beside(lambda: (os.getpid(), np.arange(300_000)), forked=forked)
    process, numbers = made()
    assert (process != os.getpid()) == (forked and (os.cpu_count() or 1) > 1)
    assert np.array_equal(numbers, np.arange(300_000))


@pytest.mark.parametrize("forked", [False, True])
def test_works_in_turn_go_on_from_each_other(forked: bool) -> None:
    made: list[int] = []

    def work() -> int:
        made.append(len(made))
        return made[-1]

    waits = in_turn_beside(work, work, work, forked=forked)
    assert [wait() for wait in waits] == [0, 1, 2]
    assert bool(made) == (not forked or os.cpu_count() == 1)


@pytest.mark.parametrize("forked", [False, True])
def test_errors_are_raised_where_the_result_is_asked_for(forked: bool) -> None:
    def refused() -> None:
        raise UserError("no")

    made = beside(refused, forked=forked)
    with pytest.raises(UserError, match="no"):
        made()


def test_a_process_that_ends_is_made_up_for() -> None:
    here = os.getpid()

    def ends() -> int:
        if os.getpid() != here:
            os._exit(1)
        return 7

    assert beside(ends, forked=True)() == 7


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
