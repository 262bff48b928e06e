"""The benchmark of fur compares like with like, and its arithmetic is right; no test asserts a speed.

Plan.
  by hand     every fragment's light and the whole picture are what Vair's draw, within the declared bound
  texts       typed in: no uniform of the material is left; one colour: no light is left
  rounds      works run forwards and backwards, the first ones do not count; ratios are formed pass by pass
  line        slope, intercept and residual of points on a line, and of one off it
  recorded    README.md and the figure say what the recorded files say
"""

import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from codegen.fur.stages import DIALECTS
from codegen.library import load_library
from conformance.bench.fur import page
from conformance.bench.fur.by_hand import FOLDER, by_hand, floor
from conformance.bench.fur.fragments import Fragments, errors, fragments
from conformance.bench.fur.frames import BY_HAND, FAKE_FUR, FIXED, FLOOR, GENERAL, TYPED_IN, frames, studio
from conformance.bench.fur.rounds import in_turns, line, net_of, ratio
from conformance.picture.fur.studio import FurStudio
from conformance.picture.tone import eight_bit
from conformance.unit.support.drivers import need
from conformance.unit.support.tolerances import tolerance

BOUNDS = tomllib.loads((FOLDER / "bounds.toml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def bunny() -> FurStudio:
    made = studio(load_library(), FAKE_FUR, 40, subdivide=0)
    return replace(made, fur=replace(made.fur, layers=6, authored_layers=5.0))


@pytest.fixture(scope="module")
def found(bunny: FurStudio) -> Fragments:
    return fragments(bunny)


@pytest.mark.parametrize("target", DIALECTS)
def test_the_hand_written_stages_draw_the_same_picture(
    target: str, bunny: FurStudio, found: Fragments
) -> None:
    need(target)
    made = frames(bunny, target)
    assert set(made) == {GENERAL, FIXED, BY_HAND, TYPED_IN, FLOOR} and len(found.values) > 200
    pictures = {}
    # Compiling for lavapipe takes long; the texts are made the same way.
    dark = [FLOOR] if target == "glsl" else []
    for name in (GENERAL, BY_HAND, *dark):
        scene = made[name].open(target)
        pictures[name] = scene.draw(made[name].block).astype(np.float64)
        scene.release()
    for name in (BY_HAND, TYPED_IN):
        error = errors(made[name], target, found)
        assert error["missing"] == 0 and error["max"] <= BOUNDS["fragment"], name
    shown, expected = (eight_bit(pictures[name][..., :3]).astype(int) for name in (BY_HAND, GENERAL))
    assert np.abs(shown - expected).mean() <= BOUNDS["picture"]
    # --fixed has the scene's budget for the sum over the lights, in half steps.
    assert 0.0 < errors(made[FIXED], target, found)["max"] <= 1.0
    for name in dark:  # the same hairs in one colour
        assert np.array_equal(pictures[BY_HAND][..., 3], pictures[name][..., 3])
        assert not np.array_equal(pictures[BY_HAND], pictures[name])


@pytest.mark.parametrize("target", DIALECTS)
def test_texts_have_what_they_should(target: str, bunny: FurStudio) -> None:
    general, typed_in, dark = by_hand(target), by_hand(target, bunny.material), floor(target)
    assert sorted(general) == sorted(typed_in) == sorted(dark)
    assert any(re.search(r"\bfur\.shade_", text) for text in general.values())
    assert not any(re.search(r"\bfur\.shade_", text) for text in typed_in.values())
    assert any(re.search(r"\bpow\(.*, 40\.0\)", text) for text in typed_in.values())
    if target == "wgsl":
        assert "fake_fur" not in dark["fur.wgsl"] and dark["fur.wgsl"].count("vec3<f32>(0.5, 0.4, 0.3)") == 3


def test_works_run_forwards_and_backwards() -> None:
    ran: list[str] = []
    ticks = iter(range(1000))
    works = {name: (lambda n=name: ran.append(n)) for name in "abc"}
    times = in_turns(works, 2, lambda: float(next(ticks)))
    assert "".join(ran) == "abc" + "abccba" + "bcaacb"
    assert times == {name: [1.0] * 4 for name in "abc"}


def test_ratios_are_formed_pass_by_pass() -> None:
    # Twice as slow in every pass, while the machine slows down.
    reference = [1.0, 2.0, 4.0, 8.0]
    assert ratio([2.0 * t for t in reference], reference) == ratio([2.0] * 4, [1.0] * 4)
    floor_times = [0.5 * t for t in reference]
    net = net_of([2.0 * t for t in reference], reference, floor_times)
    assert (net.low, net.median, net.high) == (3.0, 3.0, 3.0)


def test_lines_through_points() -> None:
    x = [3.0, 7.0, 15.0, 31.0, 63.0]
    straight = line(x, [20.0 + 1.5 * a for a in x])
    assert straight["slope"] == pytest.approx(1.5) and straight["intercept"] == pytest.approx(20.0)
    assert straight["residual"] < tolerance("summed")
    # One point of three, 3 above the line through the others: its neighbours share a third each.
    bent = line([0.0, 1.0, 2.0], [0.0, 1.0 + 3.0, 2.0])
    assert bent["slope"] == pytest.approx(1.0) and bent["residual"] == pytest.approx(2.0 / 4.0)


def test_the_readme_says_what_is_recorded() -> None:
    text = page.README.read_text(encoding="utf-8")
    for name, section in page.sections().items():
        assert f"{page.BEGIN.format(name)}\n{section}\n{page.END.format(name)}" in text
