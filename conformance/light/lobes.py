"""Lobes as the estimators use them: value, density and sampler in local frames, cosine included."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from conformance.reference.exact import frame_tangent_and_bitangent
from conformance.reference.lobes import LOBES, reference_of

Array = npt.NDArray[np.float64]
FIBRES = ("strand",)
"""Lobes over the whole sphere, which no surface shades: no cosine."""


@dataclass(frozen=True)
class Lobe:
    """A lobe of the library with its parameters, in the frame x = tangent, z = normal."""

    name: str
    parameters: tuple[float, ...] = ()
    label: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        if len(self.parameters) != len(LOBES[self.name]):
            raise ValueError(f"{self.name} has the parameters {', '.join(LOBES[self.name])}")

    def __str__(self) -> str:
        return self.label or " ".join([self.name, *(f"{x:g}" for x in self.parameters)])

    def value(self, l: Array, v: Array) -> Array:
        """The integrand beside the radiance: reflectance times cosine; of a fibre the reflectance."""
        found = self._call("value", l, v)
        return found if self.name in FIBRES else found * np.maximum(l[..., 2], 0.0)

    def pdf(self, l: Array, v: Array) -> Array:
        """Density per steradian."""
        return self._call("pdf", l, v)

    def sample(self, u: Array, v: Array) -> Array:
        """Directions (..., 3) of pairs (..., 2)."""
        return self._call("sample", u, v)

    def _call(self, part: str, first: Array, v: Array) -> Array:
        shape = first.shape[:-1]
        count = int(np.prod(shape))
        flat = first.reshape(count, first.shape[-1])
        viewer = np.broadcast_to(v, (*shape, 3)).reshape(count, 3)
        held = [np.full(count, x) for x in self.parameters]
        found = np.asarray(reference_of(self.name, part)(flat, viewer, *held))
        return found.reshape(*shape, 3) if part == "sample" else found.reshape(shape)


@dataclass(frozen=True)
class PowerLobe(Lobe):
    """(p + 1) / (2 pi) max(0, l.z)^p about the normal: its own density, so that every sample has weight 1."""

    name: str = "phong"

    def value(self, l: Array, v: Array) -> Array:
        """The density itself, without a cosine."""
        return self.pdf(l, v)


@dataclass(frozen=True)
class View:
    """Where the estimators stand: the frame's world directions (n, 3), and viewers in the local frame."""

    tangent: Array
    bitangent: Array
    normal: Array
    v: Array

    def to_world(self, local: Array) -> Array:
        """World directions of local ones (n, m, 3)."""
        axes = (self.tangent, self.bitangent, self.normal)
        return np.asarray(sum(local[..., k : k + 1] * axis[:, None, :] for k, axis in enumerate(axes)))

    def to_local(self, k: int, world: Array) -> Array:
        """Local directions of world ones (m, 3), at view k."""
        return np.stack([world @ axis[k] for axis in (self.tangent, self.bitangent, self.normal)], axis=-1)

    def __len__(self) -> int:
        return len(self.v)


def about(normals: Array, v: Array) -> View:
    """Views whose normals are given, tangents by Duff et al. 2017, viewers (n, 3) in the local frame."""
    return View(*frame_tangent_and_bitangent(normals), normals, v)


def along_x(v: Array) -> View:
    """Views in the world's own axes: a fibre along x, seen from the directions v."""
    ones = np.ones((len(v), 1))
    x, y, z = (ones * np.array(axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    return View(x, y, z, v)
