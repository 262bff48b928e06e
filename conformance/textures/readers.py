"""Functions of the library that read maps: inputs that are hard on them, and whether results are right.

`vair check` draws numbers, not maps; these functions are held to their references and declared bounds here.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.evaluate import evaluate
from codegen.library import Library, load_library
from codegen.tables.arguments import two_arguments
from codegen.tables.tabulate import made
from conformance.check.features import applies
from conformance.reference import ambiguous, reference_for
from conformance.reference.lobes import LOBES
from conformance.textures.environments import SIZES, broad_parameters, looks, paraboloid, parameters, views
from conformance.textures.maps import chain, full_chain

Array = npt.NDArray[Any]
SEED = 20260807
LOOKS = 600
LANES = 40
MANY = (17, 31, 40)
"""Numbers of samples for lobes of which every sample shows something; 17 and 31 just miss another row."""
DIRECTIONS = 2000
SHADES = ("factored_shade", "factored_strand_shade", "factored_satin_shade")
SCALE = np.array([1.0, 0.75, 0.5], np.float32)
"""What factors are multiplied by: another number for each channel."""
TABLE_SIZE = 256
"""Texels along a side of the table that the bound of strand_cosine_table speaks of."""


def lobe_of(name: str) -> str:
    """The lobe of an estimator."""
    return next(lobe for lobe in sorted(LOBES, key=len, reverse=True) if name.endswith(f"_{lobe}"))


def lobe_parameters(name: str) -> tuple[str, ...]:
    """The parameters of an estimator's lobe."""
    return LOBES[lobe_of(name)]


def estimator_inputs(name: str, kind: str, size: int = 32) -> dict[str, Any]:
    """A map and views for an estimator."""
    shaded: dict[str, Any] = views(LANES, SEED)
    own = parameters(lobe_parameters(name), LANES, SEED)
    return {"env": paraboloid(size, kind, SEED), **shaded, **own}


def broad_inputs(name: str) -> dict[str, Any]:
    """A map and views for an estimator whose lobe is so broad that no sample misses it."""
    found = estimator_inputs(name, "random")
    rng = np.random.default_rng(SEED)
    own = broad_parameters(lobe_parameters(name), LANES, SEED)
    return {**found, **own, "samples": rng.choice(MANY, LANES).astype(np.uint32)}


def factors(name: str) -> dict[str, Any]:
    """Factors of one shade with every texel by itself, and a scale of 1."""
    rng = np.random.default_rng(SEED)
    sizes = {"p": 64, "q": 33, **({"r": 48} if name != "factored_shade" else {})}
    found: dict[str, Any] = {k: [rng.random((n, n, 4)).astype(np.float32)] for k, n in sizes.items()}
    return {**found, "scale": np.ones(3, np.float32)}


def directions(count: int) -> tuple[Array, Array]:
    """Pairs of unit vectors over the sphere, most of them above the surface, in float32."""
    w = np.random.default_rng(SEED).normal(size=(2, count, 3))
    w[:, : count * 3 // 4, 2] = np.abs(w[:, : count * 3 // 4, 2])
    w /= np.linalg.norm(w, axis=-1, keepdims=True)
    return w[0].astype(np.float32), w[1].astype(np.float32)


def cosines(count: int) -> Array:
    """Pairs of cosines (2, N): uniform in angle, uniform, close to the ends and to 0, and exactly there."""
    rng = np.random.default_rng(SEED)
    angle = np.sin(rng.uniform(-np.pi / 2, np.pi / 2, (2, count)))
    ends = np.sign(rng.uniform(-1.0, 1.0, (2, count))) * (1.0 - 2.0 ** -rng.uniform(1.0, 24.0, (2, count)))
    small = rng.uniform(-1.0, 1.0, (2, count)) * 2.0 ** -rng.uniform(1.0, 60.0, (2, count))
    corners = np.array([(x, y) for x in (-1.0, -0.0, 0.0, 1.0) for y in (-1.0, -0.0, 0.0, 1.0)]).T
    mixed = np.stack([ends[0], angle[1]])
    return np.concatenate([angle, ends, small, mixed, corners], axis=1).astype(np.float32)


def inputs_for(name: str) -> Iterator[dict[str, Any]]:
    """Inputs for a public function that reads maps; raises KeyError for another one."""
    if name in SHADES:
        l, v = directions(DIRECTIONS)
        yield {**factors(name), "scale": SCALE, "l": l, "v": v}
    elif name == "strand_cosine_table":
        x, y, function = two_arguments(load_library(), "strand_cosine", {})
        x, y = (replace(end, warp="angle") for end in (x, y))
        table = made(x, y, function, TABLE_SIZE, TABLE_SIZE)
        levels = [table.values[:, :, None] * np.array([1.0, 0.0, 0.0, 0.0], table.values.dtype)]
        cos_l, cos_v = cosines(DIRECTIONS)
        yield {"table": levels, "cos_l": cos_l, "cos_v": cos_v}
    elif name in ("environment_latlong", "env_radiance", "env_prefiltered"):
        for size in SIZES:
            for kind in ("random", "hot"):
                looked = looks(LOOKS, SEED)
                if name == "environment_latlong":
                    levels = chain(2 * size, size, full_chain(2 * size, size), SEED, hot=kind == "hot")
                    yield {"environment": levels, **looked}
                elif name == "env_radiance":
                    yield {"env": paraboloid(size, kind, SEED), **looked}
                else:
                    yield {"env": paraboloid(size, kind, SEED), "w": looked["w"]}
    elif name.startswith("env_"):
        for kind in ("random", "hot"):
            yield estimator_inputs(name, kind)
        yield broad_inputs(name)
    else:
        raise KeyError(name)


def wide(value: Any) -> Any:
    """Inputs as the reference takes them."""
    if isinstance(value, dict):
        return {name: wide(part) for name, part in value.items()}
    return value if isinstance(value, list) or value.dtype == np.uint32 else value.astype(np.float64)


def expected(name: str, inputs: dict[str, Any]) -> Any:
    """The reference's values."""
    return reference_for(name)(*[wide(inputs[p.name]) for p in load_library().function(name).parameters])


def within(name: str, inputs: dict[str, Any], got: Any, exact: Any = None) -> bool:
    """Whether every result is finite and inside the declared bound, in units of the largest texel."""
    (bound,) = load_library().bounds[name]
    exact = expected(name, inputs) if exact is None else exact
    maps = [value for value in inputs.values() if isinstance(value, list)]
    largest = max(1.0, *(float(level.max()) for levels in maps for level in levels), 1.0)
    size = np.maximum(np.abs(exact) / largest, bound.floor) if bound.measure == "relative" else 1.0
    right = np.abs(got - exact) <= bound.bound * largest * size
    numbers = {n: value for n, value in inputs.items() if not isinstance(value, list)}
    judged = np.ones(len(right), np.bool_)
    if bound.where:
        judged = applies(bound, numbers, len(right))
    if name in SHADES:
        judged &= ~ambiguous(name, numbers)
    return bool(np.isfinite(got).all() and right[judged].all())


@functools.lru_cache(64)
def _cases(name: str) -> list[tuple[dict[str, Any], Any]]:
    """Inputs and the reference's values."""
    return [(inputs, expected(name, inputs)) for inputs in inputs_for(name)]


def passes(library: Library, name: str) -> bool:
    """Whether a function of a library, evaluated in float32, is right on all of its inputs."""
    return all(within(name, inputs, evaluate(library, name, inputs), exact) for inputs, exact in _cases(name))
