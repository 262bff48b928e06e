"""What estimators of light from a map promise beside their bounds, and inputs on which it shows.

A sum has as many terms as are asked for, and no more than the limit; it is finite at the corners of the
domain; its rows and columns do not hang on the last bits of quotients and roots, which targets round in their
own ways.
"""

from __future__ import annotations

import ast
import functools
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.evaluate import evaluate
from codegen.library import Library, load_library
from conformance.check.rewritten import copy, rounded
from conformance.reference.environment import DENSITY_FLOOR, MOST_SAMPLES, SHARP, sharpest_level
from conformance.reference.exact import unit
from conformance.textures.environments import broad_parameters, corners, paraboloid, views
from conformance.textures.readers import (
    LANES,
    SEED,
    broad_inputs,
    lobe_of,
    lobe_parameters,
    wide,
    within,
)

Array = npt.NDArray[Any]
DOMAINS = "shaderlib.environment.domains"
BRIGHTEST = 1e30
"""Radiance far beyond any map's: a sum of weights must not overflow."""
FEW = 5
"""The limit of the number of samples that is tried in place of the library's, which takes seconds."""
BEYOND = (FEW + 1, 2**32 - 1)
WHOLE = (2, 8, 18, 32)
"""Numbers of samples that fill rows and columns, and whose halves have whole roots."""
LAST_BITS = 2.0**-22
"""By which share a target's quotients and roots may be off: 2.5 ULP in WGSL, and as much in Vulkan."""
VIEWS, NEAREST = 4000, 10
"""Views to choose from, and how many of them lie next to the step, on either side of it."""
TRIED = 100_000
"""Samples of a lobe among which those without a density are looked for."""
CLEAR_OF_STEP = 1e-5
"""Distance in levels from which on float32 knows on which side of the step a peak lies."""


def few_inputs(name: str) -> dict[str, Any]:
    """One to three samples of a broad lobe, and shifts by almost a column: directions beyond a whole turn."""
    rng = np.random.default_rng(SEED)
    found = broad_inputs(name)
    shift = rng.uniform(0.9, 1.0 - 2.0**-24, (LANES, 2)).astype(np.float32)
    return {**found, "samples": rng.choice([1, 2, 3], LANES).astype(np.uint32), "shift": shift}


def peak_inputs(name: str) -> dict[str, Any]:
    """Views whose peak is looked up just below and just above the level from which a guarded sum filters."""
    env = paraboloid(8, "random", SEED)
    own = broad_parameters(lobe_parameters(name), VIEWS, SEED)
    many: dict[str, Any] = {**views(VIEWS, SEED), **own}
    many["samples"] = np.random.default_rng(SEED).integers(2, 41, VIEWS).astype(np.uint32)
    given = [wide(value) for value in (env, *(many[part] for part in ("frame", "v", "samples", *own)))]
    beyond = sharpest_level(lobe_of(name), *given) - SHARP
    near = [k for k in np.argsort(np.abs(beyond)) if abs(beyond[k]) > CLEAR_OF_STEP]
    sides = [[k for k in near if (beyond[k] > 0.0) == above][:NEAREST] for above in (False, True)]
    return {"env": env, **_rows(many, np.concatenate(sides))}


def _rows(value: Any, chosen: Array) -> Any:
    if isinstance(value, dict):
        return {name: _rows(part, chosen) for name, part in value.items()}
    return value[chosen]


def with_limit(library: Library, name: str, limit: int) -> Library:
    """The library with another limit of the number of samples."""
    copied, _ = copy(library, library.resolver.module_of(name))
    copied.resolver.file(DOMAINS).values["MOST_SAMPLES"] = ast.Constant(limit)
    return copied


