"""Radiance from a file: finite and not negative, or refused with the first pixel that is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError
from codegen.maps.image import Pixels, read_pixels

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""Share of linear red, green and blue (ITU-R BT.709) in luminance."""


def read_radiance(path: Path, *, clean: bool = False) -> Pixels:
    """A latitude-longitude map of radiance as (height, width, 3) float32 >= 0, row 0 at the top.

    clean   mend what is no radiance instead of refusing it: NaN and negative values become 0, infinite
            ones the largest finite value of the map

    raises  UserError for an unreadable file, or for values that are NaN, infinite or negative: how many
            pixels, and where the first one is
    """
    pixels = read_pixels(path, linear=True)
    wrong = ~np.isfinite(pixels) | (pixels < 0.0)
    if not wrong.any():
        return pixels
    if clean:
        return cleaned(pixels)
    raise UserError(f'{path.name}: {first_wrong(pixels, wrong)}; "clean" mends them')


def first_wrong(pixels: Pixels, wrong: npt.NDArray[np.bool_]) -> str:
    """How many pixels have a wrong value, and the first of these values with its place."""
    places = wrong.any(axis=2)
    row, column = (int(k) for k in np.argwhere(places)[0])
    channel = int(np.flatnonzero(wrong[row, column])[0])
    count = int(places.sum())
    return (
        f"{count} pixel{'s are' if count > 1 else ' is'} no radiance, first row {row}, column {column}: "
        f"{'RGB'[channel]} = {pixels[row, column, channel]:g}"
    )


def cleaned(pixels: Pixels) -> Pixels:
    """The map with NaN and negative values set to 0 and infinite ones to its largest finite value."""
    finite = pixels[np.isfinite(pixels)]
    largest = max(float(finite.max()), 0.0) if finite.size else 0.0
    return np.clip(np.nan_to_num(pixels, nan=0.0, posinf=largest, neginf=0.0), 0.0, None).astype(np.float32)
