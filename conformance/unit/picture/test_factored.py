"""Factored reflectances in pictures: constants are a Lambert surface; published materials are drawn."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

from codegen.factors.maps import FactorMaps, read_factor_maps
from codegen.library import load_library
from conformance.factored.published import WATERLOO
from conformance.picture.backends import open_backend
from conformance.picture.factored import LIGHTS, main, shade_factored
from conformance.picture.from_maps.bodies import Body, see_body
from conformance.picture.from_maps.plate import PLAN
from conformance.picture.tolerances import tolerance
from conformance.picture.vectors import unit
from targets import TARGETS, TargetUnavailable, probe

LIBRARY = load_library()
MATERIALS = ("satin", "garnetred")


@pytest.fixture(scope="module")
def ball() -> Body:
    return see_body("sphere", PLAN["body"]["sphere"] | {"size": 24})


def test_constant_factors_are_a_lambert_surface(ball: Body) -> None:
    even = np.full((4, 4, 4), 0.5, np.float32)
    maps = FactorMaps("even", "factored_shade", np.array([1.0, 2.0, 4.0], np.float32), even, even)
    shaded = shade_factored(open_backend("numpy", LIBRARY), ball, maps)
    expected = np.zeros((len(ball), 3))
    for light in LIGHTS:
        towards = unit(np.array(light.direction))
        cosine = np.maximum(ball.view.normal @ towards, 0.0)
        expected += 0.125 * maps.scale * np.array(light.colour) * cosine[:, None]
    assert np.abs(shaded - expected).max() < tolerance("factored_lambert")


@pytest.mark.parametrize("material", MATERIALS)
def test_drivers_draw_the_same_material(material: str, ball: Body) -> None:
    if not (WATERLOO / material).is_dir():
        pytest.skip("needs the factors of the Waterloo repository, which may not be passed on")
    maps = read_factor_maps(WATERLOO / material)
    truth = shade_factored(open_backend("numpy", LIBRARY), ball, maps)
    assert truth.max() > 0.0
    drawn = 0
    for target in TARGETS:
        if not isinstance(probe(target), TargetUnavailable):
            shaded = shade_factored(open_backend(target, LIBRARY), ball, maps)
            assert np.abs(shaded - truth).max() < tolerance("factored_share") * truth.max(), target
            drawn += 1
    assert drawn, "no driver is here"


def test_the_command_draws_a_row_for_each_body(tmp_path: Path) -> None:
    if not WATERLOO.is_dir():
        pytest.skip("needs the factors of the Waterloo repository, which may not be passed on")
    output = tmp_path / "satin.png"
    arguments = [str(WATERLOO / "satin"), "-o", str(output), "--target", "numpy32"]
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == 0, result.output
    with Image.open(output) as image:
        assert image.height > 2 * PLAN["body"]["sphere"]["size"] > image.width


def test_what_is_no_material_is_refused(tmp_path: Path) -> None:
    result = CliRunner().invoke(main, [str(tmp_path), "-o", str(tmp_path / "a.png")])
    assert result.exit_code == 2
    assert result.output.startswith("factored: ") and result.output.count("\n") == 1
