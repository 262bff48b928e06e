"""Draws fur with WebGPU: `python examples/fur/webgpu.py KIT -o fur.png`, KIT from `vair fur`.

Nearly every line reads the same in JavaScript.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from kit import Kit, main  # type: ignore[import-not-found]

COLOUR, DEPTH = "rgba16float", "depth32float"


def draw(kit: Kit, size: tuple[int, int]) -> npt.NDArray[np.float32]:
    """Premultiplied linear samples (height, width, 4), top row first."""
    import wgpu

    device = wgpu.gpu.request_adapter_sync().request_device_sync()
    usage = wgpu.TextureUsage
    colour = device.create_texture(
        size=(*size, 1), format=COLOUR, usage=usage.RENDER_ATTACHMENT | usage.COPY_SRC
    )
    depth = device.create_texture(size=(*size, 1), format=DEPTH, usage=usage.RENDER_ATTACHMENT)
    block = device.create_buffer_with_data(data=kit.uniforms("webgpu"), usage=wgpu.BufferUsage.UNIFORM)
    layout = device.create_bind_group_layout(
        entries=[
            {
                "binding": kit.about["uniforms"]["binding"],
                "visibility": wgpu.ShaderStage.VERTEX | wgpu.ShaderStage.FRAGMENT,
                "buffer": {"type": "uniform"},
            }
        ]
    )
    group = device.create_bind_group(layout=layout, entries=[{"binding": 0, "resource": {"buffer": block}}])
    encoder = device.create_command_encoder()
    render = encoder.begin_render_pass(
        color_attachments=[
            {
                "view": colour.create_view(),
                "clear_value": (0.0, 0.0, 0.0, 0.0),
                "load_op": "clear",
                "store_op": "store",
            }
        ],
        depth_stencil_attachment={
            "view": depth.create_view(),
            "depth_clear_value": 1.0,
            "depth_load_op": "clear",
            "depth_store_op": "store",
        },
    )
    render.set_bind_group(0, group)
    for item in kit.about["passes"]:
        render.set_pipeline(pipeline(device, layout, kit, item))
        vertices = device.create_buffer_with_data(
            data=kit.buffer(item["vertices"]), usage=wgpu.BufferUsage.VERTEX
        )
        triangles = device.create_buffer_with_data(
            data=kit.buffer(item["triangles"]), usage=wgpu.BufferUsage.INDEX
        )
        render.set_vertex_buffer(0, vertices)
        render.set_index_buffer(triangles, "uint32")
        render.draw_indexed(kit.about["buffers"][item["triangles"]]["count"], item["instances"])
    render.end()
    device.queue.submit([encoder.finish()])
    return read(device, colour, size)


def pipeline(device: Any, layout: Any, kit: Kit, item: dict[str, Any]) -> Any:
    """A pass with its state."""
    module = device.create_shader_module(code=kit.text(item["wgsl"]["file"]))
    described, state = kit.about["buffers"][item["vertices"]], item["state"]
    attributes = [
        {
            "format": "float32" if a["floats"] == 1 else f"float32x{a['floats']}",
            "offset": a["offset"],
            "shader_location": a["location"],
        }
        for a in described["attributes"]
    ]
    target: dict[str, Any] = {"format": COLOUR}
    if state["blend"]:
        target["blend"] = {
            name: {
                "src_factor": part["source"],
                "dst_factor": part["destination"],
                "operation": part["operation"],
            }
            for name, part in (("color", state["blend"]["colour"]), ("alpha", state["blend"]["alpha"]))
        }
    return device.create_render_pipeline(
        layout=device.create_pipeline_layout(bind_group_layouts=[layout]),
        vertex={
            "module": module,
            "entry_point": item["wgsl"]["vertex"],
            "buffers": [{"array_stride": described["stride"], "attributes": attributes}],
        },
        fragment={"module": module, "entry_point": item["wgsl"]["fragment"], "targets": [target]},
        primitive={"topology": "triangle-list", "cull_mode": state["cull"]},
        depth_stencil={
            "format": DEPTH,
            "depth_write_enabled": state["depth_write"],
            "depth_compare": state["depth_test"],
        },
    )


def read(device: Any, colour: Any, size: tuple[int, int]) -> npt.NDArray[np.float32]:
    """The texels of a picture; rows are read 256 bytes aligned."""
    width, height = size
    row = -(-width * 8 // 256) * 256
    data = device.queue.read_texture(
        {"texture": colour}, {"bytes_per_row": row, "rows_per_image": height}, (width, height, 1)
    )
    texels = np.frombuffer(data, np.float16).reshape(height, row // 2)[:, : 4 * width]
    return texels.reshape(height, width, 4).astype(np.float32)


if __name__ == "__main__":
    main(draw)
