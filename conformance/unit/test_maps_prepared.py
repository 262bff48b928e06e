"""`vair env`: what it writes, and one sentence for everything that is wrong."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from codegen.cli import run
from codegen.errors import UserError
from codegen.maps import paraboloid
from codegen.maps.image import exr, read_pixels
from codegen.maps.prepared import LARGEST, MAPPINGS, Settings, check, prepare

DATA = Path(__file__).parents[2] / "examples" / "data"
ROUNDING = 2.0**-23
"""Files hold float32."""
SUMS = 1e-9
"""Float64 sums over the texels of one level."""


@pytest.fixture
def sky(tmp_path: Path) -> Path:
    """A small map, bright above."""
    pixels = np.ones((16, 32, 3)) * np.linspace(4.0, 0.0, 16)[:, None, None]
    path = tmp_path / "sky.exr"
    path.write_bytes(exr(pixels))
    return path


def test_the_files_hold_what_the_description_says(sky: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    arguments = ["--size", "32", "--prefilter", "1", "--prefilter", "20.5"]
    assert run(["env", str(sky), "-o", str(out), *arguments]) == 0
    manifest = json.loads((out / "env.json").read_text())
    assert [level["width"] for level in manifest["levels"]] == [64, 32, 16, 8, 4, 2]
    listed = [item["file"] for item in manifest["levels"] + manifest["prefiltered"]] + ["env.json"]
    assert sorted(listed) == sorted(path.name for path in out.iterdir())
    for level in manifest["levels"]:
        assert read_pixels(out / level["file"]).shape == (level["height"], level["width"], 3)
    again = tmp_path / "again"
    assert run(["env", str(sky), "-o", str(again), *arguments]) == 0
    assert all((again / name).read_bytes() == (out / name).read_bytes() for name in listed)


def test_lobes_of_near_exponents_have_files_of_their_own(sky: Path) -> None:
    found = prepare(sky, Settings(size=8, exponents=(12345.67, 12345.68, 12345.67)))
    files = [lobe["file"] for lobe in found.manifest["prefiltered"]]
    assert files == ["phong_12345.67.exr", "phong_12345.68.exr"]
    assert set(files) <= set(found.images)


def test_the_last_levels_hold_the_mean_of_each_half_of_the_sky(sky: Path) -> None:
    found = prepare(sky, Settings(size=64))
    s, t = paraboloid.points(64, paraboloid.BORDER)
    weights = paraboloid.solid_angles(64, paraboloid.BORDER)
    front = found.chain[0][:, :64]
    mean = (front * weights[..., None]).sum((0, 1)) / weights.sum()
    assert np.abs(found.chain[-1][0, 0] - mean).max() <= ROUNDING
    assert s.shape == t.shape == (64, 64)


@pytest.mark.parametrize("mapping", MAPPINGS)
@pytest.mark.parametrize("size", [1, 5, 32])
def test_every_mapping_and_size_ends_in_one_texel_per_face(sky: Path, mapping: str, size: int) -> None:
    chain = prepare(sky, Settings(mapping=mapping, size=size)).chain
    assert chain[-1].shape[:2] == ((1, 2) if mapping == "dual-paraboloid" else (3, 3))
    assert all(np.isfinite(level).all() for level in chain)


def test_a_black_map_and_a_map_of_one_texel_are_maps(tmp_path: Path) -> None:
    for shape, value in (((4, 8, 3), 0.0), ((1, 1, 3), 2.0), ((3, 5, 3), 1e5)):
        path = tmp_path / "small.exr"
        path.write_bytes(exr(np.full(shape, value)))
        found = prepare(path, Settings(size=8, exponents=(2.0,)))
        assert all(np.isfinite(image).all() for image in found.images.values())
        assert np.abs(found.chain[-1] - value).max() <= value * ROUNDING


def test_one_texel_at_1e5_keeps_its_energy_through_the_chain(tmp_path: Path) -> None:
    pixels = np.zeros((64, 128, 3))
    pixels[20, 30] = 1e5
    path = tmp_path / "sun.exr"
    path.write_bytes(exr(pixels))
    found = prepare(path, Settings(size=64))
    weights = np.tile(paraboloid.solid_angles(64, paraboloid.BORDER), (1, 2))
    energy = (found.chain[0] * weights[..., None]).sum()
    half = weights.sum() / 2.0
    # The largest level is resampled from the map; from there on nothing is lost.
    assert abs(found.chain[-1].sum() * half - energy) <= energy * SUMS * len(found.chain)


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        (Settings(mapping="paraboloid"), 'unknown mapping "paraboloid"; did you mean "dual-paraboloid"'),
        (Settings(size=0), f"--size 0: a map has 1 to {LARGEST} texels along a side"),
        (Settings(border=0.9), "--border 0.9: the border is a factor of 1 to 4; 1 shows none"),
        (Settings(exponents=(-1.0,)), r"--prefilter -1: a lobe's exponent is in \[0, 1e5\]"),
    ],
)
def test_settings_that_no_map_can_have(settings: Settings, told: str) -> None:
    with pytest.raises(UserError, match=told):
        check(settings)


def test_nothing_is_written_where_something_is_wrong(
    sky: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert run(["env", str(DATA / "dawn.exr"), "-o", str(out)]) == 2
    assert "163 pixels are no radiance" in capsys.readouterr().err
    assert run(["env", str(tmp_path / "absent.exr"), "-o", str(out)]) == 2
    assert "no such file" in capsys.readouterr().err
    assert run(["env", str(sky), "-o", str(tmp_path / "no" / "out")]) == 2
    assert "does not exist" in capsys.readouterr().err
    assert not out.exists() and [path.name for path in tmp_path.iterdir()] == ["sky.exr"]


@pytest.mark.parametrize(
    ("arguments", "noted"),
    [([], False), (["--size", "12"], True), (["--border", "1.5"], True), (["--mapping", "octahedral"], True)],
)
def test_maps_that_the_estimators_misread_are_noted(
    sky: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], noted: bool
) -> None:
    assert run(["env", str(sky), "-o", str(tmp_path / "out"), "--size", "16", *arguments]) == 0
    told = capsys.readouterr().err
    assert ("note: the env_* functions will misread this map" in told) == noted
    assert told.count("\n") == noted
