"""The triangles of a mesh file, as they are there, read with trimesh.

What a file announces is held against limits before anything of that size is made, and what it refers to is
read only where that is a plain file in its folder or below it.
"""

from __future__ import annotations

import json
import logging
import re
import struct
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from codegen.errors import UserError

if TYPE_CHECKING:
    import trimesh

FORMATS = (".obj", ".ply", ".gltf", ".glb", ".stl", ".off")
"""Archives are not among them: a small one may hold files of any size."""
LARGEST_FILE = 1 << 29
"""Bytes; a text file of a million triangles has a fifth of that."""
MOST_ITEMS = 1 << 24
"""Vertices and indices of all parts of a glTF file, which may name the same ones in each."""
MOST_NODES = 1 << 14
"""Of a glTF file: trimesh takes a fifth of a millisecond for each."""
MOST_PARTS = 1 << 11
"""Materials of an OBJ file, meshes and copies of a glTF file: trimesh takes a millisecond or two for each."""
_MATERIAL = re.compile(rb"^\s*usemtl\b.*$", re.MULTILINE)
_GLTF_HEADER = 20
"""Bytes before the description in a binary glTF file; its length are the four at 12."""
_SILENT = logging.NullHandler()


def load_mesh(path: Path) -> trimesh.Trimesh:
    """The triangles of a mesh file, as they are there; raises UserError for a file that holds none."""
    mesh_package: Any = require_trimesh()
    if not path.is_file():
        what = "is a folder, not a mesh file" if path.is_dir() else "there is no such mesh file"
        raise UserError(f"{path}: {what}")
    if path.stat().st_size > LARGEST_FILE:
        raise UserError(f"{path}: is larger than {LARGEST_FILE >> 20} MiB; simplify the mesh first")
    if path.suffix.lower() not in FORMATS:
        raise UserError(f"{path}: cannot be read as a mesh (its name ends in none of {', '.join(FORMATS)})")
    try:
        _check_announced(path)
        beside = _Beside(path.parent)
        scene = mesh_package.load_scene(str(path), resolver=beside, skip_materials=True, process=False)
        _check_scene(scene)
        loaded = scene.to_mesh()
    except Exception as error:  # trimesh raises whatever its many format readers raise
        raise UserError(f"{path}: cannot be read as a mesh ({_reason(error)})") from error
    if not isinstance(loaded, mesh_package.Trimesh) or len(loaded.faces) == 0:
        raise UserError(f"{path}: holds no triangles")
    if loaded.vertices.shape[1] != 3:
        raise UserError(f"{path}: its vertices are not of three coordinates")
    if not np.isfinite(loaded.vertices).all():
        raise UserError(f"{path}: has a vertex that is not finite")
    if not ((loaded.faces >= 0) & (loaded.faces < len(loaded.vertices))).all():
        raise UserError(f"{path}: has a face with a vertex that is not there")
    mesh: trimesh.Trimesh = loaded
    return mesh


def require_trimesh() -> Any:
    """The package trimesh; raises UserError where it is not installed."""
    try:
        import trimesh
    except ImportError:
        raise UserError("meshes need the package trimesh; install vair[render]") from None
    # Without a handler Python prints what it logs; what matters of it becomes a sentence.
    logging.getLogger("trimesh").addHandler(_SILENT)
    return trimesh


class _Beside(Mapping[str, bytes]):
    """The files that a mesh file may refer to, by the names that it uses."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def __getitem__(self, name: str) -> bytes:
        path = self._folder / name
        if not path.resolve().is_relative_to(self._folder.resolve()):
            raise ValueError(f"it refers to {name}, which lies outside of its folder")
        if not path.is_file():
            raise ValueError(f"it refers to a file that is not there, {name}")
        if path.stat().st_size > LARGEST_FILE:
            raise ValueError(f"it refers to {name}, which is larger than {LARGEST_FILE >> 20} MiB")
        return path.read_bytes()

    def __iter__(self) -> Iterator[str]:
        return iter(())

    def __len__(self) -> int:
        return 0


def _check_announced(path: Path) -> None:
    """Refuse what would take minutes or more memory than there is; leave what is wrong to trimesh."""
    nodes = parts = items = 0
    match path.suffix.lower():
        case ".obj":
            parts = len(set(_MATERIAL.findall(path.read_bytes())))
        case ".gltf" | ".glb":
            with suppress(ValueError, TypeError, LookupError, AttributeError, struct.error):
                nodes, parts, items = _announced(json.loads(_description(path)))
    if nodes > MOST_NODES:
        raise ValueError(f"it has {nodes} nodes, more than {MOST_NODES}; join them first")
    _check_parts(parts)
    if items > MOST_ITEMS:
        raise ValueError(f"its parts have {items:.3g} vertices and indices, more than {MOST_ITEMS}")


def _announced(about: Any) -> tuple[int, int, int]:
    """Nodes, parts, and vertices and indices of all parts, of the description of a glTF file."""
    parts = [part for mesh in about["meshes"] for part in mesh["primitives"]]
    used = [k for part in parts for k in (part["attributes"]["POSITION"], part.get("indices"))]
    items = sum(about["accessors"][k]["count"] for k in used if k is not None)
    return len(about["nodes"]), len(parts), int(items)


def _description(path: Path) -> bytes:
    """The JSON of a glTF file; nothing of other files."""
    match path.suffix.lower():
        case ".gltf":
            return path.read_bytes()
        case ".glb":
            with path.open("rb") as file:
                (length,) = struct.unpack_from("<I", file.read(_GLTF_HEADER), 12)
                return file.read(length)
    return b""


def _check_scene(scene: Any) -> None:
    """Refuse a scene that puts too much together."""
    names = [scene.graph[node][1] for node in scene.graph.nodes_geometry]
    _check_parts(len(names))
    sizes = {name: len(getattr(part, "faces", ())) for name, part in scene.geometry.items()}
    if sum(sizes[name] for name in names) > MOST_ITEMS:
        raise ValueError(f"its parts have more than {MOST_ITEMS} triangles together")


def _check_parts(count: int) -> None:
    if count > MOST_PARTS:
        raise ValueError(f"it is put together of {count} parts, more than {MOST_PARTS}; join them first")


def _reason(error: Exception) -> str:
    """What a reader of some format means, as the end of a sentence."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    match error:
        case KeyError():
            return f'it lacks "{error.args[0]}"'
        case FileNotFoundError():
            return f"it refers to a file that is not there, {error.filename or lines[0]}"
        case OSError():
            return error.strerror or type(error).__name__
        case ImportError():  # of a package that guesses encodings
            return "its text is in no known encoding"
    return lines[0].rstrip(".") if lines else "its parts contradict each other"
