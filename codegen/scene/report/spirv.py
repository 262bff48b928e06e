"""Instructions of a GLSL function in SPIR-V, as glslang writes it, without optimisation."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

TOOLS = ("glslangValidator", "glslang")
SECONDS = 20.0
MAGIC = 0x07230203
OP_NAME, OP_FUNCTION, OP_FUNCTION_END = 5, 54, 56


def glslang() -> str | None:
    """The compiler, where it is installed."""
    return next(filter(None, map(shutil.which, TOOLS)), None)


def instructions(library_text: str, prefix: str) -> int | None:
    """Instructions of all functions whose name starts with the prefix; None where glslang is not here.

    library_text  GLSL of the dialect vulkan450, without a #version line
    """
    tool = glslang()
    if tool is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        source, binary = Path(folder) / "scene.comp", Path(folder) / "scene.spv"
        source.write_text(
            f"#version 450\nlayout(local_size_x = 1) in;\n{library_text}\nvoid main() {{ }}\n",
            encoding="utf-8",
        )
        done = subprocess.run(
            [tool, "-V", "--keep-uncalled", "-o", str(binary), str(source)],
            capture_output=True,
            timeout=SECONDS,
            check=False,
        )
        if done.returncode != 0 or not binary.exists():
            return None
        return _count(np.fromfile(binary, np.uint32), prefix)


def _count(words: np.ndarray, prefix: str) -> int | None:
    if len(words) < 5 or words[0] != MAGIC:
        return None
    names: set[int] = set()
    total, inside, position = 0, False, 5
    while position < len(words):
        length, code = int(words[position]) >> 16, int(words[position]) & 0xFFFF
        if code == OP_NAME:
            text = (
                words[position + 2 : position + length]
                .tobytes()
                .split(b"\0", 1)[0]
                .decode("utf-8", "replace")
            )
            if text.startswith(prefix):
                names.add(int(words[position + 1]))
        elif code == OP_FUNCTION:
            inside = int(words[position + 2]) in names
        elif code == OP_FUNCTION_END:
            inside = False
        elif inside:
            total += 1
        position += max(length, 1)
    return total
