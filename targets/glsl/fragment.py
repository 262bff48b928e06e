"""Runs GLSL programs of the form "fragment": one fragment of a frame that nobody sees is one lane.

Drivers compile fragments apart from compute: other denormals, other vector code, OpenGL 3.3 will do.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from targets.glsl.compute import GlslRuntime
from targets.lanes import UNWRITTEN, check_words
from targets.protocol import Prepared
from targets.textures import TextureData
from targets.words import Words

ROW_LANES = 1024
"""Lanes in a row of the frame, as harness.frag counts them."""

FRAGMENT_CHUNK_BYTES = 16 << 20
"""Keeps the input below 4096 + slots rows; OpenGL 3.3 promises textures of 1024, its drivers hold 8192."""

ATTACHMENT_WORDS = 4
MAX_ATTACHMENTS = 8

WHOLE_FRAME = """#version 330
void main()
{
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(4.0 * corner - 1.0, 0.0, 1.0);
}
"""
"""One triangle that covers the frame."""


class GlslFragmentRuntime(GlslRuntime):
    """OpenGL's fragment stage."""

    def __init__(self, moderngl: Any, require: int) -> None:
        super().__init__(moderngl, require)
        self.chunk_bytes = FRAGMENT_CHUNK_BYTES
        # moderngl binds again what was bound before, so a frame must not be in use when it is deleted.
        self.idle_frame = self.on_thread(self._context.simple_framebuffer, (1, 1))

    def prepare(
        self, program: str, words: Words, slots_out: int, textures: Sequence[TextureData] = ()
    ) -> Prepared:
        """Build a program and upload its input; see targets.protocol.TimedRuntime."""
        check_words(words, slots_out)
        if textures:
            raise ValueError("no harness of fragments has maps")
        if slots_out > ATTACHMENT_WORDS * MAX_ATTACHMENTS:
            raise ValueError(f"a fragment writes at most {ATTACHMENT_WORDS * MAX_ATTACHMENTS} words")
        shader = self.on_thread(self._build, program)
        return self.on_thread(GlslFragmentPrepared, self, self._context, shader, words, slots_out)

    def _compile(self, program: str) -> Any:
        return self._context.program(vertex_shader=WHOLE_FRAME, fragment_shader=program)


class GlslFragmentPrepared:
    """A program with its input texture and its frame. Constructed on the thread of the context."""

    def __init__(
        self, runtime: GlslFragmentRuntime, context: Any, shader: Any, words: Words, slots_out: int
    ) -> None:
        slots_in, lanes = words.shape
        self._runtime = runtime
        self._context = context
        self._shader = shader
        self._shape = (slots_out, lanes)
        self._rows = max(-(-lanes // ROW_LANES), 1)
        source = np.zeros((max(slots_in, 1), self._rows * ROW_LANES), np.uint32)
        source[:slots_in, :lanes] = words
        self._source = self._texture(1, len(source) * self._rows, source)
        blank = np.full((self._rows * ROW_LANES, ATTACHMENT_WORDS), UNWRITTEN, np.uint32)
        count = -(-slots_out // ATTACHMENT_WORDS)
        self._attachments = [self._texture(ATTACHMENT_WORDS, self._rows, blank) for _ in range(count)]
        self._frame = context.framebuffer(color_attachments=self._attachments)
        self._triangle = context.vertex_array(shader, [])

    def launch(self) -> None:
        """Run the program over all lanes and wait until it is done."""
        self._runtime.on_thread(self._launch)

    def read(self) -> Words:
        """The output words, (slots_out, n)."""
        slots_out, lanes = self._shape
        parts = [
            np.frombuffer(self._runtime.on_thread(texture.read), np.uint32).reshape(-1, ATTACHMENT_WORDS)
            for texture in self._attachments
        ]
        return np.ascontiguousarray(np.concatenate(parts, axis=1)[:lanes, :slots_out].T)

    def release(self) -> None:
        """Give the device's memory back."""
        self._runtime.on_thread(self._runtime.idle_frame.use)
        for part in (self._triangle, self._frame, self._source, *self._attachments):
            self._runtime.on_thread(part.release)

    def _texture(self, components: int, rows: int, words: Words) -> Any:
        texture = self._context.texture((ROW_LANES, rows), components, words.tobytes(), dtype="u4")
        texture.filter = (self._context.NEAREST, self._context.NEAREST)
        return texture

    def _launch(self) -> None:
        if self._shape[1] == 0:
            return
        self._frame.use()
        self._source.use(0)
        # A program that reads no input has neither of the two.
        for name, value in (("harness_words_in", 0), ("harness_rows", self._rows)):
            if name in self._shader:
                self._shader[name] = value
        self._triangle.render(self._context.TRIANGLES, vertices=3)
        self._context.finish()
        self._runtime.raise_error()
