"""Shapes: meshes and strands of hair."""

from __future__ import annotations

import base64
import json
import struct
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from codegen.fur.surface import read_surface
from codegen.strands.tfx import read_strands, tfx
from conformance.fuzz_parsers.parser import Parser, json_parser

_CORNERS = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_FACES = ((0, 1, 2), (0, 2, 3))


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
    plain = "".join(f"{x:g} {y:g} {z:g} 255 128 0\n" for x, y, z in _CORNERS) + "3 0 1 2\n3 0 2 3\n"
    packed = b"".join(struct.pack("<3f3B", *corner, 255, 128, 0) for corner in _CORNERS)
    packed += b"".join(struct.pack("<B3i", 3, *face) for face in _FACES)
    seeds = (head.format("ascii") + plain).encode(), head.format("binary_little_endian").encode() + packed
    return Parser("own.ply", read, seeds)


def mesh_gltf() -> Parser:
    """A mesh as .gltf: JSON, its numbers in a text of base64 or in a file beside it, which is there."""

    def read(path: Path) -> object:
        beside = path.with_name("own.bin")
        if not beside.exists():
            beside.write_bytes(_NUMBERS)
        return read_surface(path, ("red", "green"))

    inside = "data:application/octet-stream;base64," + base64.b64encode(_NUMBERS).decode()
    return json_parser("own.gltf", read, [_described({"uri": uri}) for uri in (inside, "own.bin")])


def mesh_glb() -> Parser:
    """The same as .glb: the description and its numbers in one binary file."""

    def read(path: Path) -> object:
        return read_surface(path, ("red", "green"))

    tree = _described({})
    return Parser("own.glb", read, (_binary_gltf(tree),), (tree,), _binary_gltf)


def mesh_stl() -> Parser:
    """A mesh as .stl, binary and as text."""
    corners = [[_CORNERS[k] for k in face] for face in _FACES]
    packed = bytes(80) + struct.pack("<I", len(_FACES))
    packed += b"".join(struct.pack("<12fH", 0.0, 0.0, 1.0, *a, *b, *c, 0) for a, b, c in corners)
    lines = ["solid own"]
    for face in corners:
        vertices = [f"vertex {x:g} {y:g} {z:g}" for x, y, z in face]
        lines += ["facet normal 0 0 1", "outer loop", *vertices, "endloop", "endfacet"]
    plain = "\n".join([*lines, "endsolid own", ""])
    return Parser("own.stl", read_surface, (packed, plain.encode()))


def mesh_off() -> Parser:
    """A mesh as .off."""
    rows = [f"{x:g} {y:g} {z:g}" for x, y, z in _CORNERS] + ["3 0 1 2", "4 0 1 2 3 255 0 0"]
    return Parser("own.off", read_surface, ("\n".join(["OFF", "4 2 0", *rows, ""]).encode(),))


def strands() -> Parser:
    """Strands of hair as .tfx."""
    two = tfx(np.arange(18.0).reshape(2, 3, 3))
    return Parser("own.tfx", read_strands, (two, tfx(np.zeros((1, 2, 3))), two[:64]))


_NUMBERS = (
    struct.pack("<12f", *(x for corner in _CORNERS for x in corner))
    + struct.pack("<6H", *(k for face in _FACES for k in face))
    + bytes((255, 128, 0, 255)) * 4
)
"""Places, faces and colours of a glTF file."""


def _described(buffer: dict[str, str]) -> dict[str, Any]:
    """The description of a glTF file whose numbers are in this buffer."""
    attributes = {"POSITION": 0, "COLOR_0": 2}
    starts = (0, 48, 60, len(_NUMBERS))
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "translation": [0.0, 1.0, 0.0]}, {"children": [2]}, {"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": 1, "mode": 4}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
            {"bufferView": 2, "componentType": 5121, "count": 4, "type": "VEC4", "normalized": True},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": start, "byteLength": end - start} for start, end in pairwise(starts)
        ],
        "buffers": [{"byteLength": len(_NUMBERS), **buffer}],
    }


def _binary_gltf(tree: Any) -> bytes:
    """A description and the numbers as a binary file."""
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(_NUMBERS), b"BIN\0") + _NUMBERS
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
