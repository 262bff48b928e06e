"""The example scenes on devices: found, proven, and as cheap as they claim.

Plan. Each scene of examples/scenes/specialised is built for one target at a time and executed beside the
general function; a tenth of the points by default, all of them at night. Then once with speed, for arrays and
plain parameters alike, since a kernel that measures is a program of its own.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from codegen.library import load_library
from codegen.scene import build
from codegen.scene.build import Builder, Outcome
from codegen.scene.description.document import HALF_STEP, read_scene
from codegen.scene.report import stopwatch
from targets import TimedRuntime

SCENES = Path(__file__).parents[2] / "examples" / "scenes" / "specialised"
NAMES = sorted(path.stem for path in SCENES.glob("*.toml"))
FEW = 10_000


def built(name: str, runtime: TimedRuntime, *, timed: bool) -> Outcome:
    scene = read_scene(SCENES / f"{name}.toml", load_library())
    target = runtime.device.target
    scene = replace(scene, dialects={target: scene.dialects[target]})
    return Builder(load_library(), scene, {target: runtime}, timed=timed).build()


def judge(outcome: Outcome) -> None:
    [result] = outcome.targets
    assert result.proof.executed
    assert result.proof.error.finite
    assert result.proof.error.largest <= outcome.scene.budget
    assert result.exact_proof.outside == 0
    assert sum(result.operations["final"].values()) < 0.75 * sum(result.operations["general"].values())


def test_there_are_scenes() -> None:
    assert NAMES == ["brushed-metal", "everything", "long-hair", "short-fur"]


@pytest.mark.parametrize("name", ["brushed-metal", "short-fur"])
def test_a_scene_holds_where_it_runs(
    name: str, runtime: TimedRuntime, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(build, "PROOF_POINTS", FEW)
    outcome = built(name, runtime, timed=False)
    judge(outcome)
    if name == "short-fur":
        assert outcome.targets[0].proof.error.largest <= 0.26 * HALF_STEP


@pytest.mark.nightly
@pytest.mark.parametrize("name", NAMES)
def test_every_scene_holds_and_is_timed(
    name: str, runtime: TimedRuntime, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(stopwatch, "ROUNDS", 2)
    outcome = built(name, runtime, timed=True)
    judge(outcome)
    assert len(outcome.targets[0].speeds) == 2
