"""Solid angles of texels from the numeric Jacobian of any map of the plane onto the sphere."""

from collections.abc import Callable

import numpy as np

from conformance.statistics.evaluator import Array

ToSphere = Callable[[Array], Array]
"""Texture coordinates (N, 2) -> directions (N, 3)."""


def solid_angle_per_area(to_sphere: ToSphere, uv: Array, step: float) -> Array:
    """d omega / (du dv) by central differences: the parallelogram that a small square is mapped to."""
    du, dv = np.array([step, 0.0]), np.array([0.0, step])
    along_u = (to_sphere(uv + du) - to_sphere(uv - du)) / (2.0 * step)
    along_v = (to_sphere(uv + dv) - to_sphere(uv - dv)) / (2.0 * step)
    return np.asarray(np.linalg.norm(np.cross(along_u, along_v), axis=1), dtype=np.float64)


def texel_centres(width: int, height: int) -> Array:
    """Centres of the texels of a map, row by row, (width * height, 2)."""
    u, v = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    return np.stack([u.ravel(), v.ravel()], axis=1)
