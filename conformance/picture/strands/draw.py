"""Strands drawn by any backend: ribbons by OpenGL and WebGPU, rays for all others."""

from __future__ import annotations

from codegen.fur.stages import DIALECTS
from conformance.picture.backends import open_backend
from conformance.picture.rasterise import Singles, drawn
from conformance.picture.strands.march import march_strands
from conformance.picture.strands.studio import StrandStudio, open_strands


def draw_strands(studio: StrandStudio, target: str) -> tuple[Singles, str]:
    """Premultiplied samples (height, width, 4) of a scene's strands, and the driver that they are from.

    target  glsl and wgsl draw ribbons; opencl, numpy and numpy32 shade what rays meet of them
    errors  UserError for an unknown target, and without a driver
    """
    if target not in DIALECTS:
        backend = open_backend(target, studio.library)
        return march_strands(studio, backend), backend.driver
    return drawn(studio, open_strands(studio, target), target)
