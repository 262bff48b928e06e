"""The example programs draw what `vair fur` writes without Vair, and get the picture of `vair render`."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
import trimesh
from PIL import Image

from codegen.cli import run
from conformance.picture.tolerances import tolerance
from conformance.unit.support.drivers import need

EXAMPLES = Path(__file__).parents[3] / "examples"
PROGRAMS = {"opengl": "glsl", "webgpu": "wgsl"}


@pytest.fixture(scope="module")
def kit(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A ball with fur, and the scene it is from."""
    folder = tmp_path_factory.mktemp("kit")
    trimesh.creation.icosphere(subdivisions=2).export(folder / "ball.ply")
    text = (EXAMPLES / "scenes" / "furry-bunny.toml").read_text(encoding="utf-8")
    for old, new in [
        ("../data/bunny.obj", "ball.ply"),
        ("[640, 640]", "[70, 50]"),
        ("[0.1, 4.75, 0.0]", "[0.0, 0.0, 0.0]"),
        ("27.0", "7.0"),
        ("layers = 32", "layers = 6"),
        ("supersample = 2", "supersample = 1"),
    ]:
        assert old in text
        text = text.replace(old, new)
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    assert run(["fur", str(folder / "scene.toml"), "-o", str(folder / "kit")]) == 0
    return folder


@pytest.mark.parametrize("program", PROGRAMS)
def test_the_program_draws_the_picture_of_vair_render(kit: Path, program: str) -> None:
    need(PROGRAMS[program])
    ours, theirs = kit / f"vair-{program}.png", kit / f"{program}.png"
    scene = str(kit / "scene.toml")
    assert run(["render", scene, "--target", PROGRAMS[program], "-o", str(ours)]) == 0
    command = [sys.executable, str(EXAMPLES / "fur" / f"{program}.py"), str(kit / "kit"), "-o", str(theirs)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    expected, found = pixels(ours), pixels(theirs)
    assert expected.std() > 10.0
    # The same device draws both; a second one would differ at the edge of a hair here and there.
    assert np.abs(expected - found).max() < tolerance("fur_pixel_steps")


def pixels(path: Path) -> npt.NDArray[np.int64]:
    with Image.open(path) as image:
        return np.asarray(image).astype(np.int64)
