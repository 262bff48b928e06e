"""The sRGB curve, averaging of samples, and differences in 8-bit steps."""

from __future__ import annotations

import numpy as np
import pytest

from conformance.picture.tolerances import tolerance
from conformance.picture.tone import eight_bit, gradient, resolve, srgb_decode, srgb_encode, steps_apart


def test_known_values_of_srgb() -> None:
    """Mid-grey and the corners, from IEC 61966-2-1."""
    codes = np.round(255.0 * srgb_encode([0.0, 0.5, 1.0, 0.18, 0.002]))
    assert codes.tolist() == [0.0, 188.0, 255.0, 118.0, 7.0]


def test_srgb_clips() -> None:
    assert srgb_encode([-1.0, 2.0]) == pytest.approx([0.0, 1.0])


def test_srgb_round_trip() -> None:
    x = np.linspace(0.0, 1.0, 100001)
    assert np.abs(srgb_decode(srgb_encode(x)) - x).max() < tolerance("srgb_round_trip")


def test_all_codes_survive() -> None:
    codes = np.arange(256)
    grey = np.repeat(srgb_decode(codes / 255.0)[None, :, None], 3, axis=2)
    assert eight_bit(grey)[0, :, 0].tolist() == codes.tolist()


def test_samples_are_averaged_over_the_background() -> None:
    mask = np.zeros((2, 4), dtype=bool)
    mask[0, 0] = mask[1, 1] = mask[0, 2] = True
    shaded = np.array([[1.0, 0.0, 0.0], [0.0, 4.0, 0.0], [8.0, 0.0, 0.0]])  # in the order of the mask's rows
    pixels = resolve(mask, shaded, np.ones((1, 2, 3)))
    np.testing.assert_array_equal(pixels, [[[2.75, 0.5, 0.5], [0.75, 1.75, 0.75]]])


def test_the_background_runs_from_top_to_bottom() -> None:
    ground = gradient((3, 5), (1.0, 1.0, 1.0), (0.0, 0.0, 0.0))
    assert ground.shape == (5, 3, 3)
    assert srgb_encode(ground[:, 1, 2]) == pytest.approx([1.0, 0.75, 0.5, 0.25, 0.0])


def test_differences_are_taken_before_rounding() -> None:
    """Two values on either side of a rounding threshold are not a whole step apart."""
    threshold = srgb_decode(np.full((1, 1, 3), 100.5 / 255.0))
    below, above = threshold * (1.0 - 1e-6), threshold * (1.0 + 1e-6)
    assert (eight_bit(above) - eight_bit(below)).tolist() == [[[1, 1, 1]]]
    assert steps_apart(above, below).max() < tolerance("neighbours")


def test_a_difference_below_the_rounding_shows() -> None:
    dark = np.zeros((1, 1, 3))
    assert steps_apart(dark + 1e-4, dark) == pytest.approx(np.full((1, 1, 3), 255.0 * 12.92 * 1e-4))
