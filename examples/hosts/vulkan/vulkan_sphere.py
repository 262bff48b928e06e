"""Draws a brushed sphere from SPIR-V: `python examples/hosts/vulkan/vulkan_sphere.py -o sphere.png`.

The shaders are compiled as an engine's build would: glslangValidator includes the library and writes SPIR-V,
spirv-val judges it, and the modules go to a Vulkan driver through wgpu.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

HERE = Path(__file__).parent
LIBRARY = HERE.parents[2] / "targets" / "glsl" / "include"
SIDE = 256
FORMAT = "rgba8unorm"


def compiled(stage: str, library: Path, folder: Path) -> bytes:
    """SPIR-V of sphere.vert or sphere.frag; ends the program where a tool refuses it."""
    source, module = HERE / f"sphere.{stage}", folder / f"{stage}.spv"
    for command in (
        ["glslangValidator", "-V", "--quiet", f"-I{library}", "-o", str(module), str(source)],
        ["spirv-val", "--target-env", "vulkan1.0", str(module)],
    ):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"{command[0]}: {source.name}: {done.stdout}{done.stderr}".strip())
    return module.read_bytes()


def draw(vertex: bytes, fragment: bytes) -> npt.NDArray[np.uint8]:
    """Pixels (SIDE, SIDE, 4), top row first."""
    import wgpu

    adapters = wgpu.gpu.enumerate_adapters_sync()
    adapter = next((found for found in adapters if found.info["backend_type"] == "Vulkan"), None)
    if adapter is None:
        sys.exit("vulkan: there is no driver")
    device = adapter.request_device_sync()
    modules = [device.create_shader_module(code=code) for code in (vertex, fragment)]
    pipeline = device.create_render_pipeline(
        layout=device.create_pipeline_layout(bind_group_layouts=[]),
        vertex={"module": modules[0], "entry_point": "main"},
        fragment={"module": modules[1], "entry_point": "main", "targets": [{"format": FORMAT}]},
        primitive={"topology": "triangle-list"},
    )
    usage = wgpu.TextureUsage.RENDER_ATTACHMENT | wgpu.TextureUsage.COPY_SRC
    texture = device.create_texture(size=(SIDE, SIDE, 1), format=FORMAT, usage=usage)
    target: Any = {"view": texture.create_view(), "load_op": "clear", "store_op": "store"}
    encoder = device.create_command_encoder()
    drawing = encoder.begin_render_pass(color_attachments=[target])
    drawing.set_pipeline(pipeline)
    drawing.draw(3)
    drawing.end()
    device.queue.submit([encoder.finish()])
    layout = {"bytes_per_row": 4 * SIDE, "rows_per_image": SIDE}
    data = device.queue.read_texture({"texture": texture}, layout, (SIDE, SIDE, 1))
    return np.frombuffer(data, np.uint8).reshape(SIDE, SIDE, 4)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Draws a brushed sphere from SPIR-V.")
    parser.add_argument("-o", "--output", type=Path, default=Path("sphere.png"))
    parser.add_argument("--library", type=Path, default=LIBRARY, help="folder of vair-vulkan450.glsl")
    words = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="sphere-") as folder:
        stages = [compiled(stage, words.library, Path(folder)) for stage in ("vert", "frag")]
    Image.fromarray(draw(*stages)).convert("RGB").save(words.output)
