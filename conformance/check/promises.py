"""What sources promise beside a bound, and inputs on which it shows: unit vectors, finite and least values.

`vair check` holds functions to declared bounds at drawn inputs. A unit vector that is a few roundings too
long, a pole that takes two numbers to meet, or a transmittance far below the bound's floor pass there.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from itertools import product
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.evaluate import evaluate
from codegen.frontend.source import LANG
from codegen.library import Library, load_library
from conformance.cases.drawing import families_for
from conformance.check.draws import draw
from conformance.check.rewritten import is_call, rewritten, rounded
from conformance.reference.sampling import pcg3d

Array = npt.NDArray[Any]
COUNT, SEED = 3000, 20261123
FAMILIES = ("uniform", "domain_ends")
LONGER = 2.6 * 2.0**-24
"""By what a vector of three rounded components is longer or shorter than 1; 2.54 measured."""
LEAST = 1.8e-35
"""e^-80, below which no transmittance and no power falls unless it is 0."""
LAST_BITS = 2.0**-22
"""By which share a target's quotients may be off: 2 ULP or more."""
MOST_SQUARED = 80.001**2
"""The square of the largest magnitude of which an exponential is asked for, and a rounding."""
AZIMUTHS = ("fur_geometry", *(f"strand_azimuth_cosine{form}" for form in ("", "_cross", "_dots")))
"""Functions that give the cosine of the azimuth of the light about a hair."""
LARGEST_VARIANCE = 999.0
LIMIT = 1e-6
"""Error at a limit that a source states, of a density relative to it; 2e-7 measured."""
FAINT = 1e-3
"""A highlight that is none: polynomials leave 2e-4 of it."""

UNIT = (
    "ashikhmin_shirley_sample",
    "blinn_phong_sample",
    "dual_paraboloid_direction",
    "fin_normal",
    "fin_normal_dot",
    "ggx_sample",
    "hemisphere_cosine",
    "lambert_sample",
    "latlong_direction",
    "octahedral_decode",
    "parabolic_direction",
    "phong_sample",
    "poulin_fournier_sample",
    "sphere_uniform",
    "strand_sample",
    "ward_sample",
)
"""Functions whose results are unit vectors."""

HEIGHTS = (0.0, 1.5e-45, 1e-42, 1e-36, 1e-30, 1e-24, 1e-18, 1e-12, 1e-8, 1e-4)
"""Heights of light and viewer that are opposite at grazing: half vectors and cosines vanish together."""
PARAMETERS = {
    "alpha": (1e-4, 0.03, 1.0),
    "exponent": (0.0, 1.0, 1e5),
    "spread": (1e-3, 0.7, np.pi / 2.0),
    "specular": (0.0, 0.5, 1.0),
}
LOBES = ("ashikhmin_shirley", "blinn_phong", "ggx", "phong", "poulin_fournier", "strand", "ward")
OPPOSED_IS_ZERO = ("ashikhmin_shirley_pdf", "blinn_phong_pdf", "ggx_pdf", "ward_pdf")
"""Densities that are 0 for l = -v."""


def opposed(name: str) -> dict[str, Array]:
    """Light and viewer on opposite sides at every pair of heights, with all corners of a lobe."""
    own = [p.name for p in load_library().function(name).parameters[2:]]
    ends = [next(v for key, v in PARAMETERS.items() if p.startswith(key)) for p in own]
    turns = (0.0, 0.25, 0.3)
    rows = np.array(list(product(turns, HEIGHTS, HEIGHTS, *ends)))
    across = np.stack([np.cos(2.0 * np.pi * rows[:, 0]), np.sin(2.0 * np.pi * rows[:, 0])], axis=-1)
    l, v = (np.concatenate([side * across, rows[:, [k]]], axis=1) for side, k in ((1.0, 1), (-1.0, 2)))
    drawn = {"l": l, "v": v, **{p: rows[:, 3 + k] for k, p in enumerate(own)}}
    return {key: value.astype(np.float32) for key, value in drawn.items()}


def _is_unit(library: Library, name: str) -> bool:
    function = load_library().function(name)
    for family in FAMILIES:
        found = np.asarray(evaluate(library, name, draw(function, family, COUNT, SEED).inputs), np.float64)
        if not (np.abs(np.linalg.norm(found, axis=-1) - 1.0) <= LONGER).all():
            return False
    return True


def _is_finite(library: Library, name: str) -> bool:
    inputs = opposed(name)
    found = np.asarray(evaluate(library, name, inputs))
    if not (np.isfinite(found).all() and (found >= 0.0).all()):
        return False
    if name not in OPPOSED_IS_ZERO:
        return True
    behind = {**inputs, "l": -inputs["v"]}
    return not np.asarray(evaluate(library, name, behind)).any()


