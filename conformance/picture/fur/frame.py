"""One frame of fur: the values of the uniform block for a camera, lights, a coat and a material."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from codegen.fur.coat import FurMesh
from codegen.fur.shading import member_name
from conformance.picture.fur.settings import Fur
from conformance.picture.rasterise import light_arrays
from conformance.picture.scene import Light
from conformance.picture.visibility import Camera


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
