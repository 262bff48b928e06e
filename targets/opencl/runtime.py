"""Runs OpenCL C programs on an OpenCL device, PoCL's CPU by choice."""

import os
import re
import warnings
from collections.abc import Sequence
from pathlib import Path
from threading import RLock
from typing import Any

import numpy as np

from targets.lanes import (
    CHUNK_BYTES,
    GROUP_LANES,
    UNIFORM_BYTES,
    UNWRITTEN,
    ChunkedRuntime,
    check_words,
    group_count,
)
from targets.opencl import packed_levels
from targets.packages import first_line, fits, require_package
from targets.programs import Programs
from targets.protocol import BuildFailed, Device, TargetUnavailable
from targets.textures import TextureData
from targets.words import Words

DEVICE_VARIABLE = "VAIR_OPENCL_DEVICE"
HALF_EXTENSION = "cl_khr_fp16"
PREFERRED_PLATFORM = "Portable Computing Language"
MISSING_DRIVER = "no OpenCL device is here ({reason}): apt-get install pocl-opencl-icd"


def open_runtime(options: Sequence[str] = (), uniforms: bool = False) -> "OpenclRuntime":
    """Open the preferred device, or the one named by VAIR_OPENCL_DEVICE; raises TargetUnavailable.

    options   of the OpenCL compiler, for example ("-cl-std=CL1.2",)
    uniforms  whether the input is in constant memory, for programs of the form "uniform"
    """
    return OpenclRuntime(require_package("pyopencl"), options, UNIFORM_BYTES if uniforms else CHUNK_BYTES)


class OpenclRuntime(ChunkedRuntime):
    """OpenCL behind one lock; one queue in order."""

    def __init__(self, cl: Any, options: Sequence[str] = (), chunk_bytes: int = CHUNK_BYTES) -> None:
        self._cl = cl
        self._lock = RLock()
        self._options = tuple(options)
        self._programs: Programs[tuple[str, tuple[str, ...]], Any] = Programs()
        device = _choose_device(cl, os.environ.get(DEVICE_VARIABLE, ""))
        try:
            self._context = cl.Context([device])
            self._queue = cl.CommandQueue(self._context)
        except cl.Error as error:
            raise TargetUnavailable(MISSING_DRIVER.format(reason=first_line(error))) from error
        self.chunk_bytes = min(chunk_bytes, device.max_mem_alloc_size)
        self.half_arithmetic = HALF_EXTENSION in device.extensions.split()
        self.newest_language = _newest_language(cl, device)
        version, language = " ".join(device.version.split()[:2]), ".".join(map(str, self.newest_language))
        self.device = Device(
            target="opencl",
            api=f"{version}, OpenCL C up to {language}",
            driver=f"{device.platform.name.strip()} {device.driver_version.strip()}",
            device=device.name.strip(),
        )

    def prepare(
        self, program: str, words: Words, slots_out: int, textures: Sequence[TextureData] = ()
    ) -> "OpenclPrepared":
        """Build a program and upload its input; see targets.protocol.TimedRuntime."""
        check_words(words, slots_out)
        with self._lock:
            # A kernel holds its arguments, so every preparation has a kernel of its own. program.harness_main
            # would warn about repeated retrieval.
            kernel = self._cl.Kernel(self.build(program), "harness_main")
            return OpenclPrepared(self, kernel, words, slots_out, textures)

    def build(self, text: str, options: Sequence[str] | None = None) -> Any:
        """A built program; raises BuildFailed.

        options  of the OpenCL compiler; None: those of the runtime
        """
        chosen = self._options if options is None else tuple(options)
        with self._lock, warnings.catch_warnings():
            # A compiler that says something without failing is none of our concern here.
            warnings.simplefilter("ignore", self._cl.CompilerWarning)
            try:
                return self._programs.find(
                    (text, chosen), lambda: self._cl.Program(self._context, text).build(list(chosen))
                )
            except self._cl.RuntimeError as error:
                raise BuildFailed(_tidy_log(str(error))) from error


