"""Draws a brushed sphere with OpenCL: `python examples/hosts/opencl/opencl_sphere.py -o sphere.png`.

OpenCL C has #include: the compiler is told the library's folder, and nothing is joined by hand.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image

HERE = Path(__file__).parent
LIBRARY = HERE.parents[2] / "targets" / "opencl" / "include"
SIDE = 256


def draw(library: Path) -> npt.NDArray[np.uint8]:
    """Pixels (SIDE, SIDE, 4), top row first; `library` is the folder of vair-1.2.cl."""
    import pyopencl

    device = pyopencl.get_platforms()[0].get_devices()[0]
    context = pyopencl.Context([device])
    queue = pyopencl.CommandQueue(context)
    source = (HERE / "sphere.cl").read_text(encoding="utf-8")
    program = pyopencl.Program(context, source).build(["-cl-std=CL1.2", "-I", str(library)])
    pixels = np.empty((SIDE, SIDE, 4), np.uint8)
    buffer = pyopencl.Buffer(context, pyopencl.mem_flags.WRITE_ONLY, pixels.nbytes)
    pyopencl.Kernel(program, "sphere")(queue, (SIDE, SIDE), None, buffer, np.int32(SIDE))
    pyopencl.enqueue_copy(queue, pixels, buffer)
    return pixels


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Draws a brushed sphere with OpenCL.")
    parser.add_argument("-o", "--output", type=Path, default=Path("sphere.png"))
    parser.add_argument("--library", type=Path, default=LIBRARY, help="folder of vair-1.2.cl")
    words = parser.parse_args()
    Image.fromarray(draw(words.library)).convert("RGB").save(words.output)
