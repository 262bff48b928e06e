"""From linear light to an 8-bit picture: averaging of samples, background, the sRGB curve."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Doubles = npt.NDArray[np.float64]

STEPS = 255.0


def srgb_encode(linear: npt.ArrayLike) -> Doubles:
    """IEC 61966-2-1: linear light, clipped to [0, 1], to the encoded value in [0, 1]."""
    x = np.clip(np.asarray(linear, dtype=np.float64), 0.0, 1.0)
    encoded: Doubles = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1.0 / 2.4) - 0.055)
    return encoded


def srgb_decode(encoded: npt.ArrayLike) -> Doubles:
    """Inverse of srgb_encode on [0, 1]."""
    x = np.asarray(encoded, dtype=np.float64)
    linear: Doubles = np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)
    return linear


def gradient(size: tuple[int, int], top: npt.ArrayLike, bottom: npt.ArrayLike) -> Doubles:
    """Background (height, width, 3) in linear light between two sRGB colours, even to the eye."""
    width, height = size
    share = np.linspace(0.0, 1.0, height)[:, None]
    column = (1.0 - share) * np.asarray(top, dtype=np.float64) + share * np.asarray(bottom, dtype=np.float64)
    return np.broadcast_to(srgb_decode(column)[:, None, :], (height, width, 3)).copy()


def resolve(mask: npt.NDArray[np.bool_], shaded: Doubles, background: Doubles) -> Doubles:
    """Average samples into pixels, over the background.

    mask        (height * s, width * s), True where a sample is covered
    shaded      (N, 3) linear light of the covered samples, in the mask's order
    background  (height, width, 3) linear light
    returns     (height, width, 3) linear light
    """
    height, width, _ = background.shape
    side = mask.shape[0] // height
    samples = np.zeros((*mask.shape, 3))
    samples[mask] = shaded
    light: Doubles = samples.reshape(height, side, width, side, 3).mean(axis=(1, 3))
    coverage = mask.reshape(height, side, width, side).mean(axis=(1, 3))
    picture: Doubles = light + (1.0 - coverage)[..., None] * background
    return picture


def eight_bit(linear: Doubles) -> npt.NDArray[np.uint8]:
    """The picture (height, width, 3) as it is stored."""
    return np.round(STEPS * srgb_encode(linear)).astype(np.uint8)


def steps_apart(linear: Doubles, reference: Doubles) -> Doubles:
    """Differences (height, width, 3) in 8-bit steps between two pictures, before they are rounded.

    After rounding, a difference of a millionth could show as a whole step, and one of almost a step
    as none.
    """
    return STEPS * np.abs(srgb_encode(linear) - srgb_encode(reference))