class OpenclPrepared:
    """A kernel with its buffers."""

    def __init__(
        self,
        runtime: OpenclRuntime,
        kernel: Any,
        words: Words,
        slots_out: int,
        textures: Sequence[TextureData] = (),
    ) -> None:
        self._lock = runtime._lock
        self._cl = runtime._cl
        self._queue = runtime._queue
        self._kernel = kernel
        self._shape = (slots_out, words.shape[1])
        # OpenCL refuses an empty buffer.
        source = np.ascontiguousarray(words) if words.size else np.zeros(1, np.uint32)
        blank = np.full(max(slots_out * words.shape[1], 1), UNWRITTEN, np.uint32)
        flags = self._cl.mem_flags
        copy = flags.COPY_HOST_PTR
        self._source = self._cl.Buffer(runtime._context, flags.READ_ONLY | copy, hostbuf=source)
        self._result = self._cl.Buffer(runtime._context, flags.READ_WRITE | copy, hostbuf=blank)
        self._images = [self._image(runtime, data) for data in textures]
        # Held here: a kernel does not keep its sampler alive.
        self._sampler = self._cl.Sampler(
            runtime._context, False, self._cl.addressing_mode.CLAMP_TO_EDGE, self._cl.filter_mode.LINEAR
        )
        maps = [
            argument
            for image, data in zip(self._images, textures, strict=True)
            for argument in (image, self._sampler, packed_levels.layout(data))
        ]
        kernel.set_args(self._source, self._result, np.uint32(words.shape[1]), *maps)

    def _image(self, runtime: OpenclRuntime, data: TextureData) -> Any:
        cl, texels = self._cl, packed_levels.packed(data)
        height, width = texels.shape[:2]
        form = cl.ImageFormat(cl.channel_order.RGBA, cl.channel_type.FLOAT)
        flags = cl.mem_flags.READ_ONLY | cl.mem_flags.COPY_HOST_PTR
        return cl.create_image(runtime._context, flags, form, shape=(width, height), hostbuf=texels)

    def launch(self) -> None:
        """Run the program over all lanes and wait until it is done."""
        lanes = self._shape[1]
        if lanes == 0:
            return
        with self._lock:
            # PoCL compiles a kernel anew for every local size: keep one.
            size = group_count(lanes) * GROUP_LANES
            self._cl.enqueue_nd_range_kernel(self._queue, self._kernel, (size,), (GROUP_LANES,))
            self._queue.finish()

    def read(self) -> Words:
        """The output words, (slots_out, n)."""
        words = np.empty(self._shape, np.uint32)
        if words.size:
            with self._lock:
                self._cl.enqueue_copy(self._queue, words, self._result)
        return words

    def release(self) -> None:
        """Give the device's memory back."""
        with self._lock:
            self._source.release()
            self._result.release()
            for image in self._images:
                image.release()


def _choose_device(cl: Any, wanted: str) -> Any:
    """The best device whose name, with its platform's, contains the wanted words: PoCL's CPU first."""
    try:
        devices = [device for platform in cl.get_platforms() for device in _devices(cl, platform)]
    except cl.Error as error:
        raise TargetUnavailable(MISSING_DRIVER.format(reason=first_line(error))) from error
    if not devices:
        raise TargetUnavailable(MISSING_DRIVER.format(reason="no platform has a device"))
    fitting = [device for device in devices if fits(wanted, _full_name(device))]
    if not fitting:
        names = "; ".join(map(_full_name, devices))
        raise TargetUnavailable(f"{DEVICE_VARIABLE}={wanted} names no OpenCL device; here are: {names}")

    def is_second_choice(device: Any) -> tuple[bool, bool]:
        is_cpu = bool(device.type & cl.device_type.CPU)
        return PREFERRED_PLATFORM not in device.platform.name, not is_cpu

    return min(fitting, key=is_second_choice)


def _devices(cl: Any, platform: Any) -> list[Any]:
    """Devices of a platform; a platform that is installed without any raises instead of listing none."""
    try:
        return list(platform.get_devices())
    except cl.Error:
        return []


def _newest_language(cl: Any, device: Any) -> tuple[int, int]:
    """Newest version of OpenCL C that a device compiles.

    From OpenCL 3.0 on a device lists its versions, 10 bits for the major and 10 for the minor number above
    12 bits of patch level; older devices name the newest one: "OpenCL C 1.2 vendor's words".
    """
    try:
        packed = [entry.version for entry in device.opencl_c_all_versions]
        return max((number >> 22, number >> 12 & 0x3FF) for number in packed)
    except (cl.Error, AttributeError, ValueError):
        major, minor = device.opencl_c_version.split()[2].split(".")[:2]
        return int(major), int(minor)


def _full_name(device: Any) -> str:
    platform = device.platform
    return f"{platform.name.strip()} {platform.version.strip()}: {device.name.strip()}"


def _tidy_log(log: str) -> str:
    """The compiler's own words, without addresses and temporary files.

    pyopencl keeps a copy of a text that failed, where the driver has no cache of its own; it is removed.
    """
    saved = re.search(r"\(source saved as (.+)\)", log)
    if saved:
        Path(saved.group(1)).unlink(missing_ok=True)
        log = log.replace(saved.group(0), "")
    log = re.sub(r"\n\(options: .*\)", "", log)
    log = re.sub(r"\A.*?\nBuild on <.*?>:\n", "", log, flags=re.DOTALL)
    return re.sub(r"[^\s<=]*tempfile_\w+\.cl", "program.cl", log).strip()
