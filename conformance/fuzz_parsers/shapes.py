"""Shapes: meshes and strands of hair."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

from codegen.fur.surface import read_surface
from codegen.strands.tfx import read_strands, tfx
from conformance.fuzz_parsers.parser import Parser


def mesh() -> Parser:
    """A mesh as .obj, welded and given normals, as `vair fur` and `vair render` read it."""
    box = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\n"
    seeds = (
        box + "f 1 2 3\nf 1 3 4\nf 1/1/1 2/1/1 4/1/1\nf 2 3 4\n",
        box + "g one\nusemtl a\nf 1 2 3 4\ns off\no two\nf -1 -2 -3\n",
        "# nothing\nmtllib x.mtl\nv 0 0\nf 1 2\n",
    )
    return Parser("own.obj", read_surface, tuple(seed.encode() for seed in seeds))


def mesh_ply() -> Parser:
    """A mesh as .ply with colours that paint it."""

    def read(path: Path) -> object:
        return read_surface(path, ("red", "green"))

    head = "ply\nformat {} 1.0\nelement vertex 4\n" + "".join(f"property float {c}\n" for c in "xyz")
    head += "".join(f"property uchar {c}\n" for c in ("red", "green", "blue"))
    head += "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    plain = "".join(f"{x} {y} {z} 255 128 0\n" for x, y, z in corners) + "3 0 1 2\n3 0 2 3\n"
    packed = b"".join(struct.pack("<3f3B", *corner, 255, 128, 0) for corner in corners)
    packed += struct.pack("<B3iB3i", 3, 0, 1, 2, 3, 0, 2, 3)
    seeds = (head.format("ascii") + plain).encode(), head.format("binary_little_endian").encode() + packed
    return Parser("own.ply", read, seeds)


def strands() -> Parser:
    """Strands of hair as .tfx."""
    two = tfx(np.arange(18.0).reshape(2, 3, 3))
    return Parser("own.tfx", read_strands, (two, tfx(np.zeros((1, 2, 3))), two[:64]))
