"""Maps as a runtime takes them, and what declares them around a library."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt


@dataclass(frozen=True)
class TextureData:
    """A chain of levels, float32 (h, w, 4), the largest first, and whether it repeats along u and v.

    Filtering is linear within a level and between levels.
    """

    levels: tuple[npt.NDArray[np.float32], ...]
    repeat_u: bool = False
    repeat_v: bool = False

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the largest level."""
        height, width = self.levels[0].shape[:2]
        return width, height


FIRST_BINDING = 3
"""In WGSL, after the buffers of the harness: map k has bindings FIRST_BINDING + 2 k and the next."""


def declarations(target: str, names: Sequence[str]) -> str:
    """What declares these maps: globals, or in OpenCL C further parameters of the kernel."""
    lines = []
    for k, name in enumerate(names):
        match target:
            case "glsl":
                lines.append(f"layout(binding = {k}) uniform sampler2D {name};")
            case "wgsl":
                first = FIRST_BINDING + 2 * k
                lines.append(f"@group(0) @binding({first}) var {name}: texture_2d<f32>;")
                lines.append(f"@group(0) @binding({first + 1}) var {name}_sampler: sampler;")
            case _:
                parts = (
                    f"read_only image2d_t {name}",
                    f"sampler_t {name}_sampler",
                    f"const int4 {name}_layout",
                )
                lines.append(",\n    " + ", ".join(parts))
    return ("" if target == "opencl" else "\n").join(lines)
