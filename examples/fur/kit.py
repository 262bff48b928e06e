"""What both example programs do: read a folder that `vair fur` wrote, pack its uniforms, write a picture.

Nothing of Vair is imported; an engine needs no more than this.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

TYPES = {"u32": "<u4", "i32": "<i4"}


@dataclass(frozen=True)
class Kit:
    """A folder with fur.json, fur.bin and the stages."""

    folder: Path
    about: dict[str, Any]
    data: bytes

    def text(self, name: str) -> str:
        """The text of a stage."""
        return (self.folder / name).read_text(encoding="utf-8")

    def buffer(self, name: str) -> bytes:
        """Vertices or triangles, ready to be uploaded."""
        found = self.about["buffers"][name]
        return self.data[found["offset"] : found["offset"] + found["bytes"]]

    def uniforms(self, interface: str) -> bytes:
        """The uniform block with the values of the scene; interface is "opengl" or "webgpu"."""
        described = self.about["uniforms"]
        block = bytearray(described["bytes"])
        matrix = {"view_projection": self.about["view_projection"][interface]}
        for member in described["members"]:
            value = matrix.get(member["name"], member.get("value"))
            array = np.atleast_1d(np.asarray(value, TYPES.get(member["type"], "<f4")))
            block[member["offset"] : member["offset"] + array.nbytes] = array.tobytes()
        return bytes(block)


def read_kit(folder: Path) -> Kit:
    """Read a folder that `vair fur` wrote."""
    about = json.loads((folder / "fur.json").read_text(encoding="utf-8"))
    return Kit(folder, about, (folder / about["buffers"]["file"]).read_bytes())


def over(samples: npt.NDArray[np.float32], top: Any, bottom: Any) -> npt.NDArray[np.uint8]:
    """Premultiplied linear samples (height, width, 4) over a gradient of two sRGB colours, as sRGB."""
    share = np.linspace(0.0, 1.0, len(samples))[:, None]
    ground = (1.0 - share) * np.asarray(top) + share * np.asarray(bottom)
    ground = np.where(ground <= 0.04045, ground / 12.92, ((ground + 0.055) / 1.055) ** 2.4)
    linear = np.clip(samples[..., :3] + (1.0 - samples[..., 3:]) * ground[:, None], 0.0, 1.0)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055)
    return np.asarray(np.round(255.0 * encoded), np.uint8)


def main(draw: Callable[[Kit, tuple[int, int]], npt.NDArray[np.float32]]) -> None:
    """Draw a kit and write the picture."""
    parser = argparse.ArgumentParser(description="Draw the fur of a folder that `vair fur` wrote.")
    parser.add_argument("kit", type=Path, help="the folder")
    parser.add_argument("-o", "--output", type=Path, required=True, help="the picture, a PNG file")
    options = parser.parse_args()
    kit = read_kit(options.kit)
    scene = kit.about["scene"]
    width, height = scene["size"]
    samples = draw(kit, (width, height))
    Image.fromarray(over(samples, **scene["background"])).save(options.output)
