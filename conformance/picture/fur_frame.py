"""One frame of fur: the values of the uniform block for a camera, lights, a coat and a material."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError
from codegen.fur.coat import FurMesh
from codegen.fur.layout import MOST_LIGHTS
from codegen.fur.shading import member_name
from conformance.picture.fur_settings import Fur
from conformance.picture.scene import Light
from conformance.picture.vectors import unit
from conformance.picture.visibility import Camera

Doubles = npt.NDArray[np.float64]

NEAREST = 1e-3
"""Of the far plane: how near the near plane may come to a camera inside the coat."""


def view_projection(
    camera: Camera, aspect: float, bounds: tuple[Doubles, float], depth_from: float
) -> Doubles:
    """From scene units to clip space, (4, 4) for columns on the right.

    bounds      centre and radius of a ball around everything that is drawn
    depth_from  -1 for OpenGL, whose depth runs from -w to w; 0 for WebGPU, where it runs from 0 to w
    """
    eye = np.asarray(camera.eye, np.float64)
    forward = unit(np.subtract(camera.target, eye))
    right = unit(np.cross(forward, camera.up))
    up = np.cross(right, forward)
    view = np.eye(4)
    view[:3, :3] = right, up, -forward
    view[:3, 3] = -view[:3, :3] @ eye
    centre, radius = bounds
    distance = float(np.dot(centre - eye, forward))
    far = max(distance + radius, radius)
    near = max(distance - radius, NEAREST * far)
    focal = 1.0 / np.tan(np.radians(camera.field_of_view) / 2.0)
    projection = np.zeros((4, 4))
    projection[0, 0], projection[1, 1] = focal / aspect, focal
    # Depth is z/w = (a z + b) / -z with depth_from at z = -near and 1 at z = -far.
    a = (depth_from * near - far) / (far - near)
    projection[2, 2], projection[2, 3], projection[3, 2] = a, near * (a + depth_from), -1.0
    product: Doubles = projection @ view
    return product


def ball(mesh: FurMesh, coat_length: float) -> tuple[Doubles, float]:
    """Centre and radius of a ball around the mesh and its coat."""
    positions = mesh.vertices["position"].astype(np.float64)
    centre: Doubles = (positions.min(axis=0) + positions.max(axis=0)) / 2.0
    return centre, float(np.linalg.norm(positions - centre, axis=1).max()) + coat_length


def frame_values(
    fur: Fur, mesh: FurMesh, camera: Camera, lights: tuple[Light, ...], material: Mapping[str, Any]
) -> dict[str, Any]:
    """Values by member of the uniform block, without view_projection; `material` by a parameter's name."""
    rho, cos_dark, cos_lit = fur.surface
    return {
        "eye": camera.eye,
        "coat_length": fur.length,
        "force": fur.force,
        "s_min": fur.s_min,
        "hairs": mesh.hairs,
        "thickness": fur.thickness,
        "opacity": fur.opacity,
        "authored_layers": fur.authored_layers,
        "layers": fur.layers,
        "seed": fur.seed,
        "fin_threshold": fur.fin_threshold,
        "rho_surface": rho,
        "cos_dark": cos_dark,
        "cos_lit": cos_lit,
        "fin_opacity": fur.fin_opacity,
        **light_arrays(lights),
        **{member_name(path): value for path, value in material.items()},
    }


def light_arrays(lights: tuple[Light, ...]) -> dict[str, Any]:
    """The members of the block that hold the lights; raises UserError for too many."""
    if len(lights) > MOST_LIGHTS:
        raise UserError(f"fur and strands are lit by at most {MOST_LIGHTS} lights, not {len(lights)}")
    directions, colours = np.zeros((2, len(lights), 4), np.float32)
    for k, light in enumerate(lights):
        directions[k, :3] = unit(np.asarray(light.direction, np.float32))
        colours[k, :3] = light.colour
    return {"light_count": len(lights), "light_direction": directions, "light_colour": colours}