def _ward_ends(library: Library, name: str) -> bool:
    """The lobe is 0 where its exponent is beyond 80."""
    inputs = draw(load_library().function(name), "uniform", COUNT, SEED).inputs
    g = inputs["l"].astype(np.float64) + inputs["v"]
    slopes = g[:, :2] / g[:, 2:] / np.stack([inputs["alpha_x"], inputs["alpha_y"]], axis=-1)
    beyond = (slopes**2).sum(axis=-1) > 81.0
    return bool(beyond.any()) and not np.asarray(evaluate(library, name, inputs))[beyond].any()


def _peaks_along_the_strand(library: Library, name: str) -> bool:
    """The limit of the density for v = +-x and l = -v is (p + 1) / (2 pi)."""
    exponent = np.repeat(np.array([0.0, 1.0, 10.0, 1e3, 1e5], np.float32), 2)
    v = np.tile(np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]], np.float32), (5, 1))
    found = np.asarray(evaluate(library, name, {"l": -v, "v": v, "exponent": exponent}))
    limit = (exponent.astype(np.float64) + 1.0) / (2.0 * np.pi)
    return bool((np.abs(found - limit) <= LIMIT * limit).all())


def _skin_is_left(library: Library, name: str) -> bool:
    """Some light comes through the densest coat: the least power of e that is no denormal number."""
    depths = np.array([0.0, 30.0, 60.0, 79.0, 85.0, 95.0, 110.0, 1e3, 1e18], np.float32)
    view, light = (a.ravel() for a in np.meshgrid(depths, depths))
    given = {"depth_view": view, "depth_light": light, "overlap": np.full(len(view), 0.5, np.float32)}
    wanted = {p.name: given[p.name] for p in load_library().function(name).parameters}
    found: Any = evaluate(library, name, wanted)
    return bool((found["skin"] >= LEAST).all())


def _powers_are_left(library: Library, name: str) -> bool:
    """A power is 0 or no less than e^-80."""
    inputs = draw(load_library().function(name), "uniform", COUNT, SEED).inputs
    found = np.asarray(evaluate(library, name, {**inputs, "p": np.full(COUNT, 1e5, np.float32)}))
    return bool(found.any()) and bool(((found == 0.0) | (found >= LEAST)).all())


def _half_vector_decides(library: Library, name: str) -> bool:
    """For l = -v, half_vector's direction is that of the highlight: a strand along it has none.

    Shown by level directions, whose frames are not those of their opposites.
    """
    turns = np.linspace(0.1, 6.1, 50)
    l = np.stack([np.cos(turns), np.sin(turns), np.zeros(len(turns))], axis=-1).astype(np.float32)
    along = np.asarray(evaluate(load_library(), "half_vector", {"l": l, "v": -l}))
    one, none = np.ones((len(l), 3), np.float32), np.zeros(len(l), np.float32)
    sharp = np.full(len(l), 16.0, np.float32)
    given = {"t": along, "n": l, "l": l, "v": -l, "base": one, "primary": one, "secondary": one}
    given |= {f"{which}_exponent": sharp for which in ("primary", "secondary")}
    given |= {f"{which}_shift": none for which in ("primary", "secondary")}
    found = np.asarray(evaluate(library, name, {**given, "mask": none}))
    return bool((np.abs(found - 1.0) <= FAINT).all())


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, dict):
        return all(_same(one[field], other[field]) for field in one)
    return np.array_equal(one, other)


def _counts_as(library: Library, name: str) -> bool:
    """Inputs beyond the domain give what the source says that they count as."""
    return all(
        _same(evaluate(library, name, _inputs(beyond)), evaluate(library, name, _inputs(held)))
        for beyond, held in COUNT_AS[name]
    )


def _inputs(given: Mapping[str, Any]) -> dict[str, Array]:
    return {key: np.array([x], np.uint32 if isinstance(x, int) else np.float32) for key, x in given.items()}


