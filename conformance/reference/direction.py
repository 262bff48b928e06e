"""References of the library's section `direction`.

Parameters that the library calls directions (a, b, l, v, n, t) are normalised in float64; `x` and `w`, in
which the functions are linear, are taken as they are. Vectors are (N, 3), a frame is a dict of three of them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from conformance.reference.exact import (
    Array,
    Struct,
    column,
    frame_tangent_and_bitangent,
    real,
    safe_unit,
    sine,
    unit,
)
from conformance.reference.sums import direction_sum, dot, rejection, rejection_direction

OPPOSITE = 1e-12
"""Below this |l + v|^2 the half vector is the documented fixed vector orthogonal to l."""


def line_component(x: Any, t: Any) -> Array:
    """Orthogonal projection of x on the line of t."""
    direction = unit(t)
    return column(dot(real(x), direction)) * direction


def line_rejection(x: Any, t: Any) -> Array:
    """What is left of x after the projection."""
    return rejection(x, t)


def sin_angle(a: Any, b: Any) -> Array:
    """Sine of the angle between two directions: |a x b| / (|a| |b|)."""
    return sine(a, b)


def frame_from_normal(n: Any) -> Struct:
    """Duff et al. 2017, "Building an Orthonormal Basis, Revisited", with s = n.z >= 0 ? 1 : -1."""
    tangent, bitangent = frame_tangent_and_bitangent(n)
    return {"tangent": tangent, "bitangent": bitangent, "normal": unit(n)}


def half_vector(l: Any, v: Any) -> Array:
    """The direction of l + v; where |l + v|^2 < 1e-12 the tangent of frame_from_normal(l)."""
    total = direction_sum(l, 1.0, v)
    opposite = dot(total, total) < OPPOSITE
    fixed = frame_from_normal(l)["tangent"]
    return np.where(opposite[..., None], fixed, safe_unit(total, fixed))


def mirror(l: Any, n: Any) -> Array:
    """l turned by half a revolution about n: 2 (n.l) n - l."""
    light, normal = unit(l), unit(n)
    return column(2.0 * dot(normal, light)) * normal - light


def frame_from_tangent(n: Any, t: Any) -> Struct:
    """Gram-Schmidt of t against n; where they are parallel the tangent of frame_from_normal(n)."""
    normal = unit(n)
    tangent = rejection_direction(t, n, frame_from_normal(n)["tangent"])
    return {"tangent": tangent, "bitangent": np.cross(normal, tangent), "normal": normal}


def to_local(frame: dict[str, Any], w: Any) -> Array:
    """Coordinates of w along the axes of the frame (tangent, bitangent, normal)."""
    wide_w = real(w)
    axes = [unit(frame[name]) for name in ("tangent", "bitangent", "normal")]
    return np.stack([dot(wide_w, axis) for axis in axes], axis=-1)


def to_world(frame: dict[str, Any], w: Any) -> Array:
    """The vector with the coordinates w in the frame."""
    wide_w = real(w)
    axes = [unit(frame[name]) for name in ("tangent", "bitangent", "normal")]
    along = [wide_w[..., k : k + 1] * axis for k, axis in enumerate(axes)]
    return np.asarray(along[0] + along[1] + along[2], dtype=np.float64)


REFERENCES: dict[str, Callable[..., Any]] = {
    "line_component": line_component,
    "line_rejection": line_rejection,
    "sin_angle": sin_angle,
    "sin_angle_half": sin_angle,
    "sin_angle_cross": sin_angle,
    "sin_angle_cosine": sin_angle,
    "half_vector": half_vector,
    "mirror": mirror,
    "frame_from_normal": frame_from_normal,
    "frame_from_tangent": frame_from_tangent,
    "to_local": to_local,
    "to_world": to_world,
}
