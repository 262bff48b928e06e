"""Errors of results against references, lane by lane, in a bound's own measure."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound

Array = npt.NDArray[Any]
Value = Any  # an array, or a dict of arrays for structs


def fields(value: Value, field: str = "") -> list[tuple[str, Array]]:
    """The arrays of a value with their field names; one nameless entry for a value that is no struct."""
    if not isinstance(value, dict):
        return [("", np.asarray(value))]
    found = [(name, np.asarray(v)) for name, v in value.items()]
    return [f for f in found if f[0] == field] if field else found


def finite(value: Value) -> npt.NDArray[np.bool_]:
    """Mask of the lanes whose every component is finite."""
    masks = []
    for _, a in fields(value):
        ok = np.isfinite(a) if a.dtype.kind == "f" else np.ones(a.shape, np.bool_)
        masks.append(ok.all(axis=-1) if ok.ndim == 2 else ok)
    return np.asarray(np.logical_and.reduce(masks), np.bool_)


def error(bound: Bound, got: Value, expected: Value) -> npt.NDArray[np.float64]:
    """The error per lane in the bound's measure; infinite where the result is not finite."""
    wanted = dict(fields(expected, bound.field))
    worst: npt.NDArray[np.float64] | None = None
    for name, a in fields(got, bound.field):
        e = _error(bound, a, wanted[name])
        worst = e if worst is None else np.maximum(worst, e)
    if worst is None:
        raise KeyError(f"{bound.function}: a bound speaks of an unknown field {bound.field}")
    return worst


def _error(bound: Bound, got: Array, expected: Array) -> npt.NDArray[np.float64]:
    if bound.measure == "exact":
        same = got == expected if got.dtype.kind in "iub" else got == np.asarray(expected).astype(got.dtype)
        e = np.where(same, 0.0, np.inf)
        return e.max(axis=-1) if e.ndim == 2 else e
    g, x = got.astype(np.float64), np.asarray(expected, np.float64)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        e = np.abs(g - x)
        if bound.measure == "relative":
            e = e / np.maximum(np.abs(x), bound.floor if bound.floor else 0.0)
            e = np.where(g == x, 0.0, e)
    e = np.where(np.isfinite(g), e, np.inf)
    return e.max(axis=-1) if e.ndim == 2 else e


def ulps(got: Array, expected: Array) -> npt.NDArray[np.float64]:
    """Distance in units of the spacing of float32 around the expected value (Muller's ULP)."""
    x = np.asarray(expected, np.float64)
    spacing = np.spacing(np.maximum(np.abs(x), 2.0**-126).astype(np.float32)).astype(np.float64)
    with np.errstate(invalid="ignore", over="ignore"):
        return np.asarray(np.abs(got.astype(np.float64) - x) / spacing)
