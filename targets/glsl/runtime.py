"""Runs GLSL compute programs on OpenGL 4.3 through a context without a window."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, ParamSpec, TypeVar

import numpy as np

from targets.lanes import CHUNK_BYTES, UNWRITTEN, check_words, group_count, run_in_chunks
from targets.packages import first_line, require_package
from targets.protocol import BuildFailed, Device, TargetUnavailable
from targets.words import Words

REQUIRED_VERSION = 430
MISSING_DRIVER = "no OpenGL 4.3 driver answers through EGL ({reason}): apt-get install libegl1 libgl1"

P = ParamSpec("P")
T = TypeVar("T")


def open_runtime() -> "GlslRuntime":
    """Open a context of its own; raises TargetUnavailable."""
    return GlslRuntime(require_package("moderngl"))


class GlslRuntime:
    """OpenGL compute. All calls run on one thread, because a context is current on one thread only.

    That also keeps the context apart from any other context that a program makes current.
    """

    def __init__(self, moderngl: Any, chunk_bytes: int = CHUNK_BYTES) -> None:
        self.chunk_bytes = chunk_bytes
        self._moderngl = moderngl
        self._thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix="opengl")
        self._programs: dict[str, Any] = {}
        self._context, self.device = self.on_thread(self._open)

    def on_thread(self, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """Call a function on the thread of the context and wait for its result."""
        return self._thread.submit(function, *args, **kwargs).result()

    def run(self, program: str, words: Words, slots_out: int) -> Words:
        """Run a program once per lane; see targets.protocol.Runtime."""
        return run_in_chunks(
            lambda chunk: self.prepare(program, chunk, slots_out), words, slots_out, self.chunk_bytes
        )

    def prepare(self, program: str, words: Words, slots_out: int) -> "GlslPrepared":
        """Build a program and upload its input; see targets.protocol.TimedRuntime."""
        check_words(words, slots_out)
        shader = self.on_thread(self._build, program)
        return GlslPrepared(self, self._context, shader, words, slots_out)

    def _open(self) -> tuple[Any, Device]:
        try:
            context = self._moderngl.create_standalone_context(backend="egl", require=REQUIRED_VERSION)
        except Exception as error:  # moderngl and glcontext raise bare Exception
            raise TargetUnavailable(MISSING_DRIVER.format(reason=first_line(error))) from error
        info = context.info
        # A block may be as small as 16 MiB by the specification.
        self.chunk_bytes = min(self.chunk_bytes, info["GL_MAX_SHADER_STORAGE_BLOCK_SIZE"])
        major, minor = divmod(context.version_code // 10, 10)
        return context, Device(
            target="glsl",
            api=f"OpenGL {major}.{minor}",
            driver=f"{info['GL_VENDOR']}: {info['GL_VERSION']}",
            device=info["GL_RENDERER"],
        )

    def _build(self, program: str) -> Any:
        if program not in self._programs:
            try:
                self._programs[program] = self._context.compute_shader(program)
            except self._moderngl.Error as error:
                raise BuildFailed(str(error).strip()) from error
        return self._programs[program]


class GlslPrepared:
    """A compute program with its buffers."""

    def __init__(self, runtime: GlslRuntime, context: Any, shader: Any, words: Words, slots_out: int) -> None:
        self._runtime = runtime
        self._context = context
        self._shader = shader
        self._shape = (slots_out, words.shape[1])
        # OpenGL refuses an empty buffer.
        source = np.ascontiguousarray(words) if words.size else np.zeros(1, np.uint32)
        blank = np.full(max(slots_out * words.shape[1], 1), UNWRITTEN, np.uint32)
        self._source = runtime.on_thread(context.buffer, source)
        self._result = runtime.on_thread(context.buffer, blank)

    def launch(self) -> None:
        """Run the program over all lanes and wait until it is done."""
        self._runtime.on_thread(self._launch)

    def read(self) -> Words:
        """The output words, (slots_out, n)."""
        data = self._runtime.on_thread(self._result.read, size=4 * self._shape[0] * self._shape[1])
        return np.frombuffer(data, np.uint32).reshape(self._shape)

    def release(self) -> None:
        """Give the device's memory back."""
        self._runtime.on_thread(self._source.release)
        self._runtime.on_thread(self._result.release)

    def _launch(self) -> None:
        lanes = self._shape[1]
        if lanes == 0:
            return
        self._source.bind_to_storage_buffer(0)
        self._result.bind_to_storage_buffer(1)
        self._shader["harness_count"] = lanes
        self._shader.run(group_count(lanes))
        self._context.memory_barrier()
        self._context.finish()
        if self._context.error != "GL_NO_ERROR":
            raise RuntimeError(f"OpenGL failed on {self._runtime.device.device}: {self._context.error}")
