"""Runs WGSL compute programs on WebGPU through wgpu."""

import os
import tempfile
from collections.abc import Sequence
from importlib.metadata import version
from threading import RLock
from typing import Any

import numpy as np

from targets.lanes import (
    CHUNK_BYTES,
    UNIFORM_BYTES,
    UNWRITTEN,
    ChunkedRuntime,
    check_words,
    group_count,
    padded,
)
from targets.packages import first_line, fits, require_package
from targets.programs import Programs
from targets.protocol import BuildFailed, Device, TargetUnavailable
from targets.textures import TextureData
from targets.words import Words

ADAPTER_VARIABLE = "VAIR_WGPU_ADAPTER"
MISSING_DRIVER = "no WebGPU adapter is here ({reason}): apt-get install mesa-vulkan-drivers"

PREFERRED_BACKENDS = ("Vulkan", "Metal", "D3D12", "OpenGL")
PREFERRED_KINDS = ("DiscreteGPU", "IntegratedGPU", "CPU", "Unknown")

HALF_FEATURE = "shader-f16"
FILTER_FEATURE = "float32-filterable"
OPTIONAL_FEATURES = {HALF_FEATURE, FILTER_FEATURE}
"""Asked for where the adapter has them."""

READ_ONLY, READ_WRITE, UNIFORM = "read-only-storage", "storage", "uniform"


def open_runtime(uniforms: bool = False) -> "WgslRuntime":
    """Open a device on the preferred adapter, or on the one that VAIR_WGPU_ADAPTER names.

    uniforms  whether the input is a uniform buffer, for programs of the form "uniform"
    errors    TargetUnavailable
    """
    # Without the variable wgpu complains twice on standard error.
    os.environ.setdefault("XDG_RUNTIME_DIR", tempfile.gettempdir())
    return WgslRuntime(require_package("wgpu"), uniforms)


class WgslRuntime(ChunkedRuntime):
    """WebGPU compute behind one lock."""

    def __init__(self, wgpu: Any, uniforms: bool = False) -> None:
        self._wgpu = wgpu
        self._lock = RLock()
        self._programs: Programs[str, Any] = Programs()
        adapter = _choose_adapter(wgpu, os.environ.get(ADAPTER_VARIABLE, ""))
        try:
            wanted = sorted(OPTIONAL_FEATURES & set(adapter.features))
            self._device = adapter.request_device_sync(required_features=wanted)
        except Exception as error:
            raise TargetUnavailable(MISSING_DRIVER.format(reason=first_line(error))) from error
        largest = self._device.limits["max-storage-buffer-binding-size"]
        self.uniforms = uniforms
        self.half_arithmetic = HALF_FEATURE in wanted
        self.filters_floats = FILTER_FEATURE in wanted
        self.chunk_bytes = UNIFORM_BYTES if uniforms else min(CHUNK_BYTES, largest)
        self.device = _describe(adapter)

    def prepare(
        self, program: str, words: Words, slots_out: int, textures: Sequence[TextureData] = ()
    ) -> "WgslPrepared":
        """Build a program and upload its input; see targets.protocol.TimedRuntime."""
        check_words(words, slots_out)
        with self._lock:
            pipeline = self._build(program, len(textures))
            return WgslPrepared(self, pipeline, words, slots_out, textures)

    def bindings(self, textures: int) -> Any:
        """The layout of the harness's buffers and of so many maps with their samplers."""
        kinds = [
            {"buffer": {"type": kind}}
            for kind in (UNIFORM if self.uniforms else READ_ONLY, READ_WRITE, UNIFORM)
        ]
        for _ in range(textures):
            kinds += [{"texture": {"sample_type": "float"}}, {"sampler": {"type": "filtering"}}]
        stage = self._wgpu.ShaderStage.COMPUTE
        return self._device.create_bind_group_layout(
            entries=[{"binding": number, "visibility": stage, **kind} for number, kind in enumerate(kinds)]
        )

    def create_module(self, text: str) -> Any:
        """A shader module of a valid WGSL text; raises BuildFailed with naga's report."""
        with self._lock:
            try:
                return self._device.create_shader_module(code=text)
            except (self._wgpu.GPUError, self._wgpu.GPUPipelineError) as error:
                raise BuildFailed(str(error).strip()) from error

    def _build(self, program: str, textures: int) -> Any:
        return self._programs.find(program, lambda: self._create_pipeline(program, textures))

    def _create_pipeline(self, program: str, textures: int) -> Any:
        module = self.create_module(program)
        layout = self._device.create_pipeline_layout(bind_group_layouts=[self.bindings(textures)])
        try:
            return self._device.create_compute_pipeline(
                layout=layout, compute={"module": module, "entry_point": "harness_main"}
            )
        except (self._wgpu.GPUError, self._wgpu.GPUPipelineError) as error:
            raise BuildFailed(str(error).strip()) from error


