"""PNG files appear whole or not at all; the picture of differences has one labelled scale."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from codegen.errors import UserError
from conformance.picture.image import contact_sheet, difference_sheet, full_scale, heat, write_png

PICTURE = np.arange(4 * 5 * 3, dtype=np.uint8).reshape(4, 5, 3)


def test_a_picture_survives(tmp_path: Path) -> None:
    write_png(tmp_path / "a.png", PICTURE)
    with Image.open(tmp_path / "a.png") as image:
        np.testing.assert_array_equal(np.asarray(image), PICTURE)


def test_a_picture_is_the_same_to_the_byte(tmp_path: Path) -> None:
    write_png(tmp_path / "a.png", PICTURE)
    write_png(tmp_path / "b.png", PICTURE)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_a_failure_leaves_the_old_file_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_png(tmp_path / "a.png", PICTURE)
    before = (tmp_path / "a.png").read_bytes()

    def full(source: object, target: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(UserError, match="No space left on device"):
        write_png(tmp_path / "a.png", PICTURE[::-1])
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]
    assert (tmp_path / "a.png").read_bytes() == before


def test_an_unwritable_place_is_named(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="absent"):
        write_png(tmp_path / "absent" / "a.png", PICTURE)


@pytest.mark.parametrize(
    ("largest", "scale"), [(0.0, 1.0), (1.0, 1.0), (0.0034, 0.005), (0.0012, 0.002), (7.0, 10.0), (0.2, 0.2)]
)
def test_the_scale_is_a_round_number(largest: float, scale: float) -> None:
    assert full_scale(largest) == pytest.approx(scale)


def test_heat_grows_with_the_difference() -> None:
    brightness = heat(np.linspace(0.0, 2.0, 50)[None], 2.0).astype(int).sum(axis=2)[0]
    assert (np.diff(brightness) > 0).all()
    np.testing.assert_array_equal(heat(np.array([[2.0]]), 2.0), heat(np.array([[9.0]]), 2.0))


def test_sheets_hold_every_panel() -> None:
    panels = [(f"panel {k}", np.full((40, 60, 3), 50 * k, dtype=np.uint8)) for k in range(3)]
    sheet = contact_sheet(panels, columns=2)
    for _, panel in panels[1:]:
        assert np.count_nonzero((sheet == panel[0, 0]).all(axis=2)) >= 40 * 60
    assert difference_sheet([("a", np.zeros((40, 60))), ("b", np.ones((40, 60)))]).ndim == 3
