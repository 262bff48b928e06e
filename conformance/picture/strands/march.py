"""Strands without a rasteriser: rays meet the same ribbons, the library's functions run on any backend.

Embree finds which ribbon the ray of a sample meets first; tangents, widths and light are functions of the
library. Interpolation is done in float64.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import trimesh
from trimesh.ray.ray_pyembree import RayMeshIntersector

from conformance.picture.shade import Backend
from conformance.picture.stage_inputs import repeated, shading_inputs
from conformance.picture.strands.studio import StrandStudio
from conformance.picture.vectors import unit
from conformance.picture.visibility import barycentric

Singles = npt.NDArray[np.float32]


def march_strands(studio: StrandStudio, backend: Backend) -> Singles:
    """Premultiplied linear colour and coverage (height, width, 4), top row first."""
    width, height = studio.picture.samples
    eye = np.asarray(studio.picture.camera.eye, np.float64)
    directions = studio.picture.camera.directions(width, height)
    triangles = studio.ribbons.triangles
    varyings = vertex_stage(studio, backend)
    corners = varyings["position"].astype(np.float64)
    rays = RayMeshIntersector(trimesh.Trimesh(corners, triangles, process=False))
    hit = rays.intersects_first(np.broadcast_to(eye, directions.shape), directions)
    ray = np.flatnonzero(hit >= 0)
    samples = np.zeros((len(directions), 4), np.float32)
    if len(ray):
        met = triangles[hit[ray]]
        weights = barycentric(corners[met], eye, directions[ray])
        points = {
            name: np.einsum("ijk,ij->ik", array.reshape(len(array), -1)[met].astype(np.float64), weights)
            for name, array in varyings.items()
        }
        samples[ray, :3] = fragment_stage(
            studio, backend, {name: value.astype(np.float32) for name, value in points.items()}
        )
        samples[ray, 3] = 1.0
    return samples.reshape(height, width, 4)


def vertex_stage(studio: StrandStudio, backend: Backend) -> dict[str, npt.NDArray[Any]]:
    """What the vertex stage hands on."""
    vertices, hair = studio.ribbons.vertices, studio.hair
    count = len(vertices)
    t = _run(backend, "safe_normalize", count, x=vertices["along"], fallback=vertices["chord"])
    towards = np.asarray(studio.picture.camera.eye, np.float32) - vertices["position"]
    v = _run(backend, "safe_normalize", count, x=towards, fallback=vertices["chord"])
    across = _run(backend, "safe_normalize", count, x=np.cross(t, v), fallback=vertices["root"])
    share = vertices["share"]
    taper = _run(backend, "shell_shadow", count, height=np.float32(1.0) - share, s_min=hair.tip)
    half_width = 0.5 * np.float32(hair.width) * taper
    return {
        "position": vertices["position"] + (vertices["side"] * half_width)[:, None] * across,
        "normal": vertices["root"],
        "tangent": t,
        "share": share,
    }


def fragment_stage(
    studio: StrandStudio, backend: Backend, points: dict[str, Singles]
) -> npt.NDArray[np.float64]:
    """Light (N, 3) that the points send to the eye, all lights together."""
    count = len(points["position"])
    n = _run(backend, "safe_normalize", count, x=points["normal"], fallback=(0.0, 0.0, 1.0))
    t = _run(backend, "safe_normalize", count, x=points["tangent"], fallback=n)
    towards = np.asarray(studio.picture.camera.eye, np.float32) - points["position"]
    v = _run(backend, "safe_normalize", count, x=towards, fallback=n)
    needed = {p.name for p in studio.shading.function.parameters}
    total = np.zeros((count, 3))
    for light in studio.picture.lights:
        l = np.broadcast_to(unit(np.asarray(light.direction, np.float32)), (count, 3))
        given: dict[str, Any] = {"n": n, "t": t, "l": l, "v": v, "light": light.colour}
        if "h" in needed:
            given["h"] = _run(backend, "half_vector", count, l=l, v=v)
        inputs = shading_inputs(studio.shading, studio.material, given, count)
        value = backend.evaluate(studio.shading.function.name, inputs)
        total += value if "light" in needed else np.asarray(light.colour) * value
    share = np.clip(points["share"][:, 0], 0.0, 1.0)
    shadow = _run(backend, "shell_shadow", count, height=share, s_min=studio.hair.s_min)
    shaded: npt.NDArray[np.float64] = shadow[:, None] * total
    return shaded


def _run(backend: Backend, function: str, count: int, **inputs: Any) -> npt.NDArray[Any]:
    return backend.evaluate(function, {name: repeated(value, count) for name, value in inputs.items()})
