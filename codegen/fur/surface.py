"""A mesh file as a surface that can bear fur: welded, without degenerate faces, with a normal everywhere."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError
from codegen.fur.meshfile import load_mesh, require_trimesh

if TYPE_CHECKING:
    import trimesh

Doubles = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

MOST_TRIANGLES = 1 << 17
"""In a file: cutting more into charts takes minutes."""
MOST_SUBDIVIDED = 1 << 19
"""Drawn: the fins of more would not fit the 256 MiB that WebGPU promises for a buffer."""
FARTHEST = 1.0e3
"""Coordinates up to which shell_offset declares its error."""
FLATTEST = 1.0e-12
"""Twice the area of a face below which it counts as degenerate, as a share of the mesh's size squared."""


@dataclass(frozen=True)
class Surface:
    """Triangles that share vertices where they touch.

    positions  (V, 3)
    triangles  (F, 3) numbers of vertices
    normals    (V, 3) unit: the faces around a vertex, averaged by their angle there
    paint      (F, 3, 2) per corner: shares of length and of density, in [0, 1]
    findings   what was found in the file, counted by name; see README.md
    """

    positions: Doubles
    triangles: Integers
    normals: Doubles
    paint: Doubles
    findings: dict[str, int]

    @property
    def size(self) -> float:
        """Length of the diagonal of the bounding box."""
        return float(np.linalg.norm(np.ptp(self.positions, axis=0)))


def read_surface(path: Path, channels: tuple[str, str] = ("", "")) -> Surface:
    """Read a mesh that is to bear fur.

    path      of one of meshfile.FORMATS
    channels  vertex colours ("red", "green", "blue") that paint length and density; "": 1 everywhere
    errors    UserError for a file that is missing, unreadable, empty, huge or far away, and for colours
              that are asked for and missing
    """
    mesh = load_mesh(path)
    if len(mesh.faces) > MOST_TRIANGLES:
        raise UserError(
            f"{path}: has {len(mesh.faces)} triangles, more than {MOST_TRIANGLES}; simplify it first"
        )
    farthest = float(np.abs(mesh.vertices[mesh.faces]).max())
    if farthest > FARTHEST:
        raise UserError(
            f"{path}: reaches out to {farthest:g}; fur is drawn within {FARTHEST:g} units of the origin: "
            "scale the mesh"
        )
    given = len(mesh.vertices)
    colours = _paint(path, mesh, channels)
    # Adding 0 turns -0 into 0: one place, one vertex.
    welded, place = np.unique(mesh.vertices + 0.0, axis=0, return_inverse=True)
    faces = place.reshape(-1)[mesh.faces]
    kept = _sound(welded, faces)
    if not kept.any():
        raise UserError(f"{path}: all of its {len(faces)} triangles are degenerate")
    used, numbers = np.unique(faces[kept], return_inverse=True)
    surface = Surface(
        positions=np.ascontiguousarray(welded[used], np.float64),
        triangles=np.ascontiguousarray(numbers.reshape(-1, 3), np.int64),
        normals=np.empty((0, 3)),
        paint=colours[mesh.faces[kept]],
        findings={
            "triangles in the file": len(faces),
            "vertices in the file": given,
            "degenerate or doubled triangles left out": int((~kept).sum()),
        },
    )
    return with_normals(surface)


def with_normals(surface: Surface) -> Surface:
    """The surface with its normals computed; where faces cancel out, one of them decides."""
    mesh_package = require_trimesh()
    mesh = mesh_package.Trimesh(surface.positions, surface.triangles, process=False)
    normals = np.array(mesh.vertex_normals, dtype=np.float64)
    length = np.linalg.norm(normals, axis=1)
    bad = ~(np.abs(length - 1.0) < 0.5)
    if bad.any():
        first = np.full(len(normals), len(surface.triangles), np.int64)
        np.minimum.at(first, surface.triangles.reshape(-1), np.repeat(np.arange(len(surface.triangles)), 3))
        normals[bad] = face_normals(surface.positions, surface.triangles[first[bad]])
    findings = {**surface.findings, "vertices whose normals cancel": int(bad.sum())}
    return replace(surface, normals=_unit(normals), findings=findings)


def subdivided(surface: Surface, corners: Doubles, rounds: int) -> tuple[Surface, Doubles]:
    """Loop subdivision, with what the corners carry taken along linearly.

    corners  (F, 3, k) values at the corners of the triangles
    errors   UserError where an edge borders more than two triangles
    """
    mesh_package = require_trimesh()
    for _ in range(rounds):
        if 4 * len(surface.triangles) > MOST_SUBDIVIDED:
            raise UserError(f"subdivide = {rounds} makes more than {MOST_SUBDIVIDED} triangles")
        edges = np.sort(surface.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        if np.unique(edges, axis=0, return_counts=True)[1].max() > 2:
            raise UserError("a mesh with an edge between more than two triangles needs subdivide = 0")
        positions, triangles = mesh_package.remesh.subdivide_loop(surface.positions, surface.triangles, 1)
        surface = replace(
            surface,
            positions=np.asarray(positions, np.float64),
            triangles=np.asarray(triangles, np.int64),
            paint=_split(surface.paint),
        )
        corners = _split(corners)
    return (with_normals(surface) if rounds else surface), corners


def face_normals(positions: Doubles, triangles: Integers) -> Doubles:
    """Unit normals (F, 3) of the triangles."""
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    return _unit(np.cross(b - a, c - a))


def _split(corners: Doubles) -> Doubles:
    """Corner values (4 F, 3, k) of the triangles into which subdivide_loop splits (F, 3, k)."""
    a, b, c = (corners[:, k] for k in range(3))
    ab, bc, ca = (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0
    parts = [a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca]
    return np.stack(parts, axis=1).reshape(-1, 3, corners.shape[2])


def _sound(positions: Doubles, faces: Integers) -> npt.NDArray[np.bool_]:
    """Which faces (F,) have an area and are the first on their three vertices."""
    a, b, c = (positions[faces[:, k]] for k in range(3))
    size = np.linalg.norm(np.ptp(positions, axis=0))
    has_area = np.linalg.norm(np.cross(b - a, c - a), axis=1) > FLATTEST * size * size
    first = np.zeros(len(faces), dtype=bool)
    first[np.unique(np.sort(faces, axis=1), axis=0, return_index=True)[1]] = True
    sound: npt.NDArray[np.bool_] = has_area & first
    return sound


def _paint(path: Path, mesh: trimesh.Trimesh, channels: tuple[str, str]) -> Doubles:
    """Shares (V, 2) of length and density that vertex colours paint."""
    shares = np.ones((len(mesh.vertices), 2))
    for column, channel in enumerate(channels):
        if not channel:
            continue
        visual: Any = mesh.visual
        if visual.kind != "vertex":
            raise UserError(f"{path}: has no vertex colours, which are to paint the coat")
        shares[:, column] = visual.vertex_colors[:, ("red", "green", "blue").index(channel)] / 255.0
    return shares


def _unit(a: Doubles) -> Doubles:
    unit: Doubles = a / np.maximum(np.linalg.norm(a, axis=1, keepdims=True), 1e-300)
    return unit
