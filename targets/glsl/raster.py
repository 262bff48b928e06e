"""Draws triangles with OpenGL into a picture of floats."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from targets.glsl.compute import GlslRuntime
from targets.protocol import BuildFailed
from targets.raster import Draw, Picture, attributes

BLOCK = 0
FACTORS = {
    "src-alpha": "SRC_ALPHA",
    "one-minus-src-alpha": "ONE_MINUS_SRC_ALPHA",
    "one": "ONE",
    "zero": "ZERO",
}

_idle_frames: WeakKeyDictionary[GlslRuntime, Any] = WeakKeyDictionary()
"""What is bound between pictures: moderngl binds again what was bound before, so a frame must not be in use
when it is deleted."""


class GlslScene:
    """Draw calls in the context of a runtime; see targets.raster.Scene."""

    def __init__(
        self, runtime: GlslRuntime, draws: Sequence[Draw], size: tuple[int, int], bits: int = 16
    ) -> None:
        """Build the programs and upload the vertices; raises BuildFailed with the compiler's log.

        bits  of the picture's floats: 16 or 32
        """
        self._runtime = runtime
        self._draws = draws
        self._size = size
        self._type = {16: "f2", 32: "f4"}[bits]
        self._held: list[Any] = []
        runtime.on_thread(self._build)

    def draw(self, uniforms: bytes) -> Picture:
        """The picture; see targets.raster.Scene."""
        data = self._runtime.on_thread(self._draw, uniforms)
        width, height = self._size
        picture = np.frombuffer(data, self._type).reshape(height, width, 4).astype(np.float32)
        return np.ascontiguousarray(picture[::-1])

    def render(self, uniforms: bytes) -> None:
        """Draw and wait; see targets.raster.Scene."""
        self._runtime.on_thread(self._draw, uniforms, False)

    def release(self) -> None:
        """Give the device's memory back."""
        self._runtime.on_thread(self._release)

    def _hold(self, made: Any) -> Any:
        self._held.append(made)
        return made

    def _build(self) -> None:
        context = self._context = self._runtime._context
        if self._runtime not in _idle_frames:
            _idle_frames[self._runtime] = context.simple_framebuffer((1, 1))
        self._idle = _idle_frames[self._runtime]
        self._colour = self._hold(context.texture(self._size, 4, dtype=self._type))
        depth = self._hold(context.depth_renderbuffer(self._size))
        self._frame = self._hold(context.framebuffer([self._colour], depth))
        self._arrays = [self._array(draw) for draw in self._draws]
        self._idle.use()

    def _array(self, draw: Draw) -> Any:
        try:
            program = self._hold(
                self._context.program(vertex_shader=draw.vertex, fragment_shader=draw.fragment)
            )
        except Exception as error:  # moderngl.Error, of a package that is imported with the device
            raise BuildFailed(str(error).strip()) from error
        for member in program:
            if hasattr(program[member], "binding"):
                program[member].binding = BLOCK
        vertices = self._hold(self._context.buffer(np.ascontiguousarray(draw.vertices).tobytes()))
        indices = self._hold(self._context.buffer(np.ascontiguousarray(draw.triangles).tobytes()))
        # Attributes that a compiler dropped are skipped over.
        inside = [(name, floats, name in program) for name, floats, _ in attributes(draw.vertices)]
        form = " ".join(f"{floats}f" if used else f"{4 * floats}x" for _, floats, used in inside)
        names = [name for name, _, used in inside if used]
        return self._hold(self._context.vertex_array(program, [(vertices, form, *names)], indices))

    def _draw(self, uniforms: bytes, read: bool = True) -> bytes:
        context = self._context
        block = context.buffer(uniforms)
        block.bind_to_uniform_block(BLOCK)
        self._frame.use()
        self._frame.depth_mask = True
        self._frame.clear(0.0, 0.0, 0.0, 0.0)
        for draw, array in zip(self._draws, self._arrays, strict=True):
            self._apply(draw)
            array.render(context.TRIANGLES, instances=draw.instances)
        context.enable_only(context.NOTHING)
        self._frame.depth_mask = True
        data: bytes = self._colour.read() if read else b""
        context.finish()
        self._idle.use()
        block.release()
        self._runtime.raise_error()
        return data

    def _apply(self, draw: Draw) -> None:
        context, state = self._context, draw.state
        flags = context.DEPTH_TEST
        if state["blend"]:
            flags |= context.BLEND
            factors = [
                state["blend"][part][end] for part in ("colour", "alpha") for end in ("source", "destination")
            ]
            context.blend_func = tuple(getattr(context, FACTORS[factor]) for factor in factors)
        if state["cull"] != "none":
            flags |= context.CULL_FACE
            context.cull_face = state["cull"]
        context.enable_only(flags)
        context.depth_func = {"less-equal": "<=", "less": "<"}[state["depth_test"]]
        self._frame.depth_mask = state["depth_write"]

    def _release(self) -> None:
        self._idle.use()
        while self._held:
            self._held.pop().release()
