"""Charts of the sphere: smooth maps of the unit square onto all directions, fine where a lobe is narrow.

A chart turns an integral over the sphere into one over the square, and directions into cells of the square.
Every chart gives the direction of a point, its area factor d omega / d area, and the inverse.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from conformance.statistics.evaluator import Array

FULL_TURN = 2.0 * np.pi
NEAR = 0.75
"""Share of a chart's first axis for the hemisphere around the peak."""
KNOTS = np.array([0.0, 0.1, 0.9, 1.0])
"""Where a chart's middle piece begins and ends: on the borders of 20 or 40 cells."""


@dataclass(frozen=True)
class Chart:
    """A chart of the sphere.

    direction  points (N, 2) of the unit square -> directions (N, 3) and area factors (N,)
    square     directions (N, 3) -> points (N, 2) of the unit square
    """

    direction: Callable[[Array], tuple[Array, Array]]
    square: Callable[[Array], Array]


def axis_chart(axis: Array, sharpness: float) -> Chart:
    """Polar coordinates about an axis; 1 - cos is spread logarithmically from 1 / (sharpness + 1).

    The hemisphere around the axis takes the first 3/4 of the square, so that a lobe may end at its rim.
    """
    axis = axis / np.linalg.norm(axis)
    first = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    first /= np.linalg.norm(first)
    second = np.cross(axis, first)
    core = 1.0 / (sharpness + 1.0)
    span = np.log1p(1.0 / core) / NEAR

    def direction(a: Array) -> tuple[Array, Array]:
        near = a[:, 0] < NEAR
        spread = core * np.expm1(np.minimum(a[:, 0], NEAR) * span)
        q = np.where(near, spread, 1.0 + (a[:, 0] - NEAR) / (1.0 - NEAR))
        s, phi = np.sqrt(np.clip(q * (2.0 - q), 0.0, None)), FULL_TURN * a[:, 1]
        l = (
            (1.0 - q)[:, None] * axis
            + (s * np.cos(phi))[:, None] * first
            + (s * np.sin(phi))[:, None] * second
        )
        return l, np.where(near, (spread + core) * span, 1.0 / (1.0 - NEAR)) * FULL_TURN

    def square(l: Array) -> Array:
        q = np.sum((l - axis) ** 2, axis=1) / 2.0
        radial = np.where(q < 1.0, np.log1p(q / core) / span, NEAR + (q - 1.0) * (1.0 - NEAR))
        return np.stack([radial, np.arctan2(l @ second, l @ first) / FULL_TURN % 1.0], axis=1)

    return Chart(direction, square)


def half_vector_chart(v: Array, width_x: float, width_y: float) -> Chart:
    """Directions mirrored about upper half vectors, which are a uniform hemisphere stretched by the widths.

    Of h and -h, which mirror alike, the upper one stands for both, so every direction is reached once. The
    area factor contains 4 |v.h|, which cancels the pole of half-vector densities at l = -v.
    """
    stretch = np.array([width_x, width_y, 1.0])

    def direction(a: Array) -> tuple[Array, Array]:
        z, phi = 1.0 - a[:, 0], FULL_TURN * a[:, 1]
        s = np.sqrt(1.0 - z * z)
        g = np.stack([s * np.cos(phi), s * np.sin(phi), z], axis=1) * stretch
        norm = np.linalg.norm(g, axis=1)
        h = g / norm[:, None]
        vh = h @ v
        return 2.0 * vh[:, None] * h - v, width_x * width_y / norm**3 * 4.0 * np.abs(vh) * FULL_TURN

    def square(l: Array) -> Array:
        h = l + v
        h = np.where(h[:, 2:] < 0.0, -h, h) / stretch
        h /= np.maximum(np.linalg.norm(h, axis=1), 1e-300)[:, None]
        return np.stack([1.0 - h[:, 2], np.arctan2(h[:, 1], h[:, 0]) / FULL_TURN % 1.0], axis=1)

    return Chart(direction, square)


