"""A picture of fur or strands by any backend: the rasterisers of OpenGL and WebGPU, rays for all others."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from codegen.backends import open_runtime
from codegen.fur.stages import DIALECTS
from codegen.library import Library
from conformance.picture.backends import open_backend
from conformance.picture.fur_march import March
from conformance.picture.fur_render import FurStudio, develop, open_drawing, set_up_fur
from conformance.picture.image import write_png
from conformance.picture.strand_render import draw_strands, set_up_strands
from conformance.picture.tone import eight_bit


def draw_fur(studio: FurStudio, target: str) -> tuple[npt.NDArray[np.float32], str]:
    """Premultiplied samples (height, width, 4) of a scene's fur, and the driver that they are from.

    target  glsl and wgsl draw shells and fins; opencl, numpy and numpy32 shade what rays meet of them
    errors  UserError for an unknown target, and without a driver
    """
    if target not in DIALECTS:
        backend = open_backend(target, studio.library)
        return March(studio, backend).draw(), backend.driver
    drawing = open_drawing(studio, target)
    samples = drawing.draw(studio.block.pack(studio.values(target)))
    drawing.release()
    device = open_runtime(target).device
    return samples, f"{device.driver}, {device.device}"


def render_fur(library: Library, path: Path, target: str | None, output: Path) -> tuple[str, str]:
    """Draw a scene's fur on a target (the scene's first one if None) and write the PNG.

    returns  the target and its driver
    errors   UserError
    """
    studio = set_up_fur(library, path)
    chosen = target or studio.scene.targets[0]
    samples, driver = draw_fur(studio, chosen)
    write_png(output, eight_bit(develop(studio.picture, samples)))
    return chosen, driver


def render_strands(library: Library, path: Path, target: str | None, output: Path) -> tuple[str, str]:
    """Draw a scene's strands on a target (the scene's first one if None) and write the PNG.

    returns  the target and its driver
    errors   UserError
    """
    studio = set_up_strands(library, path)
    chosen = target or studio.scene.targets[0]
    samples, driver = draw_strands(studio, chosen)
    write_png(output, eight_bit(develop(studio.picture, samples)))
    return chosen, driver
