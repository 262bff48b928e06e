"""Fur without a rasteriser: rays meet the same shells and fins, the library's functions run on any backend.

Embree finds where the ray of every sample meets every layer; positions of the layers, masks, lighting and
blending are functions of the library, run on OpenCL, another target or the evaluator. What a fixed-function
rasteriser does (interpolation, the depth test, the order of blending) is done here in float64.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import trimesh
from trimesh.ray.ray_pyembree import RayMeshIntersector

from conformance.picture.fur.studio import FurStudio
from conformance.picture.shade import Backend
from conformance.picture.stage_inputs import repeated, shading_inputs
from conformance.picture.vectors import dot, unit
from conformance.picture.visibility import barycentric

Doubles = npt.NDArray[np.float64]
Singles = npt.NDArray[np.float32]
Integers = npt.NDArray[np.int64]

MOST_HITS = 12
"""Of one ray with one layer; a bunny has four at most, between its ears."""
DEPTH_SLACK = 1e-6
"""Of the distance: a layer that touches the base passes the depth test."""
Varyings = dict[str, npt.NDArray[Any]]


@dataclass(frozen=True)
class Hits:
    """Where rays meet triangles: ray and triangle numbers, distance, weights of the corners (N, 3)."""

    ray: Integers
    triangle: Integers
    distance: Doubles
    weights: Doubles


class March:
    """One picture of a scene on one backend."""

    def __init__(self, studio: FurStudio, backend: Backend) -> None:
        self.studio = studio
        self.backend = backend
        width, height = studio.picture.samples
        self.eye = np.asarray(studio.picture.camera.eye, np.float64)
        self.directions = studio.picture.camera.directions(width, height)
        self.nearest = np.full(len(self.directions), np.inf)
        self.colour = np.zeros((len(self.directions), 3))
        self.coverage = np.zeros((len(self.directions), 3))

    def draw(self) -> Singles:
        """Premultiplied linear colour and coverage (height, width, 4), top row first."""
        fur, mesh = self.studio.fur, self.studio.mesh
        culled = mesh.findings["border edges"] == 0
        for layer in range(fur.layers):
            varyings = self._layer(layer)
            found = self._meet(varyings["position"], mesh.triangles, culled)
            if layer == 0:
                found = _first(found)
                self.nearest[found.ray] = found.distance
            self._blend(
                found, mesh.triangles, varyings, self._base_alpha if layer == 0 else self._shell_alpha
            )
        if fur.fins and fur.layers > 1:
            varyings = self._fins()
            shown = (varyings["opacity"][mesh.fin_triangles] > 0.0).any(axis=1)
            triangles = mesh.fin_triangles[shown]
            if len(triangles):
                found = self._meet(varyings["position"], triangles, culled=False)
                self._blend(found, triangles, varyings, self._fin_alpha)
        width, height = self.studio.picture.samples
        samples = np.concatenate([self.colour, self.coverage[:, :1]], axis=1)
        return samples.reshape(height, width, 4).astype(np.float32)

    def run(self, function: str, count: int, **inputs: Any) -> npt.NDArray[Any]:
        """A function of the library on the backend, for `count` sets of inputs; constants are repeated."""
        arrays = {name: repeated(value, count) for name, value in inputs.items()}
        return self.backend.evaluate(function, arrays)

    def _layer(self, layer: int) -> Varyings:
        """What the vertex stages of base and shells hand on."""
        fur, vertices = self.studio.fur, self.studio.mesh.vertices
        count = len(vertices)
        layers = np.uint32(fur.layers)
        height = float(self.run("shell_height", 1, layer=np.uint32(layer), layers=layers)[0])
        bend = {"n": vertices["normal"], "comb": vertices["comb"], "force": fur.force}
        lifted = {"coat_length": np.float32(fur.length) * vertices["length_share"], "height": height}
        position = vertices["position"]
        if layer:
            position = self.run("shell_offset", count, position=position, **bend, **lifted)
        return {
            "position": position,
            "normal": vertices["normal"],
            "tangent": self.run("shell_tangent", count, **bend, height=height),
            "share": np.stack([vertices["length_share"], vertices["density_share"]], axis=1),
            "uv": vertices["uv"],
            "height": np.full((count, 1), height, np.float32),
            **_shadows(vertices),
        }

    def _fins(self) -> Varyings:
        """What the vertex stage of fins hands on."""
        fur, vertices = self.studio.fur, self.studio.mesh.fin_vertices
        count = len(vertices)
        bend = {"n": vertices["normal"], "comb": vertices["comb"], "force": fur.force}
        direction = self.run("fin_direction", count, **bend)
        towards = np.float32(self.eye) - vertices["position"]
        v = self.run("safe_normalize", count, x=towards, fallback=vertices["normal"])
        opacity = self.run(
            "fin_opacity_silhouette",
            count,
            facing_a=np.clip(dot(v, vertices["face_a"]), -1.0, 1.0),
            facing_b=np.clip(dot(v, vertices["face_b"]), -1.0, 1.0),
            threshold=fur.fin_threshold,
        )
        position = self.run(
            "fin_position",
            count,
            position=vertices["position"],
            n=direction,
            w=vertices["w"],
            coat_length=np.float32(fur.length) * vertices["length_share"],
        )
        return {
            "position": position,
            "normal": vertices["normal"],
            "tangent": self.run("shell_tangent", count, **bend, height=vertices["w"]),
            "share": np.stack([vertices["length_share"], vertices["density_share"]], axis=1),
            "uv": vertices["uv"],
            "height": vertices["w"][:, None],
            "opacity": fur.fin_opacity * opacity,
            **_shadows(vertices),
        }

    def _meet(self, positions: npt.NDArray[Any], triangles: npt.NDArray[Any], culled: bool) -> Hits:
        """All meetings of the rays with triangles, in front of the base."""
        corners = positions[triangles].astype(np.float64)
        rays = RayMeshIntersector(trimesh.Trimesh(positions, triangles, process=False))
        origins = np.broadcast_to(self.eye, self.directions.shape)
        triangle, ray = rays.intersects_id(origins, self.directions, multiple_hits=True, max_hits=MOST_HITS)
        towards = self.directions[ray]
        if culled:
            plane = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            front = dot(plane[triangle], towards) < 0.0
            triangle, ray, towards = triangle[front], ray[front], towards[front]
        weights = barycentric(corners[triangle], self.eye, towards)
        place = np.einsum("ijk,ij->ik", corners[triangle], weights)
        distance = np.linalg.norm(place - self.eye, axis=1)
        seen = distance <= self.nearest[ray] * (1.0 + DEPTH_SLACK)
        return Hits(ray[seen], triangle[seen], distance[seen], weights[seen])

    def _blend(
        self,
        hits: Hits,
        triangles: npt.NDArray[Any],
        varyings: Varyings,
        alpha_of: Callable[[Varyings], npt.NDArray[Any]],
    ) -> None:
        """Shade what is met and blend it over what is there, in the order of the triangles."""
        corners = triangles[hits.triangle]
        at = {
            name: np.einsum(
                "ijk,ij->ik", array.reshape(len(array), -1)[corners].astype(np.float64), hits.weights
            )
            for name, array in varyings.items()
        }
        points = {name: value.astype(np.float32) for name, value in at.items()}
        alpha = alpha_of(points)
        kept = np.flatnonzero(alpha > 0.0)
        if not len(kept):
            return
        points = {name: value[kept] for name, value in points.items()}
        radiance, alpha, ray = self._radiance(points), alpha[kept], hits.ray[kept]
        for turn in _turns(ray, hits.triangle[kept]):
            rays, count = ray[turn], len(turn)
            shared = {"alpha": alpha[turn]}
            self.colour[rays] = self.run(
                "blend_over", count, under=self.colour[rays], over=radiance[turn], **shared
            )
            self.coverage[rays] = self.run(
                "blend_over", count, under=self.coverage[rays], over=(1.0, 1.0, 1.0), **shared
            )

    def _base_alpha(self, points: Varyings) -> npt.NDArray[Any]:
        return np.ones(len(points["height"]))

    def _shell_alpha(self, points: Varyings) -> npt.NDArray[Any]:
        fur, count = self.studio.fur, len(points["height"])
        opacity = self.run(
            "shell_alpha_resample",
            1,
            alpha=fur.opacity,
            authored=fur.authored_layers,
            drawn=float(fur.layers - 1),
        )
        mask = self.run("shell_strand_mask", count, uv=points["uv"], **self._hairs(points, count))
        return np.asarray(opacity[0] * mask)

    def _fin_alpha(self, points: Varyings) -> npt.NDArray[Any]:
        count = len(points["height"])
        row = np.round(points["uv"][:, 1])
        hairs = self._hairs(points, count)
        mask = self.run("fin_strand_mask", count, along=points["uv"][:, 0], row=row, **hairs)
        return self.run(
            "fin_alpha", count, opacity=points["opacity"][:, 0], height=hairs["height"], mask=mask
        )

    def _hairs(self, points: Varyings, count: int) -> dict[str, Any]:
        fur = self.studio.fur
        share = np.clip(points["share"][:, 1], 0.0, 1.0)
        return {
            "height": np.clip(points["height"][:, 0], 0.0, 1.0),
            "density": self.studio.mesh.hairs,
            "thickness": self.run("thinned", count, thickness=fur.thickness, share=share),
            "seed": np.uint32(fur.seed),
        }

    def _radiance(self, points: Varyings) -> Doubles:
        """Light (N, 3) that the points send to the eye, all lights together."""
        fur, shading, count = self.studio.fur, self.studio.shading, len(points["height"])
        n = self.run("safe_normalize", count, x=points["normal"], fallback=(0.0, 0.0, 1.0))
        t = self.run("safe_normalize", count, x=points["tangent"], fallback=n)
        v = self.run("safe_normalize", count, x=np.float32(self.eye) - points["position"], fallback=n)
        share = np.clip(points["share"], 0.0, 1.0)
        scales = {"length_share": share[:, 0], "density_share": share[:, 1]}
        needed = {p.name for p in shading.function.parameters}
        total = np.zeros((count, 3))
        rho, cos_dark, cos_lit = fur.surface
        for k, light in enumerate(self.studio.picture.lights):
            l = np.broadcast_to(unit(np.asarray(light.direction, np.float32)), (count, 3))
            colour = np.broadcast_to(np.asarray(light.colour, np.float32), (count, 3))
            if shading.shadowed:
                colour = points["lit"][:, min(k, len(points["lit"][0]) - 1), None] * colour
            given: dict[str, Any] = {"n": n, "t": t, "l": l, "v": v, "light": colour}
            if "h" in needed:
                given["h"] = self.run("half_vector", count, l=l, v=v)
            inputs = shading_inputs(shading, self.studio.material, given, count, scales)
            value = self.backend.evaluate(shading.function.name, inputs)
            surface = self.run(
                "fur_surface_attenuation",
                count,
                n_dot_l=np.clip(dot(n, l), -1.0, 1.0),
                rho_surface=rho,
                cos_dark=cos_dark,
                cos_lit=cos_lit,
            )
            total += surface[:, None] * (1.0 if "light" in needed else colour) * value
        shadow = self.run(
            "coat_shadow",
            count,
            height=np.clip(points["height"][:, 0], 0.0, 1.0),
            s_min=fur.s_min,
            share=share[:, 0] * share[:, 1],
        )
        shaded: Doubles = shadow[:, None] * total
        return shaded


def _shadows(vertices: npt.NDArray[Any]) -> Varyings:
    """The shares of lights that arrive at vertices, where lights cast shadows."""
    return {"lit": vertices["lit"]} if "lit" in (vertices.dtype.names or ()) else {}


def _first(hits: Hits) -> Hits:
    """The nearest meeting of every ray."""
    order = np.lexsort((hits.distance, hits.ray))
    first = order[np.unique(hits.ray[order], return_index=True)[1]]
    return Hits(hits.ray[first], hits.triangle[first], hits.distance[first], hits.weights[first])


def _turns(ray: Integers, triangle: Integers) -> list[Integers]:
    """Numbers of the points in turns, no ray twice in one; triangles of one ray in their order."""
    order = np.lexsort((triangle, ray))
    starts = np.unique(ray[order], return_index=True)[1]
    rank = np.arange(len(order)) - np.repeat(starts, np.diff([*starts, len(order)]))
    return [order[rank == k] for k in range(int(rank.max(initial=-1)) + 1)]
