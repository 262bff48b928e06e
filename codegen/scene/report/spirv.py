"""Instructions of a GLSL function in SPIR-V, as glslang writes it, without optimisation."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

TOOLS = ("glslangValidator", "glslang")
STAGES = {"comp": "layout(local_size_x = 1) in;", "vert": "", "frag": ""}
"""Stage of a text, which names the file that the compiler writes, and what its shader begins with."""
SECONDS = 20.0
MAGIC = 0x07230203
OP_NAME, OP_FUNCTION, OP_FUNCTION_END = 5, 54, 56


def glslang() -> str | None:
    """The compiler, where it is installed."""
    return next(filter(None, map(shutil.which, TOOLS)), None)


class Counting:
    """Counts instructions beside other work. The compiler runs from the beginning on, once for all texts:
    most of its time goes by before it reads any."""

    def __init__(self, texts: Mapping[str, tuple[str, str]]) -> None:
        """Start the compiler, where there is one.

        texts  name -> GLSL of the dialect vulkan450 without a #version line, and what the names of those
               functions begin with that count
        """
        self.texts = texts
        tool = glslang()
        self._run = None if tool is None else _Run(tool, [text for text, _ in texts.values()])

    def results(self) -> dict[str, int | None]:
        """Instructions by name; None where glslang is not here or refuses the text."""
        if self._run is None:
            return dict.fromkeys(self.texts)
        modules = self._run.modules()
        if modules is None and len(self.texts) > 1:
            alone = [Counting({name: text}) for name, text in self.texts.items()]
            return {name: count for one in alone for name, count in one.results().items()}
        found = modules or [[]] * len(self.texts)
        pairs = zip(self.texts.items(), found, strict=True)
        return {name: _count(words, prefix) for (name, (_, prefix)), words in pairs}

    def close(self) -> None:
        """End the compiler, whether or not anything was asked."""
        if self._run is not None:
            self._run.close()


class _Run:
    """The compiler at work in a folder of its own, each text as a shader of another stage."""

    def __init__(self, tool: str, texts: Sequence[str]) -> None:
        self.folder = tempfile.TemporaryDirectory()
        self.stages = list(STAGES)[: len(texts)]
        for stage, text in zip(self.stages, texts, strict=True):
            whole = f"#version 450\n{STAGES[stage]}\n{text}\nvoid main() {{ }}\n"
            Path(self.folder.name, f"scene.{stage}").write_text(whole, encoding="utf-8")
        self.process = subprocess.Popen(
            [tool, "-V", "--keep-uncalled", *(f"scene.{stage}" for stage in self.stages)],
            cwd=self.folder.name,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def modules(self) -> list[list[int]] | None:
        """The words of each module; None where the compiler refused one, or took too long."""
        try:
            if self.process.wait(SECONDS) != 0:
                return None
            files = [Path(self.folder.name, f"{stage}.spv") for stage in self.stages]
            return [np.fromfile(file, np.uint32).tolist() for file in files]
        except (subprocess.TimeoutExpired, OSError):
            return None
        finally:
            self.close()

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        self.folder.cleanup()


def _count(words: Sequence[int], prefix: str) -> int | None:
    if len(words) < 5 or words[0] != MAGIC:
        return None
    names: set[int] = set()
    total, inside, position = 0, False, 5
    while position < len(words):
        length, code = words[position] >> 16, words[position] & 0xFFFF
        if code == OP_NAME:
            text = b"".join(word.to_bytes(4, "little") for word in words[position + 2 : position + length])
            if text.split(b"\0", 1)[0].decode("utf-8", "replace").startswith(prefix):
                names.add(words[position + 1])
        elif code == OP_FUNCTION:
            inside = words[position + 2] in names
        elif code == OP_FUNCTION_END:
            inside = False
        elif inside:
            total += 1
        position += max(length, 1)
    return total
