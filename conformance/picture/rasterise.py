"""What fur and strands share on their way through a rasteriser: clip space, lights, the draw, the picture."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from codegen.backends import open_runtime
from codegen.errors import UserError
from codegen.fur.layout import MOST_LIGHTS, Block
from conformance.picture.scene import Light, Picture
from conformance.picture.tone import gradient
from conformance.picture.vectors import unit
from conformance.picture.visibility import Camera
from targets.raster import Draw
from targets.raster import Scene as Drawing

Doubles = npt.NDArray[np.float64]
Singles = npt.NDArray[np.float32]

LARGEST_SIDE = 8192
"""Samples along a side: of the largest texture that WebGPU promises."""
DEPTH_FROM = {"glsl": -1.0, "wgsl": 0.0}
NEAREST = 1e-3
"""Of the far plane: how near the near plane may come to a camera inside the coat."""


class Drawable(Protocol):
    """A scene made ready for stages with a uniform block."""

    @property
    def block(self) -> Block:
        """The uniform block of the stages."""
        ...

    def values(self, target: str) -> dict[str, Any]:
        """Values by member of the uniform block."""
        ...


def refuse_too_large(path: Path, picture: Picture) -> None:
    """Raise UserError for a picture with more samples along a side than can be drawn."""
    if max(picture.samples) > LARGEST_SIDE:
        raise UserError(f"{path}: [render] size times supersample may be {LARGEST_SIDE} at most")


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


def clip_space(picture: Picture, bounds: tuple[Doubles, float], target: str) -> Doubles:
    """view_projection of a picture for a target, as the uniform block holds it: (16,), column by column."""
    width, height = picture.size
    matrix = view_projection(picture.camera, width / height, bounds, DEPTH_FROM[target])
    return matrix.T.reshape(-1)


def ball(vertices: npt.NDArray[Any], further: float) -> tuple[Doubles, float]:
    """Centre and radius of a ball around vertices and what lies up to `further` away from them."""
    positions = vertices["position"].astype(np.float64)
    centre: Doubles = (positions.min(axis=0) + positions.max(axis=0)) / 2.0
    return centre, float(np.linalg.norm(positions - centre, axis=1).max()) + further


def light_arrays(lights: tuple[Light, ...]) -> dict[str, Any]:
    """The members of the block that hold the lights; raises UserError for too many."""
    if len(lights) > MOST_LIGHTS:
        raise UserError(f"fur and strands are lit by at most {MOST_LIGHTS} lights, not {len(lights)}")
    directions, colours = np.zeros((2, len(lights), 4), np.float32)
    for k, light in enumerate(lights):
        directions[k, :3] = unit(np.asarray(light.direction, np.float32))
        colours[k, :3] = light.colour
    return {"light_count": len(lights), "light_direction": directions, "light_colour": colours}


def open_scene(
    target: str,
    texts: Mapping[str, str],
    module: str,
    draws: list[Draw],
    size: tuple[int, int],
    bits: int = 16,
) -> Drawing:
    """Draw calls on a target's device.

    texts   the stages, by name
    module  which text the draw calls name entry points of, where the target is WGSL
    size    samples (width, height)
    bits    of the picture's floats
    """
    runtime: Any = open_runtime(target)
    if target == "wgsl":
        from targets.wgsl.raster import WgslScene

        return WgslScene(runtime, texts[module], draws, size, bits)
    from targets.glsl.raster import GlslScene

    return GlslScene(runtime, draws, size, bits)


def drawn(studio: Drawable, drawing: Drawing, target: str) -> tuple[Singles, str]:
    """Premultiplied samples (height, width, 4), and the driver that drew them; the drawing is given back."""
    samples = drawing.draw(studio.block.pack(studio.values(target)))
    drawing.release()
    device = open_runtime(target).device
    return samples, f"{device.driver}, {device.device}"


def develop(picture: Picture, samples: Singles) -> Doubles:
    """Samples (height s, width s, 4), premultiplied, averaged into pixels over the background."""
    width, height = picture.size
    side = picture.supersample
    mean = samples.astype(np.float64).reshape(height, side, width, side, 4).mean(axis=(1, 3))
    background = gradient(picture.size, picture.top, picture.bottom)
    light: Doubles = mean[..., :3] + (1.0 - mean[..., 3:]) * background
    return light
