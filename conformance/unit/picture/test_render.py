"""Pictures by every backend agree with float64; `vair render` refuses bad input in one sentence."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from codegen.cli import run
from codegen.library import load_library
from conformance.picture.backends import models, open_backend
from conformance.picture.render import Studio, set_up
from conformance.picture.tolerances import tolerance
from conformance.picture.tone import steps_apart

SCENES = Path(__file__).parents[3] / "examples" / "scenes"
MESH = SCENES.parent / "data" / "bunny.obj"


def small(folder: Path, name: str, size: int = 96) -> Path:
    """A copy of an example scene with a small picture."""
    text = (SCENES / f"{name}.toml").read_text(encoding="utf-8")
    lines = [f"size = [{size}, {size}]" if line.startswith("size") else line for line in text.splitlines()]
    path = folder / f"{name}.toml"
    path.write_text("\n".join(lines).replace("../data/bunny.obj", str(MESH)), encoding="utf-8")
    return path


@pytest.fixture(scope="module", params=["brushed-bunny", "haired-bunny", "strand-bunny"])
def studio(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Studio:
    path = small(tmp_path_factory.mktemp("scenes"), request.param)
    return set_up(path, models(load_library()))


def difference(studio: Studio, name: str) -> float:
    library = load_library()
    picture, reference = (studio.develop(studio.shade(open_backend(b, library))) for b in (name, "numpy"))
    assert reference[studio.covered].max() > 0.1  # there is something to compare
    return float(steps_apart(picture, reference).max())


def test_the_evaluator_agrees_with_float64(studio: Studio) -> None:
    assert difference(studio, "numpy32") < tolerance("backend_steps")


def test_every_driver_agrees_with_float64(studio: Studio, target: str) -> None:
    assert difference(studio, target) < tolerance("backend_steps")


def test_the_command_writes_a_picture(tmp_path: Path) -> None:
    scene, output = small(tmp_path, "brushed-bunny", 32), tmp_path / "bunny.png"
    assert run(["render", str(scene), "--target", "numpy", "-o", str(output)]) == 0
    with Image.open(output) as image:
        assert image.size == (32, 32)
        assert np.asarray(image).max() > 150


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["{scene}", "-o", "a.jpg"], 'cannot write "a.jpg": pictures are PNG files, whose names end in .png'),
        (["absent.toml", "-o", "a.png"], "absent.toml: there is no such file"),
        (["{scene}", "--target", "opncl", "-o", "a.png"], 'unknown target "opncl"; did you mean "opencl"?'),
        (["{scene}", "--target", "numpy", "-o", "absent/a.png"], 'the folder "absent" does not exist'),
        (["{scene}"], "Missing option '-o'"),
    ],
)
def test_bad_usage_is_one_sentence_and_status_2(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    sentence: str,
) -> None:
    scene = small(tmp_path, "brushed-bunny", 8)
    monkeypatch.chdir(tmp_path)
    assert run(["render", *(word.format(scene=scene) for word in arguments)]) == 2
    output = capsys.readouterr()
    assert sentence in output.err
    assert output.err.count("\n") == 1
    assert output.out == ""
    assert [path.name for path in tmp_path.iterdir()] == ["brushed-bunny.toml"]
