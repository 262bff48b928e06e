"""A triangle mesh with smooth vertex normals, read with trimesh."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import trimesh

from codegen.fur.meshfile import load_mesh

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
    loaded = load_mesh(path)
    loaded.merge_vertices(merge_tex=True, merge_norm=True)  # one normal per place
    return smooth(loaded.subdivide_loop(subdivide) if subdivide else loaded)


def smooth(surface: trimesh.Trimesh) -> Mesh:
    """The mesh with vertex normals that average the faces around a vertex by their angle there."""
    return Mesh(
        positions=np.array(surface.vertices, dtype=np.float64),
        triangles=np.array(surface.faces, dtype=np.int64),
        normals=np.array(surface.vertex_normals, dtype=np.float64),
    )
