"""Draws triangles with WebGPU into a picture of floats."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from targets.protocol import BuildFailed
from targets.raster import Draw, Picture, attributes
from targets.wgsl.runtime import WgslRuntime

COLOURS, DEPTH = {16: "rgba16float", 32: "rgba32float"}, "depth32float"
ROW_ALIGNMENT = 256
"""Rows of a texture that is read start at multiples of this."""


class WgslScene:
    """Draw calls on the device of a runtime; see targets.raster.Scene. All draws share one module."""

    def __init__(
        self, runtime: WgslRuntime, module: str, draws: Sequence[Draw], size: tuple[int, int], bits: int = 16
    ) -> None:
        """Build the pipelines and upload the vertices; raises BuildFailed with naga's report.

        bits  of the picture's floats: 16 or 32, into which WebGPU does not blend
        """
        self._runtime, self._draws, self._size, self._bits = runtime, draws, size, bits
        self._wgpu, self._gpu = runtime._wgpu, runtime._device
        self._module = runtime.create_module(module)
        usage = self._wgpu.TextureUsage
        self._colour = self._texture(COLOURS[bits], usage.RENDER_ATTACHMENT | usage.COPY_SRC)
        self._depth = self._texture(DEPTH, usage.RENDER_ATTACHMENT)
        stages = self._wgpu.ShaderStage.VERTEX | self._wgpu.ShaderStage.FRAGMENT
        self._layout = self._gpu.create_bind_group_layout(
            entries=[{"binding": 0, "visibility": stages, "buffer": {"type": "uniform"}}]
        )
        self._pipelines = [self._pipeline(draw) for draw in draws]
        self._buffers = [self._upload(draw) for draw in draws]

    def draw(self, uniforms: bytes) -> Picture:
        """The picture; see targets.raster.Scene."""
        return self._draw(uniforms)

    def _draw(self, uniforms: bytes, read: bool = True) -> Picture:
        block = self._gpu.create_buffer_with_data(data=uniforms, usage=self._wgpu.BufferUsage.UNIFORM)
        group = self._gpu.create_bind_group(
            layout=self._layout,
            entries=[{"binding": 0, "resource": {"buffer": block, "offset": 0, "size": block.size}}],
        )
        encoder = self._gpu.create_command_encoder()
        render = encoder.begin_render_pass(
            color_attachments=[
                {
                    "view": self._colour.create_view(),
                    "clear_value": (0.0, 0.0, 0.0, 0.0),
                    "load_op": "clear",
                    "store_op": "store",
                }
            ],
            depth_stencil_attachment={
                "view": self._depth.create_view(),
                "depth_clear_value": 1.0,
                "depth_load_op": "clear",
                "depth_store_op": "store",
            },
        )
        for draw, pipeline, (vertices, indices) in zip(
            self._draws, self._pipelines, self._buffers, strict=True
        ):
            render.set_pipeline(pipeline)
            render.set_bind_group(0, group)
            render.set_vertex_buffer(0, vertices)
            render.set_index_buffer(indices, "uint32")
            render.draw_indexed(draw.triangles.size, draw.instances)
        render.end()
        self._gpu.queue.submit([encoder.finish()])
        picture = self._read(self._size if read else (1, 1))
        block.destroy()
        return picture

    def render(self, uniforms: bytes) -> None:
        """Draw and wait, by reading one texel; see targets.raster.Scene."""
        self._draw(uniforms, False)

    def release(self) -> None:
        """Give the device's memory back."""
        for pair in self._buffers:
            for buffer in pair:
                buffer.destroy()
        self._colour.destroy()
        self._depth.destroy()

    def _texture(self, form: str, usage: int) -> Any:
        return self._gpu.create_texture(size=(*self._size, 1), format=form, usage=usage)

    def _pipeline(self, draw: Draw) -> Any:
        state = draw.state
        target: dict[str, Any] = {"format": COLOURS[self._bits]}
        if state["blend"]:
            target["blend"] = {
                name: {
                    "src_factor": state["blend"][part]["source"],
                    "dst_factor": state["blend"][part]["destination"],
                    "operation": state["blend"][part]["operation"],
                }
                for name, part in (("color", "colour"), ("alpha", "alpha"))
            }
        layout = self._gpu.create_pipeline_layout(bind_group_layouts=[self._layout])
        buffer = {
            "array_stride": draw.vertices.dtype.itemsize,
            "step_mode": "vertex",
            "attributes": [
                {
                    "format": "float32" if floats == 1 else f"float32x{floats}",
                    "offset": offset,
                    "shader_location": location,
                }
                for location, (_, floats, offset) in enumerate(attributes(draw.vertices))
            ],
        }
        try:
            return self._gpu.create_render_pipeline(
                layout=layout,
                vertex={"module": self._module, "entry_point": draw.vertex, "buffers": [buffer]},
                fragment={"module": self._module, "entry_point": draw.fragment, "targets": [target]},
                primitive={"topology": "triangle-list", "front_face": "ccw", "cull_mode": state["cull"]},
                depth_stencil={
                    "format": DEPTH,
                    "depth_write_enabled": state["depth_write"],
                    "depth_compare": state["depth_test"],
                },
            )
        except (self._wgpu.GPUError, self._wgpu.GPUPipelineError) as error:
            raise BuildFailed(str(error).strip()) from error

    def _upload(self, draw: Draw) -> tuple[Any, Any]:
        usage = self._wgpu.BufferUsage
        vertices = np.ascontiguousarray(draw.vertices).tobytes()
        indices = np.ascontiguousarray(draw.triangles).tobytes()
        make = self._gpu.create_buffer_with_data
        return make(data=vertices, usage=usage.VERTEX), make(data=indices, usage=usage.INDEX)

    def _read(self, size: tuple[int, int]) -> Picture:
        width, height = size
        texel = 4 * self._bits // 8
        row = -(-width * texel // ROW_ALIGNMENT) * ROW_ALIGNMENT
        data = self._gpu.queue.read_texture(
            {"texture": self._colour, "mip_level": 0, "origin": (0, 0, 0)},
            {"offset": 0, "bytes_per_row": row, "rows_per_image": height},
            (width, height, 1),
        )
        floats = np.frombuffer(data, f"f{self._bits // 8}").reshape(height, -1)[:, : 4 * width]
        return floats.reshape(height, width, 4).astype(np.float32)
