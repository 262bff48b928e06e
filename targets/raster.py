"""What the renderers of a target draw: texts, arrays and states."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

Picture = npt.NDArray[np.float32]


@dataclass(frozen=True)
class Draw:
    """One draw call.

    vertex, fragment  GLSL: texts of the stages; WGSL: names of entry points
    vertices          structured array of floats; its fields are the attributes, by location
    triangles         (F, 3) uint32
    instances         how many times the triangles are drawn, one after the other
    state             blend (None or factors), depth_test, depth_write, cull
    """

    vertex: str
    fragment: str
    vertices: npt.NDArray[Any]
    triangles: npt.NDArray[np.uint32]
    instances: int
    state: Mapping[str, Any]


class Scene(Protocol):
    """Draw calls on a device, to be drawn as often as wanted."""

    def draw(self, uniforms: bytes) -> Picture:
        """Draw all calls in order on a cleared picture.

        uniforms  content of the uniform block
        returns   (height, width, 4) premultiplied linear RGB and coverage, top row first
        """
        ...

    def render(self, uniforms: bytes) -> None:
        """Draw the same and wait until it is drawn, without reading the picture."""
        ...

    def release(self) -> None:
        """Give the device's memory back."""
        ...


def attributes(vertices: npt.NDArray[Any]) -> list[tuple[str, int, int]]:
    """Name, number of floats and byte offset of every attribute."""
    fields: Mapping[str, Any] = vertices.dtype.fields or {}
    return [(name, field[0].itemsize // 4, int(field[1])) for name, field in fields.items()]
