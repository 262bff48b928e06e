"""Runs GLSL programs as compute shaders, through an OpenGL context without a window."""

import weakref
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, ParamSpec, TypeVar

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
from targets.packages import first_line
from targets.programs import Programs
from targets.protocol import BuildFailed, Device, Prepared, TargetUnavailable
from targets.textures import TextureData
from targets.words import Words

REQUIRED_VERSION = 430
MISSING_DRIVER = "no OpenGL {need} driver answers through EGL ({reason}): apt-get install libegl1 libgl1"
SMALLEST_STORAGE_BLOCK = 16 << 20
"""Bytes of a storage block that every OpenGL driver has to hold."""

P = ParamSpec("P")
T = TypeVar("T")


class GlslRuntime(ChunkedRuntime):
    """OpenGL compute. All calls run on one thread, because a context is current on one thread only.

    That also keeps the context apart from any other context that a program makes current.
    """

    half_arithmetic = False
    """mediump of desktop GLSL is accepted and computed in full precision."""

    def __init__(self, moderngl: Any, require: int = REQUIRED_VERSION, uniforms: bool = False) -> None:
        self.chunk_bytes = UNIFORM_BYTES if uniforms else CHUNK_BYTES
        self.uniforms = uniforms
        self._require = require
        self._moderngl = moderngl
        self._thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix="opengl")
        self._programs: Programs[str, Any] = Programs()
        self._dropped: deque[Any] = deque()
        self._context, self.device = self.on_thread(self._open)

    def on_thread(self, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """Call a function on the thread of the context and wait for its result."""
        return self._thread.submit(function, *args, **kwargs).result()

    def prepare(
        self, program: str, words: Words, slots_out: int, textures: Sequence[TextureData] = ()
    ) -> Prepared:
        """Build a program and upload its input; see targets.protocol.TimedRuntime."""
        check_words(words, slots_out)
        shader = self.on_thread(self._build, program)
        return GlslPrepared(self, self._context, shader, words, slots_out, textures)

    @property
    def linear(self) -> tuple[int, int]:
        """Filters of a map: linear within and between levels."""
        return self._moderngl.LINEAR_MIPMAP_LINEAR, self._moderngl.LINEAR

    def raise_error(self) -> None:
        """Raise the context's error, if there is one. Asking clears it."""
        error = self._context.error
        if error != "GL_NO_ERROR":
            raise RuntimeError(f"OpenGL failed on {self.device.device}: {error}")

    def _open(self) -> tuple[Any, Device]:
        try:
            context = self._moderngl.create_standalone_context(backend="egl", require=self._require)
        except Exception as error:  # moderngl and glcontext raise bare Exception
            need = ".".join(map(str, divmod(self._require // 10, 10)))
            raise TargetUnavailable(MISSING_DRIVER.format(need=need, reason=first_line(error))) from error
        info = context.info
        # Contexts below 4.3 do not say how large a block may be.
        largest = info.get("GL_MAX_SHADER_STORAGE_BLOCK_SIZE", SMALLEST_STORAGE_BLOCK)
        self.chunk_bytes = min(self.chunk_bytes, largest)
        major, minor = divmod(context.version_code // 10, 10)
        return context, Device(
            target="glsl",
            api=f"OpenGL {major}.{minor}",
            driver=f"{info['GL_VENDOR']}: {info['GL_VERSION']}",
            device=info["GL_RENDERER"],
        )

    def _build(self, program: str) -> Any:
        while self._dropped:
            self._dropped.popleft().release()
        try:
            return self._programs.find(program, lambda: self._tracked(program))
        except self._moderngl.Error as error:
            raise BuildFailed(str(error).strip()) from error

    def _tracked(self, program: str) -> Any:
        """A program that is given back, on the context's thread, once nobody holds it any more."""
        shader = self._compile(program)
        weakref.finalize(shader, self._dropped.append, shader.mglo).atexit = False
        return shader

    def _compile(self, program: str) -> Any:
        return self._context.compute_shader(program)


class GlslPrepared:
    """A compute program with its buffers."""

    def __init__(
        self,
        runtime: GlslRuntime,
        context: Any,
        shader: Any,
        words: Words,
        slots_out: int,
        textures: Sequence[TextureData] = (),
    ) -> None:
        self._runtime = runtime
        self._context = context
        self._shader = shader
        self._shape = (slots_out, words.shape[1])
        # OpenGL refuses an empty buffer.
        source = np.ascontiguousarray(words) if words.size else np.zeros(1, np.uint32)
        if runtime.uniforms:
            source = padded(source)
        blank = np.full(max(slots_out * words.shape[1], 1), UNWRITTEN, np.uint32)
        self._source = runtime.on_thread(context.buffer, source)
        self._result = runtime.on_thread(context.buffer, blank)
        self._textures = [runtime.on_thread(self._texture, texture) for texture in textures]

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
        for texture in self._textures:
            self._runtime.on_thread(texture.release)

    def _texture(self, data: TextureData) -> Any:
        texture = self._context.texture(data.size, 4, dtype="f4")
        last = len(data.levels) - 1
        texture.build_mipmaps(0, last)
        for k, level in enumerate(data.levels):
            texture.write(np.ascontiguousarray(level), level=k)
        linear = self._runtime.linear
        texture.filter = linear
        texture.repeat_x, texture.repeat_y = data.repeat_u, data.repeat_v
        return texture

    def _launch(self) -> None:
        lanes = self._shape[1]
        if lanes == 0:
            return
        if self._runtime.uniforms:
            self._source.bind_to_uniform_block(0)
        else:
            self._source.bind_to_storage_buffer(0)
        self._result.bind_to_storage_buffer(1)
        for k, texture in enumerate(self._textures):
            texture.use(k)
        self._shader["harness_count"] = lanes
        self._shader.run(group_count(lanes))
        self._context.memory_barrier()
        self._context.finish()
        self._runtime.raise_error()
