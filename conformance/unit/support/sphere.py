"""The brushed sphere that every host program draws, in float64."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image

from conformance.reference.strand import banks_shade

SIDE = 256
Pixels = npt.NDArray[np.int64]


def sphere() -> Pixels:
    """Codes of 8 bits, (SIDE, SIDE, 3), top row first."""
    across = (np.arange(SIDE) + 0.5) * 2.0 / SIDE - 1.0
    x, y = np.meshgrid(across, -across)
    inside = 1.0 - x * x - y * y
    n = np.stack([x, y, np.sqrt(np.maximum(inside, 0.0))], -1).reshape(-1, 3)
    t = np.stack([n[:, 2], np.zeros(len(n)), -n[:, 0]], -1)
    t /= np.maximum(np.linalg.norm(t, axis=1), 1e-6)[:, None]
    ones = np.ones((len(n), 3))
    l = np.array([0.5, 0.6, 0.8]) / np.linalg.norm([0.5, 0.6, 0.8]) * ones
    v = np.array([0.0, 0.0, 1.0]) * ones
    shade = banks_shade(t, n, l, v, np.array([0.5, 0.3, 0.2]) * ones, 0.5 * ones, np.full(len(n), 24.0))
    codes = np.where(inside.reshape(-1, 1) > 0.0, np.sqrt(shade), 0.0) * 255.0
    return np.rint(codes).astype(np.int64).reshape(SIDE, SIDE, 3)


def off(found: Pixels, radius: float) -> int:
    """Largest difference from the sphere up to a share of its radius, in codes."""
    across = (np.arange(SIDE) + 0.5) * 2.0 / SIDE - 1.0
    near = across[:, None] ** 2 + across[None, :] ** 2 <= radius * radius
    return int(np.abs(found - sphere())[near].max())


def pixels(path: Path) -> Pixels:
    """A picture file as codes."""
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB")).astype(np.int64)
