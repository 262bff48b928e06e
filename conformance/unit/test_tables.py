"""Tables of functions of two arguments: axes, the error budget, and `vair table`."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from codegen.cli import run
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.library import load_library
from codegen.maps.image import read_pixels
from codegen.tables.arguments import two_arguments
from codegen.tables.axes import Axis
from codegen.tables.stored import read_angle_table
from codegen.tables.tabulate import made, tabulate
from conformance.unit.support.tolerances import tolerance

HOLE = 1e-4
"""Half the width of a hole in a function, small against the cells of a table."""


@pytest.mark.parametrize("warp", ["linear", "angle", "root", "log"])
def test_warps_are_undone(warp: str) -> None:
    axis = Axis("x", 0.25, 1.0, warp)
    values = np.linspace(0.25, 1.0, 33)
    assert warp in axis.warps()
    assert np.abs(axis.value(axis.coordinate(values)) - values).max() <= tolerance("warps")
    assert axis.coordinate(np.array([0.25, 1.0, 0.0, 7.0])).tolist() == [0.0, 1.0, 0.0, 1.0]


def test_only_fitting_warps_are_tried() -> None:
    assert Axis("x", -1.0, 1.0).warps() == ["linear", "angle"]
    assert Axis("x", 0.0, 8.0).warps() == ["linear", "root"]
    assert Axis("x", 1e-3, 8.0).warps() == ["linear", "root", "log"]


def test_a_bilinear_function_needs_the_smallest_table() -> None:
    x, y = Axis("x", -1.0, 1.0), Axis("y", 0.0, 2.0)
    table = tabulate(x, y, lambda a, b: 1.0 + a - 2.0 * b + a * b, 1e-6)
    assert table.values.shape == (8, 8) and (table.x.warp, table.y.warp) == ("linear", "linear")
    assert table.error <= tolerance("stored_table") * 2.0


def test_a_square_root_at_the_end_picks_the_warp_that_straightens_it() -> None:
    table = tabulate(Axis("x", 0.0, 1.0), Axis("y", 0.0, 1.0), lambda a, b: np.sqrt(a) + b, 1e-6)
    assert (table.x.warp, table.y.warp) == ("root", "linear")


def test_a_value_that_is_missing_between_texels_is_no_error_of_zero() -> None:
    hole = 0.25 / 7.0  # a quarter of the first of seven cells: no texel lies there, but a point of measure

    def holed(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return np.asarray(np.where(np.abs(a - hole) < HOLE, np.nan, 0.0) + b)

    with pytest.raises(UserError, match=r"the function is nan at x = 0\.0357"):
        tabulate(Axis("x", 0.0, 1.0), Axis("y", 0.0, 1.0), holed, 1e-3)


def test_the_sides_differ_where_the_function_does() -> None:
    table = tabulate(Axis("x", 0.0, 1.0), Axis("y", 0.0, 1.0), lambda a, b: np.sin(20.0 * a) + b, 1e-3)
    height, width = table.values.shape
    assert height == 8 and width > 8


def test_the_error_is_the_largest_that_other_points_find() -> None:
    x, y, function = two_arguments(load_library(), "strand_specular", {"exponent": 16.0})
    table = made(replace(x, warp="angle"), replace(y, warp="angle"), function, 32, 32)
    a, b = np.random.default_rng(9).uniform(-1.0, 1.0, (2, 20_000))
    found = float(np.abs(table.value(a, b) - function(a, b)).max())
    assert table.error / 2.0 <= found <= 1.1 * table.error


def test_the_banks_cosine_on_warped_axes() -> None:
    x, y, function = two_arguments(load_library(), "strand_cosine", {})
    warped = made(replace(x, warp="angle"), replace(y, warp="angle"), function, 256, 256)
    assert warped.error <= tolerance("banks_table")
    # A square root at either end: linear axes cannot follow it.
    assert made(x, y, function, 256, 256).error > 100.0 * tolerance("banks_table")


def test_the_command_writes_a_table_that_its_description_explains(tmp_path: Path) -> None:
    out = tmp_path / "out"
    arguments = ["pow_one_minus", "--range", "q=0:1", "--range", "p=4:64", "--budget", "0.01"]
    assert run(["table", *arguments, "-o", str(out)]) == 0
    manifest = json.loads((out / "table.json").read_text())
    pixels = read_pixels(out / "table.exr")[:, :, 0]
    assert pixels.shape == (manifest["height"], manifest["width"])
    assert manifest["error"] <= manifest["budget"] == 0.01
    axes = [Axis(**manifest[name]) for name in ("x", "y")]
    q, p = (axis.value(np.linspace(0.0, 1.0, n)) for axis, n in zip(axes, pixels.T.shape, strict=True))
    expected = (1.0 - q[None, :]) ** p[:, None]
    assert np.abs(pixels - expected).max() <= tolerance("stored_table")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["strand_cosin"], 'did you mean "strand_cosine"?'),
        (["sin_angle"], "sin_angle has the open arguments a, b; a table has two: hold the others by --set"),
        (["fur_opacity"], "fur_opacity has the open arguments"),
        (["strand_azimuth_cosine"], "depends on the angle between l and v too"),
        (["banks_shade"], "a table holds numbers, and this function returns no number"),
        (["pow_one_minus", "--set", "r=1"], 'unknown parameter of pow_one_minus "r"'),
        (["pow_one_minus", "--range", "q=0:9"], "the range 0:9 of q is no part of [0, 2]"),
        (["pow_one_minus", "--range", "q=0"], '--range "q=0": it is NAME=LOW:HIGH'),
        (["strand_cosine", "--budget", "0"], "budget 0: the largest error of a table is above 0"),
        (["strand_cosine", "--budget", "1e-9", "--largest", "64"], "no table of 64 x 64 texels keeps within"),
        (["strand_cosine", "--largest", "4"], "largest side 4: a table has 8 to 8192 texels along a side"),
        (["strand_cosine", "--budget", "nan"], "budget nan: the largest error of a table is above 0"),
    ],
)  # fmt: skip
def test_bad_usage_gets_one_sentence_and_writes_nothing(
    arguments: list[str], told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["table", *arguments, "-o", str(tmp_path / "out")]) == 2
    assert told in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_largest_size_below_what_is_tried_is_refused_with_the_size_tried() -> None:
    with pytest.raises(UserError, match="no table of 8 x 8 texels"):
        tabulate(Axis("x", 0.0, 1.0), Axis("y", 0.0, 1.0), lambda a, b: np.sin(50.0 * a), 1e-6, largest=8)


def test_a_function_without_a_finite_value_is_refused_with_the_place() -> None:
    x, y = Axis("a", 0.0, 1.0), Axis("b", 0.0, 1.0)
    with pytest.raises(UserError, match="the function is inf at a = 0, b = 0"), np.errstate(divide="ignore"):
        tabulate(x, y, lambda a, b: 1.0 / a, 1e-3)


def test_a_folder_that_cannot_be_written_gets_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "file"
    file.write_text("kept")
    for output, told in ((file, "it is a file"), (tmp_path / "no" / "out", "does not exist")):
        assert run(["table", "strand_cosine", "--budget", "0.1", "-o", str(output)]) == 2
        assert told in capsys.readouterr().err
    assert file.read_text() == "kept" and [path.name for path in tmp_path.iterdir()] == ["file"]


def test_a_written_table_is_read_as_a_map(tmp_path: Path) -> None:
    assert run(["table", "strand_cosine", "--budget", "0.01", "-o", str(tmp_path / "cosine")]) == 0
    table = read_angle_table(tmp_path / "cosine")
    c = np.linspace(-1.0, 1.0, 41)
    cos_l, cos_v = (grid.ravel() for grid in np.meshgrid(c, c))
    inputs = {"table": table, "cos_l": cos_l, "cos_v": cos_v}
    found = np.asarray(evaluate(load_library(), "strand_cosine_table", inputs, "float64"))
    exact = np.sqrt((1.0 - cos_l**2) * (1.0 - cos_v**2)) - cos_l * cos_v
    assert (
        np.abs(found - exact).max() <= json.loads((tmp_path / "cosine" / "table.json").read_text())["budget"]
    )
    assert run(["table", "pow_one_minus", "--range", "p=4:64", "-o", str(tmp_path / "power")]) == 0
    with pytest.raises(UserError, match="its axes are q by"):
        read_angle_table(tmp_path / "power")
    with pytest.raises(UserError, match=r"no table\.json"):
        read_angle_table(tmp_path)
