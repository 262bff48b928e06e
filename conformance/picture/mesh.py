"""A triangle mesh with smooth vertex normals, read with trimesh."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import trimesh

from codegen.errors import UserError

Doubles = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Mesh:
    """Triangles of a surface: `triangles` (F, 3) vertex numbers, `positions` and unit `normals` (V, 3)."""

    positions: Doubles
    triangles: npt.NDArray[np.int64]
    normals: Doubles

    @property
    def size(self) -> float:
        """Length of the diagonal of the bounding box."""
        return float(np.linalg.norm(np.ptp(self.positions, axis=0)))


def read_mesh(path: Path, subdivide: int = 0) -> Mesh:
    """Read a mesh file; `subdivide` times Loop subdivision rounds a coarse mesh off."""
    if not path.is_file():
        raise UserError(f"{path}: there is no such mesh file")
    try:
        loaded = trimesh.load_mesh(str(path), process=False)
    except Exception as error:  # trimesh raises whatever its many format readers raise
        raise UserError(f"{path}: cannot be read as a mesh ({_first_line(error)})") from error
    if not isinstance(loaded, trimesh.Trimesh) or len(loaded.faces) == 0:
        raise UserError(f"{path}: holds no triangles")
    if not np.isfinite(loaded.vertices).all():
        raise UserError(f"{path}: has a vertex that is not finite")
    loaded.merge_vertices(merge_tex=True, merge_norm=True)  # one normal per place
    return smooth(loaded.subdivide_loop(subdivide) if subdivide else loaded)


def smooth(surface: trimesh.Trimesh) -> Mesh:
    """The mesh with vertex normals that average the faces around a vertex by their angle there."""
    return Mesh(
        positions=np.array(surface.vertices, dtype=np.float64),
        triangles=np.array(surface.faces, dtype=np.int64),
        normals=np.array(surface.vertex_normals, dtype=np.float64),
    )


def _first_line(error: Exception) -> str:
    text = str(error).strip()
    return text.splitlines()[0] if text else type(error).__name__
