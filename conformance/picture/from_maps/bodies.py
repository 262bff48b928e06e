"""The bodies of a plate, as arrays that any backend can shade: the bunny and a sphere."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
import trimesh

from codegen.library import default_root
from conformance.light.lobes import View
from conformance.picture.brush import Brush
from conformance.picture.mesh import Mesh, read_mesh, smooth
from conformance.picture.vectors import dot, unit
from conformance.picture.visibility import Camera, see
from conformance.reference.sampling import r2_sequence

Doubles = npt.NDArray[np.float64]

BUNNY = default_root().parent / "examples" / "data" / "bunny.obj"
BODIES = ("bunny", "sphere")
SPHERE_SUBDIVISIONS = 5


@dataclass(frozen=True)
class Body:
    """What a picture of a body sees.

    mask              (height, width) of the samples, True where the body is seen
    tangent, bitangent, normal  (N, 3) float32 frames of the covered samples, right-handed
    v                 (N, 3) float32 unit directions to the eye
    behind            (pixels, 3) float32 unit directions through the pixels' centres, top row first
    size, supersample  of the picture in pixels, and samples along a pixel's side
    """

    mask: npt.NDArray[np.bool_]
    tangent: npt.NDArray[np.float32]
    bitangent: npt.NDArray[np.float32]
    normal: npt.NDArray[np.float32]
    v: npt.NDArray[np.float32]
    behind: npt.NDArray[np.float32]
    size: tuple[int, int]
    supersample: int

    @cached_property
    def view(self) -> View:
        """The frames in float64, viewers in the local frame: what the estimators of the reference take."""
        tangent, bitangent, normal = self._axes
        return View(tangent, bitangent, normal, self.to_local(self.v))

    @property
    def _axes(self) -> tuple[Doubles, ...]:
        return tuple(np.asarray(axis, np.float64) for axis in (self.tangent, self.bitangent, self.normal))

    def to_local(self, w: npt.ArrayLike) -> Doubles:
        """A direction (3,) or one for each sample (N, 3), in the samples' frames: (N, 3)."""
        world = np.asarray(w, np.float64)
        return np.stack([np.sum(world * axis, axis=1) for axis in self._axes], axis=-1)

    @cached_property
    def frame(self) -> dict[str, npt.NDArray[np.float32]]:
        """The struct Frame of every covered sample."""
        return {"tangent": self.tangent, "bitangent": self.bitangent, "normal": self.normal}

    @cached_property
    def shifts(self) -> npt.NDArray[np.float32]:
        """A shift (N, 2) of the sample points for every covered sample, so that errors show as noise."""
        return np.asarray(r2_sequence(np.arange(1, len(self.v) + 1, dtype=np.uint32)), np.float32)

    def some(self, count: int) -> npt.NDArray[np.int64]:
        """So many of the covered samples, evenly among them."""
        return np.unique(np.linspace(0, len(self) - 1, count).astype(np.int64))

    def at(self, rows: npt.NDArray[np.int64]) -> Body:
        """These covered samples alone; it is no picture any more."""
        parts = {name: getattr(self, name)[rows] for name in ("tangent", "bitangent", "normal", "v")}
        return replace(self, **parts)

    def __len__(self) -> int:
        return len(self.v)


def see_body(name: str, plan: Mapping[str, Any]) -> Body:
    """Cast the rays of a picture of a body; `plan` is the table of that body in plates.toml."""
    mesh = _sphere() if name == "sphere" else read_mesh(BUNNY, plan["subdivide"])
    side, supersample = plan["size"], plan["supersample"]
    camera = Camera(tuple(plan["eye"]), tuple(plan["target"]), field_of_view=plan["field_of_view"])
    brush = Brush(tuple(plan["axis"]))
    seen = see(mesh, camera, (side * supersample, side * supersample), brush, [], shadows=False)
    n, t = seen.n.astype(np.float64), seen.t.astype(np.float64)
    tangent = unit(t - dot(t, n)[:, None] * n)
    return Body(
        mask=seen.mask,
        tangent=tangent.astype(np.float32),
        bitangent=np.cross(n, tangent).astype(np.float32),
        normal=seen.n,
        v=seen.v,
        behind=camera.directions(side, side).astype(np.float32),
        size=(side, side),
        supersample=supersample,
    )


def _sphere() -> Mesh:
    mesh = smooth(trimesh.creation.icosphere(subdivisions=SPHERE_SUBDIVISIONS))
    return Mesh(mesh.positions, mesh.triangles, unit(mesh.positions))
