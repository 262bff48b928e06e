"""Every variant on the page, with either backend, draws the picture that Python draws on the same driver.

Plan. The page of a furry ball with all variants in Chromium without a window.
  WebGL2   Python draws with OpenGL on Mesa
  WebGPU   Python draws in a process of its own, on the SwiftShader that comes with Chromium
  keys     choose among them
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from codegen.files import write_folder
from codegen.library import load_library
from conformance.picture.fur.studio import FurStudio
from conformance.unit.web.opened import Opened
from conformance.unit.web.pictures import assert_same, python_picture
from conformance.web.browser import served, view
from conformance.web.build import page_files, shaded_by
from conformance.web.choices import choices
from targets import TargetUnavailable
from targets.drivers import driver, environment_of

NAMES = [shading.name for shading in choices().shadings]
RENDER = """
import sys
from pathlib import Path
import numpy as np
from codegen.library import load_library
from conformance.picture.fur.studio import set_up_fur
from conformance.unit.web.pictures import python_picture
from conformance.web.build import shaded_by
studio = set_up_fur(load_library(), Path(sys.argv[1]))
for name in sys.argv[3:]:
    np.save(Path(sys.argv[2]) / f"{name}.npy", python_picture(shaded_by(studio, name), "wgsl"))
"""
pytestmark = pytest.mark.nightly


@pytest.fixture(scope="module")
def whole(session: Opened, ball: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Opened]:
    """The page with all variants."""
    files = page_files(load_library(), ball)
    folder = tmp_path_factory.mktemp("whole") / "page"
    write_folder(folder, files)
    with served(folder, files) as url:
        view(session.driver, 1280, 900)
        session.console()
        yield Opened(session.driver, url, folder)


@pytest.fixture(scope="module")
def swiftshader(ball: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with Python's pictures on SwiftShader, as arrays by name."""
    folder = tmp_path_factory.mktemp("swiftshader")
    try:
        environment = environment_of(driver("swiftshader"))
    except TargetUnavailable as missing:
        pytest.skip(str(missing))
    command = [sys.executable, "-c", RENDER, str(ball), str(folder), *NAMES]
    subprocess.run(command, env=environment, check=True, timeout=300)
    return folder


@pytest.mark.parametrize("name", NAMES)
def test_webgl2_draws_the_picture_of_python(whole: Opened, studio: FurStudio, name: str) -> None:
    whole.load(backend="webgl2", shading=name)
    whole.settle()
    assert_same(whole.pixels(), python_picture(shaded_by(studio, name)))
    assert whole.console() == []


@pytest.mark.parametrize("name", NAMES)
def test_webgpu_draws_the_picture_of_python(whole: Opened, swiftshader: Path, name: str) -> None:
    whole.load(backend="webgpu", shading=name)
    whole.settle()
    assert_same(whole.pixels(), np.load(swiftshader / f"{name}.npy"))
    assert whole.console() == []


def test_variants_are_chosen_by_keys(whole: Opened) -> None:
    whole.load(backend="webgl2")
    frames = whole.settle()
    whole.element("#variant").send_keys("cheap")
    assert "squarings" in whole.waited("#note", "Rational")
    whole.settle(frames)
    assert "shading=fakefur_shade_rational_sq16" in whole.run("return location.hash")
    assert whole.text("#recorded").startswith("0.")
    assert whole.console() == []
