"""The visibility buffer: what every sample of a picture sees, as arrays that any backend can shade.

Geometry is done once, in float64, with Embree's rays; vectors are rounded to float32 and then
normalised in float32, as a renderer would, so that all backends shade exactly the same inputs.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
import trimesh
from trimesh.ray.ray_pyembree import RayMeshIntersector

from conformance.picture.brush import Brush, strand_field, strand_map
from conformance.picture.mesh import Mesh
from conformance.picture.vectors import dot, unit

Doubles = npt.NDArray[np.float64]
Singles = npt.NDArray[np.float32]

RAYS_AT_ONCE = 1 << 18
SHADOW_LIFT = 2e-3  # of the mesh's size: a shadow ray starts clear of the facets of a curved surface


@dataclass(frozen=True)
class Camera:
    """A pinhole: `field_of_view` is the vertical opening angle in degrees."""

    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    up: tuple[float, float, float] = (0.0, 1.0, 0.0)
    field_of_view: float = 30.0

    def directions(self, width: int, height: int) -> Doubles:
        """Unit directions (height * width, 3) through the centres of the samples, top row first."""
        forward = unit(np.subtract(self.target, self.eye).astype(np.float64))
        right = unit(np.cross(forward, self.up))
        up = np.cross(right, forward)
        half_height = np.tan(np.radians(self.field_of_view) / 2.0)
        half_width = half_height * width / height
        x = ((np.arange(width) + 0.5) / width * 2.0 - 1.0) * half_width
        y = (1.0 - (np.arange(height) + 0.5) / height * 2.0) * half_height
        towards = forward + x[None, :, None] * right + y[:, None, None] * up
        return unit(towards.reshape(-1, 3))


@dataclass(frozen=True)
class Visibility:
    """What the covered samples see; row i of every array belongs to the i-th True of `mask`.

    mask         (height, width) of the samples, True where the mesh is seen
    position     (N, 3) float64 points on the surface
    n, t         (N, 3) float32 unit normal, and unit tangent of the smooth strand field
    v            (N, 3) float32 unit direction to the eye
    map_tangent  (N, 3) float32 tangent of the single strand in the frame (T, B, n)
    l, lit       per light: (N, 3) float32 unit direction to it; (N,) float32 1 where nothing hides it
    """

    mask: npt.NDArray[np.bool_]
    position: Doubles
    n: Singles
    t: Singles
    v: Singles
    map_tangent: Singles
    l: list[Singles] = field(default_factory=list)
    lit: list[Singles] = field(default_factory=list)


def see(
    mesh: Mesh,
    camera: Camera,
    size: tuple[int, int],
    brush: Brush,
    towards_lights: list[tuple[float, float, float]],
    shadows: bool = True,
) -> Visibility:
    """Cast one ray through every sample of a picture of size (width, height)."""
    width, height = size
    rays = RayMeshIntersector(trimesh.Trimesh(mesh.positions, mesh.triangles, process=False))
    directions = camera.directions(width, height)
    eye = np.asarray(camera.eye, dtype=np.float64)
    triangle = np.empty(len(directions), dtype=np.int64)
    for start in range(0, len(directions), RAYS_AT_ONCE):
        rows = slice(start, start + RAYS_AT_ONCE)
        origins = np.broadcast_to(eye, directions[rows].shape)
        triangle[rows] = rays.intersects_first(origins, directions[rows])
    covered = triangle >= 0
    corners = mesh.triangles[triangle[covered]]
    weights = barycentric(mesh.positions[corners], eye, directions[covered])
    position = np.einsum("ijk,ij->ik", mesh.positions[corners], weights)
    n = _unit32(np.einsum("ijk,ij->ik", mesh.normals[corners], weights))
    lifted = position + SHADOW_LIFT * mesh.size * n.astype(np.float64)
    l, lit = [], []
    for towards in towards_lights:
        direction = np.broadcast_to(unit(np.asarray(towards, dtype=np.float64)), position.shape)
        hidden = _hidden(rays, lifted, direction) if shadows else np.zeros(len(position), dtype=bool)
        l.append(_unit32(direction))
        lit.append((~hidden).astype(np.float32))
    return Visibility(
        mask=covered.reshape(height, width),
        position=position,
        n=n,
        t=_unit32(strand_field(brush.axis, n)),
        v=_unit32(eye - position),
        map_tangent=strand_map(brush, position).astype(np.float32),
        l=l,
        lit=lit,
    )


def barycentric(corners: Doubles, eye: Doubles, directions: Doubles) -> Doubles:
    """Weights (N, 3) of the corners (N, 3, 3) where the rays from the eye meet the triangles."""
    edge_b, edge_c = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    plane = np.cross(edge_b, edge_c)
    distance = dot(corners[:, 0] - eye, plane) / dot(directions, plane)
    inside = eye + distance[:, None] * directions - corners[:, 0]
    area = dot(plane, plane)
    b = dot(np.cross(inside, edge_c), plane) / area
    c = dot(np.cross(edge_b, inside), plane) / area
    # Embree decides in float32: a hit on an edge may lie beside the triangle by a rounding.
    weights = np.clip(np.stack([1.0 - b - c, b, c], axis=1), 0.0, 1.0)
    result: Doubles = weights / weights.sum(axis=1, keepdims=True)
    return result


def _hidden(rays: RayMeshIntersector, origins: Doubles, directions: Doubles) -> npt.NDArray[np.bool_]:
    """Whether something lies between the origins (N, 3) and infinity."""
    found = np.zeros(len(origins), dtype=bool)
    for start in range(0, len(origins), RAYS_AT_ONCE):
        rows = slice(start, start + RAYS_AT_ONCE)
        # trimesh annotates most of its methods, this one not.
        found[rows] = rays.intersects_any(origins[rows], directions[rows])  # type: ignore[no-untyped-call]
    return found


def _unit32(a: npt.NDArray[np.floating]) -> Singles:
    return unit(a.astype(np.float32)).astype(np.float32)
