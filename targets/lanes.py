"""How lanes are cut into chunks that every device's buffers and dispatches can hold."""

from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np

from targets.protocol import Prepared
from targets.textures import TextureData
from targets.words import Words

GROUP_LANES = 64
"""Lanes in a work group; the harness of every target is written for it."""

MAX_GROUPS = 65535
"""Work groups in one dimension of a dispatch: the least that OpenGL, Vulkan and WebGPU promise."""

CHUNK_BYTES = 96 << 20
"""Largest buffer in use; below the 128 MiB that WebGPU promises for a storage binding."""

UNIFORM_BYTES = 16384
"""Size of an input in uniform memory: the least that OpenGL, Vulkan and WebGPU promise for a block."""

UNWRITTEN = 0xDEADDEAD
"""Fills an output before a launch, so that a word that was never written shows."""


def check_words(words: Words, slots_out: int) -> None:
    """Refuse input that is not (slots_in, n) words; raises ValueError."""
    if words.dtype != np.uint32 or words.ndim != 2:
        raise ValueError(
            f"words are uint32 of shape (slots, lanes), not {words.dtype} of shape {words.shape}"
        )
    if slots_out < 1:
        raise ValueError(f"a program writes at least one word per lane, not {slots_out}")


def chunk_lanes(slots_in: int, slots_out: int, chunk_bytes: int) -> int:
    """Largest number of lanes in a chunk: whole work groups whose buffers stay within chunk_bytes."""
    lanes = chunk_bytes // (4 * max(slots_in, slots_out))
    groups = min(max(lanes // GROUP_LANES, 1), MAX_GROUPS)
    return groups * GROUP_LANES


def padded(words: Words) -> Words:
    """The words of a chunk, flat, at the fixed size of an input in uniform memory."""
    block = np.zeros(UNIFORM_BYTES // 4, np.uint32)
    block[: words.size] = words.ravel()
    return block


def group_count(lanes: int) -> int:
    """Work groups that cover the lanes."""
    return -(-lanes // GROUP_LANES)


class ChunkedRuntime(ABC):
    """A runtime that runs any number of lanes, one chunk after the other; see targets.protocol.Runtime.

    chunk_bytes  the largest buffer of words that the device takes
    """

    chunk_bytes: int

    @abstractmethod
    def prepare(
        self, program: str, words: Words, slots_out: int, textures: Sequence[TextureData] = ()
    ) -> Prepared:
        """Build a program and upload one chunk of lanes; see targets.protocol.TimedRuntime."""

    def run(self, program: str, words: Words, slots_out: int, textures: Sequence[TextureData] = ()) -> Words:
        """Run a program once per lane; no lanes launch nothing. See targets.protocol.Runtime."""
        check_words(words, slots_out)
        count = words.shape[1]
        results = np.empty((slots_out, count), np.uint32)
        step = chunk_lanes(words.shape[0], slots_out, self.chunk_bytes)
        for start in range(0, count, step):
            chunk = slice(start, min(start + step, count))
            prepared = self.prepare(program, words[:, chunk], slots_out, textures)
            try:
                prepared.launch()
                results[:, chunk] = prepared.read()
            finally:
                prepared.release()
        return results
