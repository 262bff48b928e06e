"""Fur drawn by any backend: shells and fins by OpenGL and WebGPU, rays for all others."""

from __future__ import annotations

from codegen.fur.stages import DIALECTS
from conformance.picture.backends import open_backend
from conformance.picture.fur.march import March
from conformance.picture.fur.studio import FurStudio, open_fur
from conformance.picture.rasterise import Singles, drawn


def draw_fur(studio: FurStudio, target: str) -> tuple[Singles, str]:
    """Premultiplied samples (height, width, 4) of a scene's fur, and the driver that they are from.

    target  glsl and wgsl draw shells and fins; opencl, numpy and numpy32 shade what rays meet of them
    errors  UserError for an unknown target, and without a driver
    """
    if target not in DIALECTS:
        backend = open_backend(target, studio.library)
        return March(studio, backend).draw(), backend.driver
    return drawn(studio, open_fur(studio, target), target)
