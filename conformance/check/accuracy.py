"""How far results are from the reference, in a measure that tells something: beside the verdicts, no verdict.

A verdict alone hides that a driver became worse and stayed inside; so every result carries the distribution
of its errors. accuracy.toml says which function is measured how.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.ir.nodes import Function
from codegen.ir.types import F32, Vector
from conformance.check import measure, show
from conformance.check.sample import Sample
from conformance.picture.tone import STEPS, srgb_encode

TABLE = Path(__file__).with_name("accuracy.toml")
ULP, RELATIVE, CODE_STEPS, DIFFERENCE = "ULP", "relative", "8-bit steps", "difference"

Doubles = npt.NDArray[np.float64]


@dataclass
class Accuracy:
    """The errors of one function in one measure.

    measure  ULP (Muller's), relative (to the larger of floor and the largest component), 8-bit steps of an
             sRGB code (not rounded), or difference (of whole numbers)
    lanes    results that were measured: finite, not ambiguous, in the domain of a declared bound
    worst    the input of the largest error
    """

    measure: str
    floor: float = 0.0
    lanes: int = 0
    maximum: float = 0.0
    p999: float = 0.0
    median: float = 0.0
    worst: str = ""

    @property
    def unit(self) -> str:
        """The measure with its floor."""
        return f"{self.measure} (floor {self.floor:g})" if self.floor else self.measure


@cache
def _table() -> dict[str, Any]:
    return tomllib.loads(TABLE.read_text(encoding="utf-8"))


def measures_of(function: Function) -> list[Accuracy]:
    """In what the errors of a function are told: one measure, and code steps beside it for shades."""
    returns = function.returns.element if isinstance(function.returns, Vector) else function.returns
    if getattr(returns, "name", "") in ("i32", "u32", "bool"):
        return [Accuracy(DIFFERENCE)]
    scalars = [p for p in function.parameters if p.type == F32]
    if len(function.parameters) == len(scalars) == 1 and function.returns == F32:
        found = [Accuracy(ULP)]
    else:
        found = [Accuracy(RELATIVE, _table()["relative"]["floor"])]
    if any(fnmatchcase(function.name, glob) for glob in _table()["shades"]["functions"]):
        found.append(Accuracy(CODE_STEPS))
    return found


def measured(
    function: Function, sample: Sample, got: Any, expected: Any, use: npt.NDArray[np.bool_]
) -> list[Accuracy]:
    """The distribution of errors over the lanes to use, in every measure of the function."""
    found = measures_of(function)
    lanes = np.flatnonzero(use)
    if not len(lanes):
        return found
    for a in found:
        errors = error(a, got, expected)[lanes]
        worst = int(np.argmax(errors))
        a.lanes, a.maximum, a.worst = (
            len(lanes),
            float(errors[worst]),
            show.lane_inputs(sample.inputs, int(lanes[worst])),
        )
        # One of the errors, not a value between two of them: infinite ones have no difference.
        a.p999 = float(np.quantile(errors, 0.999, method="higher"))
        a.median = float(np.quantile(errors, 0.5, method="lower"))
    return found


def error(how: Accuracy, got: Any, expected: Any) -> Doubles:
    """The error per lane: the largest of all components and fields."""
    worst: Doubles | None = None
    wanted = dict(measure.fields(expected))
    for name, a in measure.fields(got):
        e = _error(how, a, np.asarray(wanted[name]))
        worst = e if worst is None else np.maximum(worst, e)
    assert worst is not None
    return worst


def _error(how: Accuracy, got: npt.NDArray[Any], expected: npt.NDArray[Any]) -> Doubles:
    g, x = got.astype(np.float64), expected.astype(np.float64)
    with np.errstate(all="ignore"):
        if how.measure == ULP and got.dtype == np.float32:
            e = measure.ulps(got, x)
        elif how.measure == CODE_STEPS:
            e = STEPS * np.abs(srgb_encode(g) - srgb_encode(x))
        elif how.measure == RELATIVE and got.dtype == np.float32:
            size = np.abs(x).max(axis=-1, keepdims=True) if x.ndim == 2 else np.abs(x)
            e = np.abs(g - x) / np.maximum(size, how.floor)
        else:
            e = np.abs(g - x)
    e = np.where(g == x, 0.0, np.where(np.isnan(e), np.inf, e))
    return np.asarray(e.max(axis=-1) if e.ndim == 2 else e)
