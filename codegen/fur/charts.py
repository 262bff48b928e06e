"""Texture coordinates for hairs: the surface cut into charts that lie flat with little stretch."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from codegen.errors import UserError
from codegen.fur.surface import Doubles, Surface

PACKED_SIZE = 256
"""Texels along a side for which charts are packed; nothing is drawn into them, so a few will do."""


@dataclass(frozen=True)
class Charts:
    """Where the corners of the triangles lie in the plane.

    uv     (F, 3, 2) in [0, 1]
    scale  units of the mesh per unit of uv
    count  number of charts
    """

    uv: Doubles
    scale: float
    count: int


def cut_charts(surface: Surface) -> Charts:
    """Charts of a surface, all to one scale. The same surface gives the same charts.

    A procedural coat needs no room between charts: each side of a cut has its own whole hairs.
    """
    atlas_package = _package()
    atlas = atlas_package.Atlas()
    atlas.add_mesh(
        surface.positions.astype(np.float32),
        surface.triangles.astype(np.uint32),
        surface.normals.astype(np.float32),
    )
    options = atlas_package.PackOptions()
    options.resolution, options.padding = PACKED_SIZE, 0
    atlas.generate(atlas_package.ChartOptions(), options)
    numbers, triangles, found = atlas[0]
    if not np.array_equal(numbers[triangles], surface.triangles):
        raise UserError("the mesh cannot be cut into charts; its triangles overlap in a degenerate way")
    side = np.array([atlas.width, atlas.height]) / max(atlas.width, atlas.height, 1)
    uv = np.asarray(found, np.float64)[triangles] * side
    flat = _areas(np.concatenate([uv, np.zeros((*uv.shape[:2], 1))], axis=2))
    curved = _areas(surface.positions[surface.triangles])
    scale = float(np.sqrt(curved.sum() / max(flat.sum(), 1e-12)))
    return Charts(uv, scale, int(atlas.chart_count))


def _areas(corners: Doubles) -> Doubles:
    """Twice the areas (F,) of triangles (F, 3, 3)."""
    areas: Doubles = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    return areas


def _package() -> Any:
    try:
        import xatlas
    except ImportError:
        raise UserError("charts of a mesh need the package xatlas; install vair[render]") from None
    return xatlas
