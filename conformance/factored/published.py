"""The published materials: where their files may lie, and what satin must reproduce."""

from pathlib import Path

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

WATERLOO = Path(__file__).parents[3] / "shared" / "data" / "waterloo"
SATIN = {0.0: 0.277, 90.0: 0.310}
"""Azimuth of a viewer 40 degrees off the normal -> mean of satin over cosine-weighted light, as published."""
POLAR = 40.0


def cosine_weighted(side: int) -> Array:
    """side^2 directions over the upper hemisphere whose density is their cosine, (n, 3)."""
    x, y = np.meshgrid(*[(np.arange(side) + 0.5) / side] * 2)
    radius, phi = np.sqrt(x.ravel()), 2.0 * np.pi * y.ravel()
    return np.stack([radius * np.cos(phi), radius * np.sin(phi), np.sqrt(1.0 - x.ravel())], axis=-1)


def viewer(azimuth: float) -> Array:
    """The viewer of these figures at an azimuth in degrees, (3,)."""
    a, polar = np.radians(azimuth), np.radians(POLAR)
    return np.array([np.sin(polar) * np.cos(a), np.sin(polar) * np.sin(a), np.cos(polar)])
