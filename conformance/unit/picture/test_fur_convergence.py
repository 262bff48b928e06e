"""The figure of shells that converge: every way of drawing comes closer with more layers, and it is drawn."""

import io
from pathlib import Path

import pytest
from PIL import Image

from codegen.library import load_library
from conformance.picture.fur.convergence import converge, figure, main
from conformance.picture.fur.studio import set_up_fur
from conformance.picture.scene import SCENES
from conformance.picture.tolerances import tolerance
from conformance.unit.support.drivers import need


def test_every_way_of_drawing_comes_closer() -> None:
    need("glsl")
    path = SCENES / "furry-bunny.toml"
    studio = set_up_fur(load_library(), path, size=(24, 24), supersample=1, subdivide=0)
    found = converge(studio, ("numpy32", "glsl"), (3, 9), 17)
    assert [one.name for one in found.series] == ["rays on numpy32", "drawn by OpenGL"]
    for one in found.series:
        assert 1.0 < one.steps[9] < tolerance("fur_layers") * one.steps[3]
    rays, drawn = (one.steps for one in found.series)
    assert all(abs(rays[count] - drawn[count]) < tolerance("fur_mean_steps") for count in rays)
    with Image.open(io.BytesIO(figure(found, 17, (3,)))) as image:
        assert image.size[0] > 1000 and len(image.convert("RGB").getcolors(1 << 20) or ()) > 50


def test_a_scene_without_fur_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    output = tmp_path / "figure.png"
    said = ["convergence", "-o", str(output), "--scene", str(SCENES / "haired-bunny.toml")]
    monkeypatch.setattr("sys.argv", said)
    assert main() == 2
    assert "has no [fur] table" in capsys.readouterr().err and not output.exists()
