"""Pictures of the page beside those of the Python render."""

from __future__ import annotations

import numpy as np

from conformance.picture.fur.draw import draw_fur
from conformance.picture.fur.studio import FurStudio
from conformance.picture.rasterise import develop
from conformance.picture.tolerances import tolerance
from conformance.picture.tone import eight_bit
from conformance.unit.support.drivers import need
from conformance.unit.web.opened import Pixels


def python_picture(studio: FurStudio, target: str = "glsl") -> Pixels:
    """The scene as Python draws it; skips the test where there is no driver."""
    need(target)
    samples, _ = draw_fur(studio, target)
    return eight_bit(develop(studio.picture, samples)).astype(np.int64)


def share_alike(a: Pixels, b: Pixels) -> float:
    """Share of the pixels that count as the same."""
    return float((np.abs(a - b).max(axis=2) < tolerance("fur_pixel_steps")).mean())


def assert_same(a: Pixels, b: Pixels) -> None:
    """Pictures of drivers that agree where samples lie."""
    assert b.std() > 10.0, "there is something to see"
    assert np.abs(a - b).mean() < tolerance("fur_mean_steps")
    assert share_alike(a, b) >= tolerance("fur_pixel_share")


def assert_changed(a: Pixels, b: Pixels) -> None:
    """Pictures that differ to the eye."""
    assert np.abs(a - b).mean() > tolerance("web_changed_steps")
