"""Shadows that the body casts on its own coat: rays from the tips of the hairs at every vertex, once.

What the rays find is an attribute of the vertices, so rasterisers and rays interpolate the same shadows and
no target has to draw a map of depths. Shadows are as soft as the mesh is coarse; the coat hides harder edges
anyway. They hold for lights that keep still with respect to the body.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import trimesh
from trimesh.ray.ray_pyembree import RayMeshIntersector

from codegen.fur.coat import FurMesh
from codegen.fur.layout import LIT
from codegen.maps.radiance import LUMINANCE
from conformance.picture.scene import Light
from conformance.picture.vectors import unit

Doubles = npt.NDArray[np.float64]

OWN = LIT[2] - 1
"""Lights whose shadows are kept apart; all others share one."""
LIFT = 1e-3
"""Of the mesh's size: rays start at least so far off the skin, where a coat is shorter."""
HALF_ANGLE = 0.08
"""Radians: a listed light is a disc of this radius, so that shadows have no steps from vertex to vertex."""
RAYS_TO_DISC = 12


def with_shadows(mesh: FurMesh, lights: Sequence[Light], coat_length: float) -> FurMesh:
    """The mesh with the attribute `lit`: shares in [0, 1] of the lights that arrive at every vertex.

    A ray starts at the tip of an upright hair, so that the skin below it does not shadow its own coat.
    """
    tips, where = _tips(mesh, coat_length)
    corners = mesh.vertices["position"].astype(np.float64)
    rays = RayMeshIntersector(trimesh.Trimesh(corners, mesh.triangles, process=False))
    shares = np.ones((len(tips), OWN + 1))
    for k, light in enumerate(lights[:OWN]):
        shares[:, k] = np.mean([_free(rays, tips, towards) for towards in disc(light.direction)], axis=0)
    others = lights[OWN:]
    weights = np.array([max(float(np.dot(LUMINANCE, light.colour)), 0.0) for light in others])
    if weights.sum() > 0.0:
        free = np.array(
            [_free(rays, tips, unit(np.asarray(light.direction, np.float64))) for light in others]
        )
        shares[:, OWN] = weights @ free / weights.sum()
    count = len(mesh.vertices)
    return replace(
        mesh,
        vertices=_extended(mesh.vertices, shares[where[:count]]),
        fin_vertices=_extended(mesh.fin_vertices, shares[where[count:]]),
    )


def disc(direction: Sequence[float]) -> Doubles:
    """Unit directions (RAYS_TO_DISC, 3) spread evenly over the disc of a light."""
    towards = unit(np.asarray(direction, np.float64))
    side = unit(np.cross(towards, np.eye(3)[np.argmin(np.abs(towards))]))
    up = np.cross(towards, side)
    # Vogel's spiral: equal areas, turned by the golden angle.
    number = np.arange(RAYS_TO_DISC)
    radius = HALF_ANGLE * np.sqrt((number + 0.5) / RAYS_TO_DISC)
    turn = number * np.pi * (3.0 - np.sqrt(5.0))
    spread = (radius * np.cos(turn))[:, None] * side + (radius * np.sin(turn))[:, None] * up
    return unit(towards + spread)


def _tips(mesh: FurMesh, coat_length: float) -> tuple[Doubles, npt.NDArray[np.int64]]:
    """Where rays start (N, 3), each place once; the number of its start for every vertex and fin vertex."""
    starts = []
    for vertices in (mesh.vertices, mesh.fin_vertices):
        size = float(np.ptp(mesh.vertices["position"], axis=0).max())
        lift = np.maximum(coat_length * vertices["length_share"].astype(np.float64), LIFT * size)
        starts.append(vertices["position"].astype(np.float64) + lift[:, None] * vertices["normal"])
    tips, where = np.unique(np.concatenate(starts), axis=0, return_inverse=True)
    return tips, where.reshape(-1)


def _free(rays: RayMeshIntersector, origins: Doubles, towards: Doubles) -> Doubles:
    """1 (N,) where nothing lies between the origins and infinity, 0 elsewhere."""
    directions = np.broadcast_to(towards, origins.shape)
    # trimesh annotates most of its methods, this one not.
    hidden: Any = rays.intersects_any(origins, directions)  # type: ignore[no-untyped-call]
    return np.asarray(~hidden, np.float64)


def _extended(vertices: npt.NDArray[Any], shares: Doubles) -> npt.NDArray[Any]:
    """The vertices with the attribute behind all others, or in the place of an older one."""
    names = [name for name in vertices.dtype.names or () if name != LIT[0]]
    result = np.empty(len(vertices), [*((name, vertices.dtype[name]) for name in names), LIT])
    for name in names:
        result[name] = vertices[name]
    result[LIT[0]] = shares
    return result
