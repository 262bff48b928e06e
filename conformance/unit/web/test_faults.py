"""The page where something is wrong: it says so in one sentence, and goes on where that is possible.

Plan. The page of a furry ball in Chromium without a window.
  lost      a context or a device that is taken away is set up again; one that is taken away again and again
            leaves the picture to the other backend
  address   nonsense in it is left out
  without   no WebGPU, no device for it, no WebGL2, neither
  bad data  web.json, fur.json, buffers and stages that are missing, cut off or wrong
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from conformance.unit.web.opened import Opened
from conformance.unit.web.pictures import assert_same

NO_WEBGPU = "Object.defineProperty(Navigator.prototype, 'gpu', { value: undefined });"
NO_DEVICE = "globalThis.GPU && (GPU.prototype.requestAdapter = async () => null);"
NO_WEBGL2 = """
const given = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
  return kind === 'webgl2' ? null : given.call(this, kind, ...rest);
};
"""
LOSE = {
    "webgl2": "page.renderer.gl.getExtension('WEBGL_lose_context').loseContext()",
    "webgpu": "page.renderer.gpu.destroy()",
}
KIT = "shadings/fakefur_shade"
NONSENSE = {
    "backend": "direct3d",
    "shading": "fakefur",
    "skin": "0.5",
    "layers": "many",
    "coat_length": "",
    "yaw": "left",
    "side": "99",
    "no": "such",
}


@pytest.mark.parametrize("backend", ["webgl2", pytest.param("webgpu", marks=pytest.mark.nightly)])
def test_a_lost_context_is_set_up_again(loud_page: Opened, backend: str) -> None:
    page = loud_page
    frames = page.steady()
    if backend == "webgpu":
        page.load(backend=backend)
        frames = page.settle()
    before = page.pixels()
    page.run(LOSE[backend])
    assert "is being set up again" in page.waited("#message", "took")
    page.settle(frames)
    assert page.text("#message") == ""
    assert_same(page.pixels(), before)


@pytest.mark.nightly
def test_nonsense_in_the_address_is_left_out(page: Opened) -> None:
    page.load(**NONSENSE)
    page.settle()
    assert page.text("#message") == ""
    assert page.run("return page.controls.differing()") == []
    assert page.run("return page.turning.pose") == {"yaw": 0, "pitch": 0, "distance": 1}
    assert "WebGPU on" in page.text("#status")


def test_a_reader_is_told_when_nothing_helps(page: Opened) -> None:
    page.steady()
    told = page.run(
        "const losses = new page.losses.constructor(); const times = [0, 1, 2, 3, 4, 5, 6, 40000];"
        "const lost = ['webgl2', 'webgl2', 'webgl2', 'webgpu', 'webgpu', 'webgpu', 'webgl2', 'webgpu'];"
        "return times.map((when, k) => losses.count(lost[k], when))"
    )
    assert [each["next"] for each in told] == [
        *("webgl2", "webgl2", "webgpu"),
        *("webgpu", "webgpu", None),
        None,
        "webgpu",
    ], "two more tries each, and what is long ago counts no more"
    assert told[5]["sentence"] == (
        "The graphics driver keeps taking the picture away; reload the page to try again."
    )


@pytest.mark.nightly
def test_a_context_lost_again_and_again_leaves_it_to_the_other_backend(loud_page: Opened) -> None:
    page = loud_page
    page.load(backend="webgpu")
    frames = page.settle()
    for said in ("took", "took", "keeps taking"):
        page.run(LOSE["webgpu"])
        page.waited("#message", said)
        frames = page.settle(frames)
    sentence = "The graphics driver keeps taking the context of WebGPU away; WebGL2 draws instead."
    assert page.text("#message") == sentence
    assert "WebGL2 on" in page.text("#status")


@pytest.mark.parametrize(
    ("script", "asked", "sentence", "draws"),
    [
        (NO_WEBGPU, "webgpu", "This browser offers no WebGPU; WebGL2 draws instead.", "WebGL2"),
        pytest.param(
            NO_DEVICE,
            "webgpu",
            "This browser has WebGPU, but no graphics device for it; WebGL2 draws instead.",
            "WebGL2",
            marks=pytest.mark.nightly,
        ),
        pytest.param(
            NO_WEBGL2,
            "webgl2",
            "This browser offers no WebGL2; WebGPU draws instead.",
            "WebGPU",
            marks=pytest.mark.nightly,
        ),
    ],
    ids=["no-webgpu", "no-device", "no-webgl2"],
)
def test_the_other_backend_draws(page: Opened, script: str, asked: str, sentence: str, draws: str) -> None:
    page.load(script, backend=asked)
    page.settle()
    assert page.text("#message") == sentence
    assert page.text("#status").startswith(f"{draws} on")
    assert not page.element(f'input[name="backend"][value="{asked}"]').is_enabled()


def test_neither_backend_is_one_sentence(page: Opened) -> None:
    page.load(NO_WEBGPU, NO_WEBGL2)
    said = page.waited("#message")
    assert said == "This browser offers neither WebGPU nor WebGL2, one of which the picture needs."


def change(name: str, edit: Callable[[Any], None]) -> tuple[str, Callable[[bytes], bytes]]:
    """A fault: that JSON file with something edited."""

    def faulty(data: bytes) -> bytes:
        content = json.loads(data)
        edit(content)
        return json.dumps(content).encode()

    return name, faulty


FAULTS: dict[str, tuple[tuple[str, Callable[[bytes], bytes] | None], str]] = {
    "plan-gone": (("web.json", None), "web.json cannot be read: the server answers 404."),
    "plan-format": (
        change("web.json", lambda c: c.update(format=99)),
        "web.json is not of format 1; generate the page anew with “vair demo web”.",
    ),
    "kit-not-json": (
        (f"{KIT}/fur.json", lambda data: data[:-9]),
        f"{KIT}/fur.json is not JSON; generate the page anew with “vair demo web”.",
    ),
    "kit-format": (
        change(f"{KIT}/fur.json", lambda c: c.update(format=2)),
        f"{KIT}/fur.json is not a kit of format 1; generate the page anew with “vair demo web”.",
    ),
    "kit-without-passes": (
        change(f"{KIT}/fur.json", lambda c: c.pop("passes")),
        f"{KIT}/fur.json has no “passes”; generate the page anew with “vair demo web”.",
    ),
    "buffer-unknown": (
        change(f"{KIT}/fur.json", lambda c: c["passes"][0].update(vertices="corners")),
        f"{KIT}/fur.json: pass base draws a buffer “corners” that is not there.",
    ),
    "value-missing": (
        change(f"{KIT}/fur.json", lambda c: c["uniforms"]["members"][1].pop("value")),
        f"{KIT}/fur.json: the uniform eye has no finite value.",
    ),
    "mesh-cut-off": (
        ("fur.bin", lambda data: data[:1000]),
        f"{KIT}/fur.json: vertices reaches beyond the end of ../../fur.bin.",
    ),
    "stage-gone": (
        (f"{KIT}/shell-es300.frag", None),
        f"{KIT}/shell-es300.frag cannot be read: the server answers 404.",
    ),
    "stage-wrong": (
        (f"{KIT}/shell-es300.frag", lambda data: data.replace(b"void main()", b"void mian()")),
        "WebGL2 does not accept the shaders of fakefur_shade, pass shell: ",
    ),
}


DAILY = ("stage-wrong",)


@pytest.mark.parametrize(
    "fault", [key if key in DAILY else pytest.param(key, marks=pytest.mark.nightly) for key in FAULTS]
)
def test_bad_data_is_one_sentence(loud_page: Opened, fault: str) -> None:
    (name, faulty), sentence = FAULTS[fault]
    path: Path = loud_page.folder / name
    good = path.read_bytes()
    path.unlink()
    try:
        if faulty is not None:
            path.write_bytes(faulty(good))
        loud_page.load(backend="webgl2")
        said = loud_page.waited("#message")
    finally:
        path.write_bytes(good)
    assert said.startswith(sentence)
    assert said.count("\n") == 0
    # The browser reports a file that is not there; the page itself says nothing to the console.
    assert [line for line in loud_page.console() if "404" not in line] == []


@pytest.mark.nightly
def test_shaders_that_webgpu_refuses_are_one_sentence(loud_page: Opened) -> None:
    path = loud_page.folder / KIT / "fur.wgsl"
    good = path.read_bytes()
    path.write_bytes(good.replace(b"fn shell_fragment", b"fn shell_fragmnet"))
    try:
        loud_page.load(backend="webgpu")
        said = loud_page.waited("#message")
    finally:
        path.write_bytes(good)
    assert said.startswith("WebGPU does not accept the stages of fakefur_shade, pass shell: ")
    assert loud_page.console() == []
