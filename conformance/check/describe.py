"""A failing lane as a record: what came out, what was expected, and what was permitted."""

from __future__ import annotations

from typing import Any

import numpy as np

from codegen.evaluate import evaluate
from conformance import cases
from conformance.check import measure, show
from conformance.check.backend import Backend
from conformance.check.failure import Failure, Missed
from conformance.check.identity import Identity
from conformance.check.prepared import Prepared
from conformance.check.sample import rows

DIGITS = 50
"""Digits in which a failing lane's program is evaluated once more."""
SHOWN_DIGITS = 17


def describe(
    ready: Prepared,
    on: Backend,
    lane: int,
    failed: tuple[str, ...],
    got: Any,
    missed: tuple[Missed, ...],
    excess: float | None,
) -> Failure:
    """The record of a lane; excess is None where no interval judged it."""
    sample, expected = ready.sample, ready.truth.expected
    from_, number = sample.origin(lane)
    judged: dict[str, Any] = {}
    if excess is not None:
        allowed = ready.permitted(on.judged_by)
        sure = bool(allowed.guaranteed[lane])
        judged = {
            "table": on.judged_by,
            "excess": excess,
            "interval": between(allowed.low, allowed.high, lane)
            if sure
            else f"anything ({allowed.cause(lane)})",
            "low": plain(allowed.low, lane),
            "high": plain(allowed.high, lane),
        }
    return Failure(
        identity=Identity(ready.name, on.name or on.target, from_.family, from_.count, from_.seed, number),
        driver=on.driver,
        failed=failed,
        inputs=show.lane_inputs(sample.inputs, lane),
        words=cases.words(ready.function, sample.inputs, lane),
        got=show.one(got, lane),
        expected=show.one(expected, lane),
        exact=exact(ready, lane),
        distance=distance(got, expected, lane),
        missed=missed,
        **judged,
    )


def between(low: Any, high: Any, lane: int) -> str:
    """The interval of one lane: `0.1 to 0.2`, per component for vectors and fields of structs."""
    if isinstance(low, dict):
        return "{" + ", ".join(f"{name}: {between(v, high[name], lane)}" for name, v in low.items()) + "}"
    ends = zip(np.atleast_1d(low[lane]), np.atleast_1d(high[lane]), strict=True)
    parts = [f"{a:.9g} to {b:.9g}" if a.dtype.kind == "f" else f"{a} to {b}" for a, b in ends]
    return parts[0] if len(parts) == 1 else f"({', '.join(parts)})"


def plain(value: Any, lane: int) -> Any:
    """One lane as numbers, lists and objects."""
    if isinstance(value, dict):
        return {name: plain(v, lane) for name, v in value.items()}
    return np.asarray(value)[lane].tolist()


def exact(ready: Prepared, lane: int) -> str:
    """The value of the function's own program for one lane, without rounding; empty where it has none."""
    import mpmath

    one = rows(ready.sample.inputs, np.array([lane]))
    with mpmath.workdps(DIGITS):
        try:
            value = evaluate(ready.library, ready.name, one, "mpmath")
        except (ValueError, ZeroDivisionError, OverflowError, TypeError):
            return ""
        return _precise(value)


def _precise(value: Any) -> str:
    import mpmath

    if isinstance(value, dict):
        return "{" + ", ".join(f"{name}: {_precise(v)}" for name, v in value.items()) + "}"
    parts = [
        mpmath.nstr(x, SHOWN_DIGITS) if isinstance(x, mpmath.mpf) else str(x)
        for x in np.asarray(value).ravel()
    ]
    return parts[0] if len(parts) == 1 else f"({', '.join(parts)})"


def distance(got: Any, expected: Any, lane: int) -> str:
    """How far a result is from the expected value in ULP, field by field; empty for whole numbers."""
    wanted = dict(measure.fields(expected))
    told = []
    for name, a in measure.fields(got):
        if a.dtype.kind == "f":
            worst = np.max(measure.ulps(a[lane : lane + 1], wanted[name][lane : lane + 1]))
            told.append(f"{name + ' ' if name else ''}{worst:.4g} ULP")
    return ", ".join(told)