def stops_at_the_limit(library: Library, name: str) -> bool:
    """Whether the limit is the documented one, and more samples are as good as that many."""
    if library.resolver.constant(library.resolver.file(DOMAINS), "MOST_SAMPLES") != MOST_SAMPLES:
        return False
    few = with_limit(library, name, FEW)
    inputs = broad_inputs(name)

    def of(samples: int) -> Array:
        asked = {**inputs, "samples": np.full(LANES, samples, np.uint32)}
        return np.asarray(evaluate(few, name, asked))

    most = of(FEW)
    return bool(most.any()) and all(np.array_equal(of(samples), most) for samples in BEYOND)


@functools.lru_cache(16)
def dark_inputs(name: str) -> dict[str, Any]:
    """One sample that lies above the surface and has no density: rounding leads there, at corners of u.

    For the lobes of which chance finds any; others give no views at all.
    """
    rng = np.random.default_rng(SEED)
    found = corners(lobe_parameters(name), TRIED, SEED)
    v = rng.normal(size=(TRIED, 3)) * rng.choice([1.0, 1e-4, 0.0], (TRIED, 3))
    v = unit(np.where(v.any(axis=-1, keepdims=True), v, 1.0))
    found["shift"] = np.where(rng.random((TRIED, 2)) < 0.5, rng.random((TRIED, 2)), found["shift"])
    found["shift"] = np.minimum(found["shift"], 1.0 - 2.0**-24).astype(np.float32)
    own = {key: found[key] for key in lobe_parameters(name)}
    lobe, viewer = lobe_of(name), v.astype(np.float32)
    l = np.asarray(evaluate(load_library(), f"{lobe}_sample", {"u": found["shift"], "v": viewer, **own}))
    density = np.asarray(evaluate(load_library(), f"{lobe}_pdf", {"l": l, "v": viewer, **own}))
    dark = np.flatnonzero((density <= DENSITY_FLOOR) & (l[:, 2] > 0.0))[:LANES]
    axes = dict(zip(("tangent", "bitangent", "normal"), np.eye(3, dtype=np.float32), strict=True))
    frame = {key: np.tile(axis, (len(dark), 1)) for key, axis in axes.items()}
    chosen = {**own, "v": viewer, "shift": found["shift"]}
    samples = np.ones(len(dark), np.uint32)
    return {"frame": frame, "samples": samples, **{key: value[dark] for key, value in chosen.items()}}


def finite_at_corners(library: Library, name: str) -> bool:
    """Whether every sum is finite at the corners of the domain, under a sky of 1e30."""
    brightest = [level * np.float32(BRIGHTEST) for level in paraboloid(8, "random", SEED)]
    hard = [corners(lobe_parameters(name), 10 * LANES, SEED), dark_inputs(name)]
    return all(
        bool(np.isfinite(np.asarray(evaluate(library, name, {"env": brightest, **inputs}))).all())
        for inputs in hard
        if len(inputs["v"])
    )


def forgives_last_bits(library: Library, name: str) -> bool:
    """Whether quotients and roots that are off in their last bits change no result beyond the bound."""
    rng = np.random.default_rng(SEED)
    inputs = {**broad_inputs(name), "samples": rng.choice(WHOLE, LANES).astype(np.uint32)}
    return all(
        within(name, inputs, evaluate(rounded(library, name, factor), name, inputs))
        for factor in (1.0 - LAST_BITS, 1.0 + LAST_BITS)
    )


def keeps_promises(library: Library, name: str) -> bool:
    """Whether an estimator of a library keeps all of these."""
    hard = [few_inputs(name)]
    if name.startswith("env_guarded_"):
        hard.append(peak_inputs(name))
    return (
        all(within(name, inputs, evaluate(library, name, inputs)) for inputs in hard)
        and stops_at_the_limit(library, name)
        and finite_at_corners(library, name)
        and (not name.startswith("env_grid_") or forgives_last_bits(library, name))
    )


def is_estimator(name: str) -> bool:
    """Whether a function of the library sums what a lobe reflects of a map."""
    parameters = load_library().function(name).parameters
    return name.startswith("env_") and any(p.name == "shift" for p in parameters)