def _hammersley(library: Library, name: str) -> bool:
    """Points are exact, also where quotients are off in their last bits; i >= n counts as n - 1, and n = 0
    gives 2^-24."""
    rng = np.random.default_rng(SEED)
    n = np.exp2(rng.uniform(0.0, 20.0, COUNT)).astype(np.uint32)
    i = (rng.random(COUNT) * n).astype(np.uint32)
    i[::4] = n[::4] - 1
    # Quotients that miss a whole number by 1 / n: i 2^24 is one less than a multiple of n.
    for k in range(1, COUNT, 8):
        n[k] = rng.integers(2**17, 2**19) * 2 + 1
        i[k] = (int(n[k]) - 1) * pow(2**24, -1, int(n[k])) % int(n[k])
    wanted = (i.astype(np.uint64) << np.uint64(24)) // n
    for factor in (1.0 - LAST_BITS, 1.0, 1.0 + LAST_BITS):
        found = np.asarray(evaluate(rounded(library, name, factor), name, {"i": i, "n": n}))
        if not np.array_equal(found[:, 0].astype(np.float64) * 2.0**24, wanted):
            return False
    beyond = np.asarray(evaluate(library, name, {"i": n + np.uint32(3), "n": n}))
    last = np.asarray(evaluate(library, name, {"i": n - np.uint32(1), "n": n}))
    of_none = np.asarray(evaluate(library, name, {"i": i, "n": np.zeros(COUNT, np.uint32)}))
    return np.array_equal(beyond[:, 0], last[:, 0]) and bool((of_none[:, 0] == np.float32(2.0**-24)).all())


def _shell_height(library: Library, name: str) -> bool:
    """Exactly 1 at the top, also where quotients are off in their last bits; 0 of one layer or none."""
    layers = np.arange(257, dtype=np.uint32)
    for factor in (1.0 - LAST_BITS, 1.0, 1.0 + LAST_BITS):
        of = rounded(library, name, factor)
        for top in (np.maximum(layers, 1) - 1, layers):
            found = np.asarray(evaluate(of, name, {"layer": top.astype(np.uint32), "layers": layers}))
            if not np.array_equal(found, np.where(layers > 1, 1.0, 0.0)):
                return False
    return True


def _stays_below_one(library: Library, name: str) -> bool:
    """A rotated point stays below 1 where its sum with the shift rounds to 1."""
    u, shift = (np.full((1, 2), x, np.float32) for x in (2.0**-24 - 2.0**-48, 1.0 - 2.0**-24))
    return bool((np.asarray(evaluate(library, name, {"u": u, "shift": shift})) < 1.0).all())


