"""Dual-paraboloid maps that are hard on lookups and estimators, directions to look, and views to shade."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from conformance.reference.direction import frame_from_normal
from conformance.reference.exact import Array, unit
from conformance.textures.maps import Level, chain, full_chain

SIZES = (1, 2, 8, 32)
"""Texels along a side of a disc."""
SAMPLES = (0, 1, 2, 3, 7, 8, 13)
"""Numbers of samples: none, one, powers of two and others."""
EXPONENTS = (1.0, 10.0, 100.0, 1e3, 1e4)
SHARES = (0.0, 0.3, 0.5, 1.0)
HEIGHTS = (0.0, 1e-30, 1e-9, 1e-7, 1e-5, 1e-3, 0.02, 0.17, 0.18, 0.19)
"""How far above and below the rim to look: on it, within rounding, within a texel, where the border ends."""
CLEAR = 0.185
"""Height from which on one disc alone shows a direction, on every level: its border ends at 0.18."""


def paraboloid(size: int, kind: str, seed: int) -> list[Level]:
    """A full chain for discs of `size` texels: "random" in [0, 1) on every level, "hot" with one texel of 1e5
    on every level, "black", or "halves": 1 on the front disc and 0 on the back one."""
    levels = chain(2 * size, size, full_chain(2 * size, size), seed, hot=kind == "hot")
    if kind in ("black", "halves"):
        levels = [np.zeros_like(level) for level in levels]
    if kind == "halves":
        for level in levels[:-1]:
            level[:, : level.shape[1] // 2] = 1.0
    return levels


def single_texel(value: float) -> list[Level]:
    """A map of one texel."""
    return [np.full((1, 1, 4), value, np.float32)]


def looks(count: int, seed: int) -> dict[str, npt.NDArray[np.float32]]:
    """Directions w at random, along the axes and about the rim; levels lod between, on and beyond levels."""
    rng = np.random.Generator(np.random.PCG64(seed))
    heights = rng.choice(HEIGHTS, count) * rng.choice([-1.0, 1.0], count)
    turns = rng.uniform(0.0, 2.0 * np.pi, count)
    rim = np.stack([np.cos(turns), np.sin(turns), heights], axis=-1)
    axes = np.concatenate([np.eye(3), -np.eye(3)]).repeat(8, axis=0)
    w = unit(np.concatenate([rng.normal(size=(count, 3)), rim, axes]))
    lod = np.where(rng.random(len(w)) < 0.5, rng.integers(0, 13, len(w)), rng.uniform(0.0, 9.0, len(w)))
    return {"w": w.astype(np.float32), "lod": lod.astype(np.float32)}


def views(count: int, seed: int) -> dict[str, Any]:
    """Frames, viewers (one in ten below the surface), numbers of samples and shifts, half of them none."""
    rng = np.random.Generator(np.random.PCG64(seed))
    normals, v = (unit(rng.normal(size=(count, 3))) for _ in range(2))
    below = np.arange(count) % 10 == 9
    wrong = ((v * normals).sum(axis=1) < 0.0) != below
    v = np.where(wrong[:, None], -v, v)
    shift = rng.integers(0, 2**24, (count, 2)) * 2.0**-24
    frame = frame_from_normal(normals.astype(np.float32).astype(np.float64))
    return {
        "frame": {name: axis.astype(np.float32) for name, axis in frame.items()},
        "v": v.astype(np.float32),
        "samples": rng.choice(SAMPLES, count).astype(np.uint32),
        "shift": np.where(np.arange(count)[:, None] % 2, shift, 0.0).astype(np.float32),
    }


def parameters(names: tuple[str, ...], count: int, seed: int) -> dict[str, npt.NDArray[np.float32]]:
    """Values of a lobe's parameters by name."""
    rng = np.random.Generator(np.random.PCG64(seed))
    drawn: dict[str, Array] = {}
    for name in names:
        if name.startswith("exponent"):
            drawn[name] = rng.choice(EXPONENTS, count)
        elif name.startswith("alpha"):
            drawn[name] = 10.0 ** rng.uniform(-3.0, 0.0, count)
        elif name == "spread":
            drawn[name] = rng.uniform(0.01, 1.57, count)
        else:
            drawn[name] = rng.choice(SHARES, count)
    return {name: values.astype(np.float32) for name, values in drawn.items()}


BROAD = {"exponent": (1.0, 4.0), "alpha": (0.3, 1.0), "spread": (0.5, 1.5), "specular": (0.2, 0.8)}
"""Ranges of parameters for which lobes cover most of what they can."""


def broad_parameters(names: tuple[str, ...], count: int, seed: int) -> dict[str, npt.NDArray[np.float32]]:
    """Values of a lobe's parameters by name that make it broad."""
    rng = np.random.Generator(np.random.PCG64(seed))
    ends = {name: next(e for key, e in BROAD.items() if name.startswith(key)) for name in names}
    return {name: rng.uniform(*e, count).astype(np.float32) for name, e in ends.items()}


CORNERS = {
    "exponent": (0.0, 0.5, 1.0, 1e5),
    "alpha": (1e-4, 1e-3, 1.0),
    "spread": (1e-3, 0.5, np.pi / 2.0),
    "specular": (0.0, 1e-7, 1.0 - 2.0**-24, 1.0),
}
"""Values at the ends of the parameters' domains and beside them."""


def corners(names: tuple[str, ...], count: int, seed: int) -> dict[str, Any]:
    """Views along and across the axes of their frames, shifts at the ends, and such values of parameters."""
    rng = np.random.Generator(np.random.PCG64(seed))
    found = views(count, seed)
    axes = found["frame"]
    near = unit(axes["tangent"] + 1e-4 * axes["normal"]).astype(np.float32)
    viewers = np.stack([axes["normal"], -axes["normal"], axes["tangent"], axes["bitangent"], near])
    found["v"] = viewers[np.arange(count) % len(viewers), np.arange(count)]
    found["shift"] = rng.choice([0.0, 0.5, 1.0 - 2.0**-24], (count, 2)).astype(np.float32)
    for name in names:
        ends = next(values for key, values in CORNERS.items() if name.startswith(key))
        found[name] = rng.choice(ends, count).astype(np.float32)
    return found
