"""What is measured of the estimators: which lobes, maps, numbers of samples and places."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError
from codegen.library import default_root
from conformance.light.estimators import sequence
from conformance.light.lobes import Lobe, View, about
from conformance.reference.sampling import cranley_patterson, sphere_uniform

Array = npt.NDArray[np.float64]

DATA = default_root().parent / "examples" / "data"
SCHEMA = 1
"""Of the results."""
SEED = 20_267
QUICK_SECONDS = 40.0
"""What a quick plan takes on two idle cores, with PoCL, llvmpipe and lavapipe."""
GRID = 2**24
"""Shifts lie on the grid of the samples, so that float32 and float64 see the same points."""

LOBES = (
    Lobe("lambert"),
    Lobe("phong", (10.0,)),
    Lobe("phong", (100.0,)),
    Lobe("phong", (1000.0,)),
    Lobe("blinn_phong", (100.0,)),
    Lobe("ggx", (0.2, 0.4)),
    Lobe("ward", (0.2, 0.4)),
    Lobe("ashikhmin_shirley", (10.0, 100.0)),
    Lobe("poulin_fournier", (0.9, 0.5, 20.0)),
    Lobe("strand", (10.0,)),
    Lobe("strand", (100.0,)),
    Lobe("strand", (1000.0,)),
)
"""Every lobe of the library, the two that published figures speak of with three exponents."""


@dataclass(frozen=True)
class Plan:
    """How much is measured.

    lobes, maps  what is estimated, and under which maps of examples/data
    counts       numbers of samples
    timed        those of them whose time is measured; between two of them it lies on a line
    views        surface frames, spread over the sphere
    shifts       random shifts of the samples for each view
    rounds       of launches, for the time
    """

    lobes: tuple[Lobe, ...] = LOBES
    maps: tuple[str, ...] = ("dawn", "venice", "studio")
    counts: tuple[int, ...] = tuple(2**k for k in range(3, 13))
    timed: tuple[int, ...] = tuple(2**k for k in range(3, 13, 3))
    views: int = 12
    shifts: int = 2
    rounds: int = 6

    @staticmethod
    def quick() -> Plan:
        """One map, three lobes, few samples: what takes QUICK_SECONDS."""
        lobes = (Lobe("phong", (10.0,)), Lobe("ggx", (0.2, 0.4)), Lobe("strand", (100.0,)))
        counts = tuple(2**k for k in range(3, 12, 3))
        return Plan(lobes, ("dawn",), counts, counts, views=6, rounds=3)

    def described(self) -> str:
        """The places and points in words, for the report."""
        return (
            f"{self.views} frames whose normals are spread over the sphere, tangents by Duff et al. 2017, "
            f"viewers from 15 degrees above the surface to the zenith; Hammersley points with "
            f"{self.shifts} random shifts for each frame (seed {SEED})"
        )


def path_of(name: str) -> Path:
    """The file of a map; raises UserError where the examples are not installed."""
    path = DATA / f"{name}.exr"
    if not path.is_file():
        raise UserError(f'the map "{path}" is missing: estimators of light are measured under it')
    return path


def maps_are_here() -> bool:
    """Whether the maps are installed: a package without the examples lacks them."""
    return all((DATA / f"{name}.exr").is_file() for name in Plan().maps)


def frames(plan: Plan) -> View:
    """The places without their repetition for each shift."""
    u = sequence(plan.views)
    normals = np.asarray(sphere_uniform(u))
    z, phi = 0.25 + 0.75 * u[::-1, 0], 2.0 * np.pi * u[:, 1]
    ring = np.sqrt(1.0 - z * z)
    return about(normals, np.stack([ring * np.cos(phi), ring * np.sin(phi), z], axis=-1))


def repeated(plan: Plan) -> View:
    """Every place once for each shift, (views * shifts) of them."""
    view = frames(plan)
    parts = (
        np.repeat(part, plan.shifts, axis=0) for part in (view.tangent, view.bitangent, view.normal, view.v)
    )
    return View(*parts)


def shifts(plan: Plan) -> Array:
    """The shift of each of them, (views * shifts, 2), in [0, 1)."""
    whole = np.random.default_rng(SEED).integers(0, GRID, (plan.views * plan.shifts, 2))
    return whole / GRID


def points(plan: Plan, count: int) -> Array:
    """The points of each of them, (views * shifts, count, 2)."""
    moved = shifts(plan)
    u = np.broadcast_to(sequence(count), (len(moved), count, 2))
    by = np.broadcast_to(moved[:, None, :], u.shape)
    return np.asarray(cranley_patterson(u.reshape(-1, 2), by.reshape(-1, 2))).reshape(u.shape)
