"""The buffers of a furry mesh: vertices of base and shells, and the quads of the fins."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError
from codegen.fur.charts import cut_charts
from codegen.fur.edges import find_edges
from codegen.fur.layout import FIN_VERTEX, FUR_VERTEX
from codegen.fur.surface import Doubles, Surface, read_surface, subdivided

MOST_HAIRS = 4096
"""Hairs along a side of the unit square of texture coordinates, by shell_strand_mask."""
FIN_ROWS = 512
"""Rows of hairs that take turns on the edges, so that neighbours differ."""

Triple = tuple[float, float, float]
Numbers = npt.NDArray[np.uint32]
Vertices = npt.NDArray[Any]


@dataclass(frozen=True)
class Combing:
    """How a coat is combed: every hair leans towards `direction`, as far as the skin lets it.

    strength  how far where the direction lies in the skin; 1 leans the tips by 45 degrees
    """

    direction: Triple = (0.0, 0.0, 0.0)
    strength: float = 0.0


@dataclass(frozen=True)
class FurMesh:
    """What a host draws.

    vertices       (V,) of FUR_VERTEX; base and shells
    triangles      (F, 3)
    fin_vertices   (4 E,) of FIN_VERTEX
    fin_triangles  (2 E, 3)
    hairs          hairs per unit of texture coordinates
    findings       what was found in the mesh and made of it, counted by name
    """

    vertices: Vertices
    triangles: Numbers
    fin_vertices: Vertices
    fin_triangles: Numbers
    hairs: float
    findings: dict[str, int]


def grow(
    path: Path,
    spacing: float,
    combing: Combing | None = None,
    subdivide: int = 0,
    channels: tuple[str, str] = ("", ""),
) -> FurMesh:
    """Read a mesh file and prepare its fur.

    spacing    distance between hairs, in units of the mesh
    subdivide  rounds of Loop subdivision
    channels   vertex colours that paint length and density, "" for neither
    errors     UserError for a mesh or a spacing that no fur can be made of
    """
    surface = read_surface(path, channels)
    charts = cut_charts(surface)
    hairs = float(np.floor(charts.scale / spacing))
    if hairs > MOST_HAIRS:
        finest = charts.scale / MOST_HAIRS
        raise UserError(f"{path}: a spacing of {spacing:g} is too fine for this mesh; from {finest:.2g} on")
    try:
        surface, uv = subdivided(surface, charts.uv, subdivide)
    except UserError as error:
        raise UserError(f"{path}: {error}") from None
    comb = comb_field(surface.normals, combing or Combing())
    vertices, triangles = shell_buffers(surface, uv, comb)
    fins, border, crowded = fin_buffers(surface, comb, charts.scale)
    findings = {
        **surface.findings,
        "border edges": border,
        "edges between more than two triangles": crowded,
        "charts": charts.count,
        "vertices": len(vertices),
        "triangles": len(triangles),
        "fins": len(fins) // 4,
    }
    return FurMesh(vertices, triangles, fins, quads(len(fins) // 4), max(hairs, 1.0), findings)


def comb_field(normals: Doubles, combing: Combing) -> Doubles:
    """The comb vectors (V, 3): the direction without its part along the normal.

    Not normalised: where the direction meets the skin head-on the hairs part smoothly, and stand up.
    """
    towards = np.asarray(combing.direction, np.float64)
    towards = towards / max(float(np.linalg.norm(towards)), 1e-300)
    field: Doubles = combing.strength * (towards - (normals @ towards)[:, None] * normals)
    return field


def shell_buffers(surface: Surface, uv: Doubles, comb: Doubles) -> tuple[Vertices, Numbers]:
    """Vertices and triangles of base and shells; where charts meet, vertices differ in nothing but uv."""
    corners = np.empty(3 * len(surface.triangles), FUR_VERTEX)
    number = surface.triangles.reshape(-1)
    corners["position"] = surface.positions[number]
    corners["normal"] = surface.normals[number]
    corners["comb"] = comb[number]
    corners["uv"] = uv.reshape(-1, 2)
    paint = _vertex_paint(surface)[number]
    corners["length_share"], corners["density_share"] = paint[:, 0], paint[:, 1]
    key = np.column_stack([number.astype(np.float64), corners["uv"].astype(np.float64)])
    _, first, place = np.unique(key, axis=0, return_index=True, return_inverse=True)
    return corners[first], place.reshape(-1, 3).astype(np.uint32)


def fin_buffers(surface: Surface, comb: Doubles, scale: float) -> tuple[Vertices, int, int]:
    """Vertices of the fins, four to an edge A B: A at the skin, A and B at the tips, B at the skin.

    Their uv runs along the edge in the unit of the shells' uv, and names a row of hairs.
    """
    edges = find_edges(surface)
    ends = edges.vertices[:, [0, 0, 1, 1]]
    fins = np.empty(ends.shape, FIN_VERTEX)
    fins["position"], fins["normal"], fins["comb"] = (
        surface.positions[ends],
        surface.normals[ends],
        comb[ends],
    )
    along = surface.positions[edges.vertices[:, 1]] - surface.positions[edges.vertices[:, 0]]
    fins["uv"][:, :, 0] = np.linalg.norm(along, axis=1)[:, None] / scale * np.array([0.0, 0.0, 1.0, 1.0])
    fins["uv"][:, :, 1] = (np.arange(len(ends)) % FIN_ROWS)[:, None]
    paint = _vertex_paint(surface)[ends]
    fins["length_share"], fins["density_share"] = paint[..., 0], paint[..., 1]
    fins["face_a"], fins["face_b"] = edges.face_a[:, None], edges.face_b[:, None]
    fins["w"] = np.array([0.0, 1.0, 1.0, 0.0])
    return fins.reshape(-1), edges.border, edges.crowded


def quads(count: int) -> Numbers:
    """Triangles (2 count, 3) of quads whose vertices follow each other, with w 0, 1, 1 and 1, 0, 0."""
    first = 4 * np.arange(count, dtype=np.uint32)[:, None]
    return (first + np.array([0, 1, 2, 2, 3, 0], np.uint32)).reshape(-1, 3)


def _vertex_paint(surface: Surface) -> Doubles:
    """Painted shares (V, 2): the mean over the corners that share a vertex."""
    number = surface.triangles.reshape(-1)
    total = np.zeros((len(surface.positions), 2))
    np.add.at(total, number, surface.paint.reshape(-1, 2))
    shares: Doubles = total / np.maximum(np.bincount(number, minlength=len(total)), 1)[:, None]
    return shares
