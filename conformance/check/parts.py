"""Library functions that public functions do not show: parts of pictures, beside their formulas in float64.

`vair check` looks at public functions and at what these call. What only hosts put together is held to its
documented formula here, and so is what a caller hides, by a limit of its own or by no promise there, and what
a wide bound hides.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.evaluate import evaluate
from codegen.library import Library, load_library
from conformance.check.draws import draw

Array = npt.NDArray[Any]
Formula = Callable[[Mapping[str, Any]], Array]
COUNT, SEED = 400, 20261122
FAMILIES = ("uniform", "domain_ends")
SLOPE = 1e-6
"""Step along the height in which a curve is followed."""
SHORT = 0.05
"""Vectors and ways below this have a direction that a step says too little of."""
NEAR = {"shell_tangent": 1e-4, "across_share": 1e-8, "turn_of": 3e-9}
"""Distance from the formula: of a derivative from a difference quotient, of an angle from a polynomial."""
RELATIVE = ("ggx_visible_area",)
"""Whose distance is a share of what the formula gives."""
USUAL = 1e-9
SMALLEST_AREA = float(np.float32(1e-20))
"""The least area that the library gives, as it holds the number."""


def _value(name: str, **inputs: Any) -> Array:
    """A public function of the library itself."""
    return np.asarray(evaluate(load_library(), name, inputs, "float64"))


def _thinned(x: Mapping[str, Any]) -> Array:
    return np.asarray(x["thickness"] * np.sqrt(x["share"]))


def _coat_shadow(x: Mapping[str, Any]) -> Array:
    below = 1.0 - x["share"] * (1.0 - x["s_min"])
    return _value("shell_shadow", height=x["height"], s_min=below)


def _fin_alpha(x: Mapping[str, Any]) -> Array:
    return np.asarray(x["opacity"] * x["mask"] * x["height"] ** 2)


def _fin_direction(x: Mapping[str, Any]) -> Array:
    return _unit(x["n"] + x["comb"] + x["force"])


def _fin_strand_mask(x: Mapping[str, Any]) -> Array:
    """A fin shows the hairs of the coat at a quarter, half and three quarters of the depth of its row."""
    hairs = {name: x[name] for name in ("height", "density", "thickness", "seed")}
    slices = []
    for share in (0.25, 0.5, 0.75):
        depth = (x["row"] + share) / np.floor(x["density"])
        slices.append(_value("shell_strand_mask", uv=np.stack([x["along"], depth], axis=-1), **hairs))
    return np.asarray(np.maximum.reduce(slices))


def _shell_tangent(x: Mapping[str, Any]) -> Array:
    """The way that the tip of the curve takes as the height grows."""

    def place(height: Array) -> Array:
        h = height[:, None]
        return h * _unit(x["n"] + h * x["comb"] + h * h * x["force"])

    return _unit((place(x["height"] + SLOPE) - place(x["height"] - SLOPE)) / (2.0 * SLOPE))


def _unit(v: Array) -> Array:
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.asarray(np.where(length > SHORT, v / np.maximum(length, SHORT), np.nan))


def _turn_of(x: Mapping[str, Any]) -> Array:
    return np.asarray(np.arctan2(x["y"] + 0.0, x["x"] + 0.0) / (2.0 * np.pi))  # no negative zeros


def _across_share(x: Mapping[str, Any]) -> Array:
    return np.asarray(np.clip(0.5 + 2.0 * _turn_of({"y": x["w"][:, 1], "x": x["w"][:, 2]}), 0.0, 1.0))


def _ggx_visible_area(x: Mapping[str, Any]) -> Array:
    """w.z + |stretched w|; the difference of the two by that of their squares."""
    across, height = np.hypot(x["alpha_x"] * x["w"][:, 0], x["alpha_y"] * x["w"][:, 1]), x["w"][:, 2]
    total = np.hypot(across, height) + np.abs(height)
    return np.asarray(np.maximum(np.where(height >= 0.0, total, across**2 / total), SMALLEST_AREA))


def _fur_directional_attenuation_mean(x: Mapping[str, Any]) -> Array:
    return np.asarray(0.5 * x["rho_reflect"] + 0.5 * x["rho_transmit"])


HIDDEN: Mapping[str, Formula] = {
    "turn_of": _turn_of,
    "across_share": _across_share,
    "ggx_visible_area": _ggx_visible_area,
    "fur_directional_attenuation_mean": _fur_directional_attenuation_mean,
}
"""Another function -> its formula."""
ALONE: Mapping[str, Formula] = {
    "thinned": _thinned,
    "coat_shadow": _coat_shadow,
    "fin_alpha": _fin_alpha,
    "fin_direction": _fin_direction,
    "fin_strand_mask": _fin_strand_mask,
    "shell_tangent": _shell_tangent,
}
"""Function that no other calls -> its formula; NaN where it says nothing."""
PARTS: Mapping[str, Formula] = {**ALONE, **HIDDEN}

UP, ALONG, NONE = np.array([[0.0, 0.0, 1.0]]), np.array([[0.0, 1.0, 0.0]]), np.zeros((1, 3))
DEGENERATE: Mapping[str, tuple[tuple[dict[str, Array], Array], ...]] = {
    "fin_direction": (({"n": UP, "comb": -UP, "force": NONE}, UP),),
    "shell_tangent": (
        ({"n": UP, "height": np.ones(1), "comb": -UP, "force": NONE}, -UP),
        ({"n": UP, "height": np.ones(1), "comb": NONE, "force": -UP}, -UP),
        ({"n": UP, "height": np.ones(1), "comb": -ALONG - UP, "force": ALONG}, (ALONG - UP) / np.sqrt(2.0)),
    ),
    "thinned": (({"thickness": np.array([0.7]), "share": np.ones(1)}, np.array([0.7])),),
}
"""Function -> inputs where its formula says nothing, and what is promised there."""


def passes(library: Library, name: str) -> bool:
    """Whether a part agrees with its formula, and is finite where that says nothing."""
    for given, promised in DEGENERATE.get(name, ()):
        got = np.asarray(evaluate(library, name, given, "float64"))
        if not (np.abs(got - promised) <= USUAL).all():
            return False
    for family in FAMILIES:
        inputs = draw(load_library().function(name), family, COUNT, SEED).inputs
        exact = {
            key: value.astype(np.float64) if value.dtype.kind == "f" else value
            for key, value in inputs.items()
        }
        got = np.asarray(evaluate(library, name, exact, "float64"))
        wanted = PARTS[name](exact)
        off = np.abs(got - wanted) / (np.abs(wanted) if name in RELATIVE else 1.0)
        if not np.isfinite(got).all() or (off[~np.isnan(off)] > NEAR.get(name, USUAL)).any():
            return False
    return True
