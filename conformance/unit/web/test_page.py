"""The page of `vair demo web` in a real browser: it draws what Python draws, and does what it is told.

Plan. Chromium without a window loads the page of a furry ball: WebGL2 on Mesa, WebGPU on SwiftShader. Pixels
are read from the canvas.
  picture   that of the Python render: on Mesa the same, on SwiftShader within what rasterisers differ
  keys      an arrow turns the ball to the picture that Python takes from there; Home brings it back
  drag      mouse and fingers turn it too, wheel and two fingers bring it closer
  controls  a slider, moved by keys, changes picture and address; the button brings the scene back; an address
            with choices brings the choices back
  switches  backend and formulas, by keys; error and time, driver, domain and method are named
  compare   the button says how the pictures differ and what a frame costs, and where
  narrow    nothing is wider than a phone's screen; every control has a label
After every test the browser's console is empty. Without a browser the tests are skipped and say so.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from conformance.picture.fur.studio import FurStudio
from conformance.picture.scene import Light
from conformance.picture.tolerances import tolerance
from conformance.unit.web.opened import Opened
from conformance.unit.web.pictures import (
    assert_changed,
    assert_same,
    python_picture,
    share_alike,
)
from conformance.web.browser import view


class Keys:
    """What WebDriver calls them; selenium itself need not be here to collect the tests."""

    HOME = "\ue011"
    ARROW_LEFT = "\ue012"
    ARROW_UP = "\ue013"
    ARROW_RIGHT = "\ue014"


ARROW = math.pi / 24.0
"""Radians by which an arrow key turns."""


def turned(studio: FurStudio, yaw: float) -> FurStudio:
    """The scene with its body turned about the upright axis; seen from the body, all else turns back."""
    c, s = math.cos(yaw), math.sin(yaw)

    def back(v: tuple[float, float, float]) -> tuple[float, float, float]:
        return c * v[0] - s * v[2], v[1], s * v[0] + c * v[2]

    camera = studio.picture.camera
    assert camera.target == (0.0, 0.0, 0.0)
    assert camera.up == (0.0, 1.0, 0.0)
    lights = tuple(Light(back(light.direction), light.colour) for light in studio.picture.lights)
    picture = replace(studio.picture, camera=replace(camera, eye=back(camera.eye)), lights=lights)
    return replace(studio, picture=picture)


def test_webgl2_draws_the_picture_of_python(page: Opened, studio: FurStudio) -> None:
    page.load(backend="webgl2")
    page.settle()
    assert_same(page.pixels(), python_picture(studio))


def test_webgpu_chosen_by_a_key_draws_nearly_the_picture_of_python(page: Opened, studio: FurStudio) -> None:
    frames = page.steady()
    page.element('input[name="backend"][value="webgl2"]').send_keys(Keys.ARROW_UP)
    page.waited("#status", "WebGPU on")
    page.settle(frames)
    assert page.text("#message") == ""
    assert "backend=webgpu" in page.run("return location.hash")
    assert "on lavapipe, error at most" in page.text("#recorded")
    found, expected = page.pixels(), python_picture(studio)
    assert np.abs(found - expected).mean() < tolerance("web_rasteriser_steps")
    assert share_alike(found, expected) >= tolerance("web_rasteriser_share")


def test_arrow_keys_turn_the_body_under_its_lights(page: Opened, studio: FurStudio) -> None:
    frames = page.steady()
    before = page.pixels()
    stage = page.element("#stage")
    for _ in range(3):
        stage.send_keys(Keys.ARROW_RIGHT)
    frames = page.settle(frames)
    assert_changed(page.pixels(), before)
    assert_same(page.pixels(), python_picture(turned(studio, 3.0 * ARROW)))
    stage.send_keys(Keys.HOME)
    page.settle(frames)
    assert_same(page.pixels(), before)


@pytest.mark.nightly
def test_the_mouse_turns_and_the_wheel_comes_closer(page: Opened) -> None:
    webdriver = pytest.importorskip("selenium.webdriver")
    frames = page.steady()
    before = page.pixels()
    stage = page.element("#stage")
    webdriver.ActionChains(page.driver, duration=20).drag_and_drop_by_offset(stage, 80, 30).perform()
    page.settle(frames)
    pose = page.run("return page.turning.pose")
    assert pose["yaw"] > 0.0
    assert pose["pitch"] > 0.0
    assert_changed(page.pixels(), before)
    page.run("document.getElementById('stage').dispatchEvent(new WheelEvent('wheel', { deltaY: -100 }))")
    assert page.run("return page.turning.pose.distance") < 1.0


@pytest.mark.nightly
def test_fingers_turn_and_come_closer(page: Opened) -> None:
    page.steady()
    box = page.run("return document.getElementById('stage').getBoundingClientRect().toJSON()")
    x, y = box["x"] + 100.0, box["y"] + 100.0

    def touch(kind: str, *points: tuple[float, float]) -> None:
        fingers = [{"x": x + dx, "y": y + dy, "id": k} for k, (dx, dy) in enumerate(points)]
        page.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": fingers})

    touch("touchStart", (0.0, 0.0))
    touch("touchMove", (60.0, 20.0))
    touch("touchEnd")
    pose = page.run("return page.turning.pose")
    assert pose["yaw"] > 0.0
    assert pose["pitch"] > 0.0
    touch("touchStart", (0.0, 0.0), (40.0, 0.0))
    touch("touchMove", (0.0, 0.0), (80.0, 0.0))
    touch("touchEnd")
    after = page.run("return page.turning.pose")
    assert after["distance"] < 0.9
    assert after["yaw"] == pose["yaw"], "two fingers do not turn"


def test_a_slider_changes_the_picture_and_the_address(page: Opened) -> None:
    frames = page.steady()
    before = page.pixels()
    page.element("#parameter-coat_length").send_keys(Keys.HOME)  # the least length
    frames = page.settle(frames)
    assert_changed(page.pixels(), before)
    assert "coat_length=0.05" in page.run("return location.hash")
    page.element("#reset").click()
    page.settle(frames)
    assert_same(page.pixels(), before)
    assert "coat_length" not in page.run("return location.hash")


@pytest.mark.nightly
def test_an_address_brings_its_choices_back(page: Opened) -> None:
    frames = page.steady()
    page.element("#parameter-coat_length").send_keys(Keys.HOME)
    page.element("#stage").send_keys(Keys.ARROW_LEFT)
    page.settle(frames)
    chosen, address = page.pixels(), page.run("return location.href")
    page.driver.get("about:blank")
    page.driver.get(address)
    page.settle()
    assert_same(page.pixels(), chosen)


def test_formulas_chosen_by_a_key_name_their_error_and_time(page: Opened) -> None:
    frames = page.steady()
    right = page.pixels()
    assert "an evaluation on llvmpipe, error at most" in page.text("#recorded")
    page.element('input[name="formulas"][value="right"]').send_keys(Keys.ARROW_RIGHT)
    page.settle(frames)
    assert "shading=fakefur_shade_printed" in page.run("return location.hash")
    assert_changed(page.pixels(), right)
    headline, facts = page.text("#recorded"), page.text("#facts")
    assert "\u00d7 the time of fakefur_shade on llvmpipe, error at most" in headline
    assert "against the right formulas" in headline
    for word in ("Error", "Domain", "exponent", "Time", "quartiles", "Driver", "Mesa", "Method", "thread"):
        assert word in facts


@pytest.mark.nightly
def test_comparing_here_says_error_and_time_and_where(page: Opened) -> None:
    page.load(backend="webgl2", shading="fakefur_shade_printed", pixels="16", layers="2")
    page.settle()
    page.element("#compare").click()
    said = page.waited("#compared", "Pictures differ by")
    for words in (
        "8-bit steps on average",
        "\u00d7 that of fakefur_shade (quartiles",
        "WebGL2 on",
        "rounds of A B B A",
    ):
        assert words in said


@pytest.mark.parametrize(
    "dark", [False, pytest.param(True, marks=pytest.mark.nightly)], ids=["light", "dark"]
)
def test_a_phone_shows_all_of_it(page: Opened, dark: bool) -> None:
    page.steady()
    view(page.driver, 390, 844, dark=dark)
    assert page.run("return document.documentElement.scrollWidth") <= 390
    unnamed = page.run(
        "return [...document.querySelectorAll('input, select, button')].filter((e) =>"
        " !(e.labels?.length || e.textContent.trim())).map((e) => e.outerHTML)"
    )
    assert unnamed == []
    ground = page.run("return getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)")
    assert (max(ground) < 128) == dark
