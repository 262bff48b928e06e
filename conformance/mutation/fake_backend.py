"""A backend that is wrong on purpose: the evaluator with one stated deviation, legal or not.

deviations.toml plans the verdict on each; test_fake_backend.py holds the judges to it.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any
from unittest import mock

import numpy as np
import numpy.typing as npt

from codegen.evaluate import evaluate
from codegen.library import Library
from codegen.ops import BUILTINS, OPERATORS
from conformance.check.engine import Backend

Array = npt.NDArray[Any]
Meanings = Mapping[str, Callable[..., Any]]

SMALLEST_NORMAL = np.float32(2.0**-126)
RARE = 997
"""One lane of so many is spoilt by the deviations that are rare."""
CHUNK = 8
"""The last of so many parts is lost by a backend that drops its last chunk."""
SINE_ERROR = 1.9e-4
"""Absolute error of the sine of a software driver in use, which WGSL permits (2^-11)."""


def ulps(k: int, a: Array) -> Array:
    """k floats further from zero."""
    if a.dtype != np.float32:
        return a
    return np.where(np.isfinite(a) & (a != 0.0), (a.view(np.int32) + k).view(np.float32), a)


def _rare(value: float, a: Array) -> Array:
    if a.dtype != np.float32:
        return a
    spoilt = a.copy()
    spoilt[RARE // 2 :: RARE] = value
    return spoilt


def _last_chunk_lost(a: Array) -> Array:
    kept = a.copy()
    kept[len(a) - max(len(a) // CHUNK, 1) :] = 0
    return kept


def _zero_signs(a: Array) -> Array:
    return np.where(a == 0.0, -a, a) if a.dtype == np.float32 else a


def _flushed(a: Array) -> Array:
    return np.where(np.abs(a) < SMALLEST_NORMAL, np.float32(0), a) if a.dtype == np.float32 else a


AFTER: dict[str, Callable[[Array], Array]] = {
    "faithful": lambda a: a,
    "one ULP off": lambda a: ulps(1, a),
    "a thousand ULP off": lambda a: ulps(1000, a),
    "a million ULP off": lambda a: ulps(1_000_000, a),
    "denormals flushed": _flushed,
    "signs of zero exchanged": _zero_signs,
    "sign lost": np.abs,
    "sign exchanged": np.negative,
    "rare NaN": lambda a: _rare(np.nan, a),
    "rare infinity": lambda a: _rare(np.inf, a),
    "rare zero": lambda a: _rare(0.0, a),
    "one lane late": lambda a: np.roll(a, 1, axis=0),
    "last chunk lost": _last_chunk_lost,
}
"""What happens to a result, array by array."""


def _other_way(exact: Callable[..., Any]) -> Callable[..., Any]:
    """The operation rounded to the float32 on the other side of the exact value."""

    def meaning(m: Any, *operands: Any) -> Any:
        if any(np.asarray(a).dtype != np.float32 for a in operands):
            return exact(*operands)
        wide = exact(*(a.astype(np.float64) for a in operands))
        near = wide.astype(np.float32)
        toward = np.where(wide > near, np.inf, -np.inf).astype(np.float32)
        return np.where((wide == near) | ~np.isfinite(near), near, np.nextafter(near, toward))

    return meaning


_sum, _difference, _product, _quotient, _root = map(
    _other_way, (np.add, np.subtract, np.multiply, np.divide, np.sqrt)
)


def _dot_the_other_way(m: Any, a: Any, b: Any) -> Any:
    total = _product(m, a[..., 0], b[..., 0])
    for k in range(1, a.shape[-1]):
        total = _sum(m, total, _product(m, a[..., k], b[..., k]))
    return total


def _cross_the_other_way(m: Any, a: Any, b: Any) -> Any:
    def component(j: int, k: int) -> Any:
        return _difference(m, _product(m, a[..., j], b[..., k]), _product(m, a[..., k], b[..., j]))

    return m.stack([component(1, 2), component(2, 0), component(0, 1)], axis=-1)


def _backwards(m: Any, a: Any, b: Any) -> Any:
    """A dot product summed from its last component on."""
    total = a[..., -1] * b[..., -1]
    for k in range(a.shape[-1] - 2, -1, -1):
        total = total + a[..., k] * b[..., k]
    return total


WITHIN: dict[str, Meanings] = {
    "sums backwards": {
        "dot": _backwards,
        "length": lambda m, x: m.sqrt(_backwards(m, x, x)),
        "normalize": lambda m, x: m.divide(x, m.sqrt(_backwards(m, x, x))[..., None]),
    },
    "rounds the other way": {
        "+": _sum,
        "-": _difference,
        "*": _product,
        "/": _quotient,
        "sqrt": _root,
        "dot": _dot_the_other_way,
        "cross": _cross_the_other_way,
        "length": lambda m, x: _root(m, _dot_the_other_way(m, x, x)),
        "normalize": lambda m, x: _quotient(m, x, _root(m, _dot_the_other_way(m, x, x))[..., None]),
    },
    "poor sine": {"sin": lambda m, x: m.sin(x) + np.float32(SINE_ERROR)},
    "sine worse than permitted": {"sin": lambda m, x: m.sin(x) + np.float32(4.0 * SINE_ERROR)},
    "max gives the smaller": {"max": lambda m, x, y: m.minimum(x, y)},
    "half precision products": {"*": lambda m, a, b: (a * b).astype(np.float16).astype((a * b).dtype)},
}
"""What operations mean to the backend."""

DEVIATIONS = (*AFTER, *WITHIN)


def _mapped(change: Callable[[Array], Array], value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _mapped(change, v) for name, v in value.items()}
    return change(np.asarray(value))


@contextlib.contextmanager
def _meaning(changed: Meanings) -> Iterator[None]:
    """While open, operations mean something else."""
    with contextlib.ExitStack() as stack:
        for table in (OPERATORS, BUILTINS):
            rows = {name: replace(table[name], meaning=m) for name, m in changed.items() if name in table}
            stack.enter_context(mock.patch.dict(table, rows))
        yield


def fake_backend(deviation: str) -> Backend:
    """The backend that deviates in this way; KeyError for an unknown one."""

    def run(library: Library, name: str, inputs: Mapping[str, Any]) -> Any:
        if deviation in AFTER:
            return _mapped(AFTER[deviation], evaluate(library, name, inputs))
        with _meaning(WITHIN[deviation]), np.errstate(all="ignore"):
            return evaluate(library, name, inputs)

    if deviation not in DEVIATIONS:
        raise KeyError(deviation)
    return Backend("numpy", f"a fake: {deviation}", run)
