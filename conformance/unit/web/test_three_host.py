"""The three.js host in Chromium without a window: the ES 3.00 library in a ShaderMaterial draws the sphere.

`./dev test` fetches three.js where npm is; so does `npm ci` in examples/hosts/three. The test skips without.
"""

import base64
import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from selenium.webdriver.support.ui import WebDriverWait

from conformance.picture.tolerances import tolerance
from conformance.unit.support.sphere import off
from conformance.unit.web.opened import PATIENCE
from conformance.web.browser import missing, open_browser, served

ROOT = Path(__file__).parents[3]
HOST = "examples/hosts/three"
BUILT = f"{HOST}/node_modules/three/build"
FILES = [f"{HOST}/{name}" for name in ("index.html", "sphere.js", "sphere.vert", "sphere.frag")]
RADIUS = 0.98
"""Triangles end inside the sphere's outline."""


def test_a_material_of_three_js_draws_the_sphere() -> None:
    if not (ROOT / BUILT).is_dir():
        pytest.skip(f"three.js is not here: npm ci --prefix {HOST}")
    reason = missing()
    if reason:
        pytest.skip(reason)
    library = "targets/glsl/include/vair-es300.glsl"
    names = [*FILES, library, *(f"{BUILT}/{name}" for name in ("three.module.js", "three.core.js"))]
    with served(ROOT, names) as url, open_browser() as driver:
        driver.get(f"{url}{HOST}/index.html")
        script = "return document.documentElement.dataset.drawn === 'yes'"
        WebDriverWait(driver, PATIENCE, poll_frequency=0.05).until(lambda found: found.execute_script(script))
        said = driver.get_log("browser")
        url_of_picture = driver.execute_script("return document.querySelector('canvas').toDataURL()")
    assert said == []
    with Image.open(io.BytesIO(base64.b64decode(url_of_picture.partition(",")[2]))) as image:
        found = np.asarray(image.convert("RGB")).astype(np.int64)
    assert off(found, RADIUS) <= tolerance("host_mesh_steps")