def fibre_chart(v: Array, sharpness: float) -> Chart:
    """Elevation and azimuth about x; elevations crowd around the mirror cone of v, at a = 1/2.

    Elevations within a right angle of the cone take the middle 4/5 of the first axis; the lobe ends there.
    """
    quarter = np.pi / 2.0
    centre, width = -np.arcsin(np.clip(v[0], -1.0, 1.0)), 1.0 / np.sqrt(sharpness + 1.0)
    low, high = max(centre - quarter, -quarter), min(centre + quarter, quarter)
    reach = {side: np.arcsinh((end - centre) / width) for side, end in ((-1, low), (1, high))}
    outer = np.array([(low + quarter) / KNOTS[1], 0.0, (quarter - high) / (1.0 - KNOTS[2])])

    def direction(a: Array) -> tuple[Array, Array]:
        x, phi = a[:, 0], FULL_TURN * a[:, 1]
        piece = np.searchsorted(KNOTS[1:3], x)
        side = np.where(x < 0.5, -reach[-1], reach[1])
        s = (x - 0.5) / (KNOTS[2] - 0.5) * side
        inner = centre + width * np.sinh(s)
        ends = np.where(piece == 0, -quarter + x * outer[0], quarter - (1.0 - x) * outer[2])
        theta = np.where(piece == 1, inner, ends)
        slope = np.where(piece == 1, width * np.cosh(s) * side / (KNOTS[2] - 0.5), outer[piece])
        c = np.maximum(np.cos(theta), 0.0)
        l = np.stack([np.sin(theta), c * np.cos(phi), c * np.sin(phi)], axis=1)
        return l, c * slope * FULL_TURN

    def square(l: Array) -> Array:
        theta = np.arctan2(l[:, 0], np.hypot(l[:, 1], l[:, 2]))
        s = np.arcsinh((theta - centre) / width)
        side = np.maximum(np.where(s < 0.0, -reach[-1], reach[1]), 1e-300)
        x = 0.5 + np.clip(s / side, -1.0, 1.0) * (KNOTS[2] - 0.5)
        x = np.where(theta < low, (theta + quarter) / max(outer[0], 1e-300), x)
        x = np.where(theta > high, 1.0 - (quarter - theta) / max(outer[2], 1e-300), x)
        return np.stack([x, np.arctan2(l[:, 2], l[:, 1]) / FULL_TURN % 1.0], axis=1)

    return Chart(direction, square)


def arc_chart(v: Array, spread: float, sharpness: float) -> Chart:
    """Directions mirrored about facets of cylinders along x; the middle 4/5 of the second axis is the arc.

    First axis: elevation of the upper half vector along x, crowded around 0; second: its angle across the
    cylinder, with the ends of the arc at 1/10 and 9/10.
    """
    width = 1.0 / np.sqrt(sharpness + 1.0)
    end = np.arcsinh(np.pi / 2.0 / width)
    spread = min(spread, np.pi / 2.0 * (1.0 - 1e-9))
    angles = [-np.pi / 2.0, -spread, spread, np.pi / 2.0]
    slopes = np.diff(angles) / np.diff(KNOTS)

    def direction(a: Array) -> tuple[Array, Array]:
        s = (2.0 * a[:, 0] - 1.0) * end
        eta, xi = width * np.sinh(s), np.interp(a[:, 1], KNOTS, angles)
        c = np.maximum(np.cos(eta), 0.0)
        h = np.stack([np.sin(eta), c * np.sin(xi), c * np.cos(xi)], axis=1)
        vh = h @ v
        slope = slopes[np.searchsorted(KNOTS[1:3], a[:, 1])]
        return 2.0 * vh[:, None] * h - v, 4.0 * np.abs(vh) * c * width * np.cosh(s) * 2.0 * end * slope

    def square(l: Array) -> Array:
        h = l + v
        h = np.where(h[:, 2:] < 0.0, -h, h)
        eta, xi = np.arctan2(h[:, 0], np.hypot(h[:, 1], h[:, 2])), np.arctan2(h[:, 1], h[:, 2])
        return np.stack([0.5 + 0.5 * np.arcsinh(eta / width) / end, np.interp(xi, angles, KNOTS)], axis=1)

    return Chart(direction, square)


def chart_for(lobe: str, parameters: dict[str, float], v: Array) -> Chart:
    """A chart that suits the library's lobe of that name; KeyError for an unknown lobe."""
    p = parameters
    charts: dict[str, Callable[[], Chart]] = {
        "lambert": lambda: axis_chart(np.array([0.0, 0.0, 1.0]), 1.0),
        "phong": lambda: axis_chart(v * np.array([-1.0, -1.0, 1.0]), p["exponent"]),
        "blinn_phong": lambda: half_vector_chart(v, *[_width(p["exponent"])] * 2),
        "ward": lambda: half_vector_chart(v, p["alpha_x"], p["alpha_y"]),
        "ashikhmin_shirley": lambda: half_vector_chart(v, _width(p["exponent_x"]), _width(p["exponent_y"])),
        "ggx": lambda: half_vector_chart(v, p["alpha_x"], p["alpha_y"]),
        "strand": lambda: fibre_chart(v, p["exponent"]),
        "poulin_fournier": lambda: arc_chart(v, p["spread"], p["exponent"]),
    }
    return charts[lobe]()


def _width(exponent: float) -> float:
    """Width in slope of a power of the height of the half vector."""
    return float(np.sqrt(2.0 / (exponent + 2.0)))