class WgslPrepared:
    """A compute pipeline with its buffers."""

    def __init__(
        self,
        runtime: WgslRuntime,
        pipeline: Any,
        words: Words,
        slots_out: int,
        textures: Sequence[TextureData] = (),
    ) -> None:
        self._lock = runtime._lock
        self._gpu = runtime._device
        self._pipeline = pipeline
        self._shape = (slots_out, words.shape[1])
        # WebGPU refuses an empty buffer.
        source = np.ascontiguousarray(words) if words.size else np.zeros(1, np.uint32)
        if runtime.uniforms:
            source = padded(source)
        blank = np.full(max(slots_out * words.shape[1], 1), UNWRITTEN, np.uint32)
        usage = runtime._wgpu.BufferUsage
        self._buffers = [
            self._gpu.create_buffer_with_data(
                data=source, usage=usage.UNIFORM if runtime.uniforms else usage.STORAGE
            ),
            self._gpu.create_buffer_with_data(data=blank, usage=usage.STORAGE | usage.COPY_SRC),
            self._gpu.create_buffer_with_data(
                data=np.array([words.shape[1], 0, 0, 0], np.uint32), usage=usage.UNIFORM
            ),
        ]
        resources = [{"buffer": buffer, "offset": 0, "size": buffer.size} for buffer in self._buffers]
        self._textures = [self._texture(runtime, data) for data in textures]
        for texture, data in zip(self._textures, textures, strict=True):
            resources += [texture.create_view(), self._sampler(data)]
        self._group = self._gpu.create_bind_group(
            layout=runtime.bindings(len(textures)),
            entries=[{"binding": number, "resource": found} for number, found in enumerate(resources)],
        )

    def _texture(self, runtime: WgslRuntime, data: TextureData) -> Any:
        if not runtime.filters_floats:
            raise TargetUnavailable("this WebGPU adapter does not filter float32 maps (float32-filterable)")
        usage = runtime._wgpu.TextureUsage
        texture = self._gpu.create_texture(
            size=(*data.size, 1),
            format="rgba32float",
            mip_level_count=len(data.levels),
            usage=usage.TEXTURE_BINDING | usage.COPY_DST,
        )
        for k, level in enumerate(data.levels):
            height, width = level.shape[:2]
            self._gpu.queue.write_texture(
                {"texture": texture, "mip_level": k, "origin": (0, 0, 0)},
                np.ascontiguousarray(level),
                {"offset": 0, "bytes_per_row": 16 * width, "rows_per_image": height},
                (width, height, 1),
            )
        return texture

    def _sampler(self, data: TextureData) -> Any:
        edges = {True: "repeat", False: "clamp-to-edge"}
        return self._gpu.create_sampler(
            address_mode_u=edges[data.repeat_u],
            address_mode_v=edges[data.repeat_v],
            mag_filter="linear",
            min_filter="linear",
            mipmap_filter="linear",
        )

    def launch(self) -> None:
        """Run the program over all lanes and wait until it is done."""
        lanes = self._shape[1]
        if lanes == 0:
            return
        with self._lock:
            encoder = self._gpu.create_command_encoder()
            compute = encoder.begin_compute_pass()
            compute.set_pipeline(self._pipeline)
            compute.set_bind_group(0, self._group)
            compute.dispatch_workgroups(group_count(lanes))
            compute.end()
            self._gpu.queue.submit([encoder.finish()])
            # on_submitted_work_done_sync raises TypeError in wgpu 0.32; reading one word waits as well.
            self._gpu.queue.read_buffer(self._buffers[1], 0, 4)

    def read(self) -> Words:
        """The output words, (slots_out, n)."""
        size = 4 * self._shape[0] * self._shape[1]
        if size == 0:
            return np.empty(self._shape, np.uint32)
        with self._lock:
            data = self._gpu.queue.read_buffer(self._buffers[1], 0, size)
        return np.frombuffer(data, np.uint32).reshape(self._shape)

    def release(self) -> None:
        """Give the device's memory back."""
        with self._lock:
            for resource in (*self._buffers, *self._textures):
                resource.destroy()


def _choose_adapter(wgpu: Any, wanted: str) -> Any:
    """The best adapter whose summary contains the wanted words; * and ? stand for anything in between."""
    try:
        adapters = list(wgpu.gpu.enumerate_adapters_sync())
    except Exception as error:
        raise TargetUnavailable(MISSING_DRIVER.format(reason=first_line(error))) from error
    if not adapters:
        raise TargetUnavailable(MISSING_DRIVER.format(reason="the list of adapters is empty"))
    fitting = [adapter for adapter in adapters if fits(wanted, adapter.summary)]
    if not fitting:
        names = "; ".join(adapter.summary for adapter in adapters)
        raise TargetUnavailable(f"{ADAPTER_VARIABLE}={wanted} names no WebGPU adapter; here are: {names}")
    return min(fitting, key=_rank)


def _rank(adapter: Any) -> tuple[int, int]:
    """Smaller is better."""
    backend, kind = adapter.info["backend_type"], adapter.info["adapter_type"]
    return _position(PREFERRED_BACKENDS, backend), _position(PREFERRED_KINDS, kind)


def _position(order: tuple[str, ...], name: str) -> int:
    return order.index(name) if name in order else len(order)


def _describe(adapter: Any) -> Device:
    info = adapter.info
    return Device(
        target="wgsl",
        api=f"WebGPU (wgpu {version('wgpu')}) on {info['backend_type']}",
        driver=info["description"] or info["vendor"] or info["backend_type"],
        device=info["device"] or adapter.summary,
    )
