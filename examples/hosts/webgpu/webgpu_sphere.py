"""Draws a brushed sphere with WebGPU: `python examples/hosts/webgpu/webgpu_sphere.py -o sphere.png`.

A WGSL module is one text, so the library and the stages that call it are joined. What is below reads the same
in JavaScript.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image

HERE = Path(__file__).parent
LIBRARY = HERE.parents[2] / "targets" / "wgsl" / "include" / "vair.wgsl"
SIDE = 256
FORMAT = "rgba8unorm"


def draw(library: str) -> npt.NDArray[np.uint8]:
    """Pixels (SIDE, SIDE, 4), top row first."""
    import wgpu

    device = wgpu.gpu.request_adapter_sync().request_device_sync()
    module = device.create_shader_module(code=library + (HERE / "sphere.wgsl").read_text(encoding="utf-8"))
    pipeline = device.create_render_pipeline(
        layout="auto",
        vertex={"module": module, "entry_point": "vertex"},
        fragment={"module": module, "entry_point": "fragment", "targets": [{"format": FORMAT}]},
        primitive={"topology": "triangle-list"},
    )
    usage = wgpu.TextureUsage.RENDER_ATTACHMENT | wgpu.TextureUsage.COPY_SRC
    texture = device.create_texture(size=(SIDE, SIDE, 1), format=FORMAT, usage=usage)
    encoder = device.create_command_encoder()
    target = {"view": texture.create_view(), "load_op": "clear", "store_op": "store"}
    drawing = encoder.begin_render_pass(color_attachments=[target])
    drawing.set_pipeline(pipeline)
    drawing.draw(3)
    drawing.end()
    device.queue.submit([encoder.finish()])
    layout = {"bytes_per_row": 4 * SIDE, "rows_per_image": SIDE}
    data = device.queue.read_texture({"texture": texture}, layout, (SIDE, SIDE, 1))
    return np.frombuffer(data, np.uint8).reshape(SIDE, SIDE, 4)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Draws a brushed sphere with WebGPU.")
    parser.add_argument("-o", "--output", type=Path, default=Path("sphere.png"))
    parser.add_argument("--library", type=Path, default=LIBRARY)
    words = parser.parse_args()
    Image.fromarray(draw(words.library.read_text(encoding="utf-8"))).convert("RGB").save(words.output)