def _average_ends(library: Library, name: str) -> bool:
    """A mean above 1 has no variance; no mean at all is (0, 0, 1) with a variance of 999."""
    means = np.array([[0.0, 1.01, 0.0], [0.0, 0.0, 0.0]], np.float32)
    found: Any = evaluate(library, name, {"tangent_mean": means})
    directions = np.array_equal(found["tangent"], [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    none, most = found["variance"]
    return directions and bool(none == 0.0 and abs(most - LARGEST_VARIANCE) <= LARGEST_VARIANCE * LAST_BITS)


def _azimuth_is_a_cosine(library: Library, name: str) -> bool:
    """Azimuth cosines never leave [-1, 1]."""
    function = load_library().function(name)
    for family in (*FAMILIES, *families_for(function.parameters)):
        found: Any = evaluate(library, name, draw(function, family, COUNT, SEED).inputs)
        cosine = np.asarray(found["azimuth_cosine"] if isinstance(found, dict) else found)
        if not (np.abs(cosine) <= 1.0).all():
            return False
    return True


def _shell_pattern(library: Library, name: str) -> bool:
    """The pattern of hairs is that of its source's whole numbers, also below 0 and between their steps."""
    rng = np.random.default_rng(SEED)
    each = 20 * COUNT
    far, near = rng.uniform(-1024.0, 1024.0, (each, 2)), rng.uniform(-4.0, 0.0, (each, 2))
    density = np.concatenate([np.exp2(rng.uniform(0.0, 12.0, each)), rng.uniform(2e3, 4e3, each)])
    inputs = {
        "uv": np.concatenate([far, near]).astype(np.float32),
        "height": rng.uniform(0.0, 1.0, 2 * each).astype(np.float32),
        "density": density.astype(np.float32),
        "thickness": rng.uniform(0.3, 1.0, 2 * each).astype(np.float32),
        "seed": rng.integers(0, 2**32, 2 * each).astype(np.uint32),
    }
    return np.array_equal(np.asarray(evaluate(library, name, inputs)), shell_pattern(**inputs))


def shell_pattern(uv: Array, height: Array, density: Array, thickness: Array, seed: Array) -> Array:
    """shell_strand_mask by the formulas of its source, in 64 bits."""
    word = np.uint64(2**32 - 1)
    cells = np.floor(density).astype(np.uint64)
    x, y = (
        np.floor(uv[:, k].astype(np.float64) * 2.0**20).astype(np.int64).astype(np.uint64) for k in (0, 1)
    )
    along = y * cells & word
    across = (x * cells + ((along >> 20 & 1) << 19)) & word
    cell = np.stack([across >> 20, along >> 20, seed.astype(np.uint64)], axis=-1).astype(np.uint32)
    random = np.asarray(pcg3d(cell)).astype(np.uint64) >> 17
    tip = 32768 + random[:, 2]
    reached = np.minimum(np.floor(height.astype(np.float64) * 2.0**16).astype(np.uint64), tip)
    widest = np.floor(thickness.astype(np.float64) * 2.0**14).astype(np.uint64)
    base, radius = widest * tip >> 16, widest * (tip - reached) >> 16
    place = np.stack([across >> 5, along >> 5], axis=-1) & 32767
    centre = base[:, None] + (random[:, :2] * (32768 - 2 * base)[:, None] >> 15)
    apart = place.astype(np.int64) - centre.astype(np.int64)
    return np.where((apart**2).sum(axis=-1) < radius.astype(np.int64) ** 2, 1.0, 0.0)


def with_guarded_exponentials(library: Library, name: str) -> Library:
    """The library with a function whose exponentials are no number where they are asked for beyond +-80."""

    def guarded(node: ast.Call | ast.BinOp) -> ast.expr:
        if not is_call(node, "exp"):
            return node
        text = ast.unparse(node.args[0]) if isinstance(node, ast.Call) else ""
        noted = f"({ast.unparse(node)} + 0.0 * sqrt({MOST_SQUARED} - ({text}) * ({text})))"
        return ast.parse(noted, mode="eval").body

    copied = rewritten(library, name, guarded)
    copied.resolver.file(copied.resolver.module_of(name)).imports["sqrt"] = (LANG, "sqrt")
    return copied


def asks_for_ordinary_exponentials(library: Library, name: str) -> bool:
    """Whether a function asks exp for numbers of [-80, 80] only, see shaderlib/constants.py."""
    function = load_library().function(name)
    guarded = with_guarded_exponentials(library, name)
    for family in FAMILIES:
        found: Any = evaluate(guarded, name, draw(function, family, COUNT, SEED).inputs)
        parts = found.values() if isinstance(found, dict) else (found,)
        if not all(np.isfinite(part).all() for part in parts):
            return False
    return True


def takes_exponentials(name: str) -> bool:
    """Whether a function of the library calls exp itself."""
    file = load_library().resolver.where(name)
    return file is not None and any(is_call(n, "exp") for n in ast.walk(file.functions[name]))


COUNT_AS: Mapping[str, tuple[tuple[dict[str, Any], dict[str, Any]], ...]] = {
    "shell_strand_mask": (
        (
            {"uv": (0.5, 0.5), "height": 0.0, "density": 0.25, "thickness": 1.0, "seed": 7},
            {"uv": (0.5, 0.5), "height": 0.0, "density": 1.0, "thickness": 1.0, "seed": 7},
        ),
    ),
    "angle_share": (({"c": 1.0000002}, {"c": 1.0}), ({"c": -1.0000002}, {"c": -1.0})),
    **{
        f"shell_alpha_resample{form}": (
            (
                {"alpha": 0.25, "authored": 8.0, "drawn": 0.5},
                {"alpha": 0.25, "authored": 8.0, "drawn": 1.0},
            ),
        )
        for form in ("", "_direct", "_thin")
    },
}
"""Function -> inputs beyond its domain, and what they count as by its source."""

Promise = Callable[[Library, str], bool]
PROMISES: Mapping[str, tuple[Promise, ...]] = {
    **{name: (_is_unit,) for name in UNIT},
    **{f"{lobe}_{part}": (_is_finite,) for lobe in LOBES for part in ("value", "pdf")},
    **{name: (_counts_as,) for name in COUNT_AS},
    **{name: (_azimuth_is_a_cosine,) for name in AZIMUTHS},
    "ward_value": (_is_finite, _ward_ends),
    "ward_pdf": (_is_finite, _ward_ends),
    "poulin_fournier_value_eight": (_is_finite,),
    "strand_pdf": (_is_finite, _peaks_along_the_strand),
    "fur_weights_goldman": (_skin_is_left,),
    "fur_weights_slab": (_skin_is_left,),
    **{f"scheuermann_shade{form}": (_half_vector_decides,) for form in ("", "_from4", "_from8", "_cubic8")},
    "fur_average": (_average_ends,),
    "pow_one_minus": (_powers_are_left,),
    "shell_sine_power": (_powers_are_left,),
    "hammersley": (_hammersley,),
    "cranley_patterson": (_stays_below_one,),
    "shell_height": (_shell_height,),
    "shell_strand_mask": (_counts_as, _shell_pattern),
}
"""Function -> what it promises."""


def keeps(library: Library, name: str) -> bool:
    """Whether a function of a library keeps its promises."""
    ordinary = not takes_exponentials(name) or asks_for_ordinary_exponentials(library, name)
    return ordinary and all(promise(library, name) for promise in PROMISES.get(name, ()))
