"""The verdict "permitted": every result against the interval that the target's specification allows it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.intervals import DEFAULT_TABLES, Permitted
from codegen.library import Library
from conformance.check import show
from conformance.check.backend import Backend
from conformance.check.sample import Sample, rows
from conformance.programs.rearranged import explained

PERMITTED, OUTSIDE, UNGUARANTEED = "permitted", "outside", "unguaranteed"
CAUSES = 3
"""Causes of missing guarantees that a result names."""

Mask = npt.NDArray[np.bool_]
Doubles = npt.NDArray[np.float64]


@dataclass
class IntervalResult:
    """The results of one function against the intervals of one accuracy table.

    lanes         results that the table bounds
    inside        of these, the ones inside their interval
    rearranged    outside as written, but inside after a rearrangement that the specification allows
    outside       not permitted
    unguaranteed  results that the table does not bound; they count for nothing
    excess        how far out the worst one is: its distance from the middle of its interval over half the
                  interval's width; infinite for a result that had to be exact, or is not finite
    worst         its input
    causes        why results are not bounded -> number of them, the most frequent causes
    """

    table: str
    lanes: int = 0
    inside: int = 0
    rearranged: int = 0
    outside: int = 0
    unguaranteed: int = 0
    excess: float = 0.0
    worst: str = ""
    causes: dict[str, int] = field(default_factory=dict)

    @property
    def verdict(self) -> str:
        """OUTSIDE if any result is, PERMITTED if all that are bounded are inside, UNGUARANTEED if none is."""
        if self.outside:
            return OUTSIDE
        return PERMITTED if self.lanes else UNGUARANTEED

    @property
    def unguaranteed_share(self) -> float:
        return self.unguaranteed / max(self.lanes + self.unguaranteed, 1)


@dataclass(frozen=True)
class IntervalVerdict:
    """Lane by lane: `outside` is not permitted, by `excess` (0 elsewhere)."""

    result: IntervalResult
    outside: Mask
    excess: Doubles


def judge(
    library: Library, name: str, sample: Sample, got: Any, allowed: Permitted, on: Backend
) -> IntervalVerdict:
    """Results of a backend against the intervals of its table."""
    outside = ~allowed.contains(got)
    rearranged = np.zeros_like(outside)
    if outside.any():
        lanes = np.flatnonzero(outside)
        rearranged[lanes] = _explained(library, name, sample, got, lanes, on)
        outside &= ~rearranged
    sure = allowed.guaranteed
    found = IntervalResult(
        on.judged_by,
        lanes=int(sure.sum()),
        inside=int((sure & ~outside & ~rearranged).sum()),
        rearranged=int(rearranged.sum()),
        outside=int(outside.sum()),
        unguaranteed=int((~sure).sum()),
        causes={str(cause): count for cause, count in list(allowed.histogram().items())[:CAUSES]},
    )
    beyond = np.zeros(len(outside))
    if outside.any():
        lanes = np.flatnonzero(outside)
        beyond[lanes] = excess(rows(allowed.low, lanes), rows(allowed.high, lanes), rows(got, lanes))
        worst = int(lanes[np.argmax(beyond[lanes])])
        found.excess, found.worst = float(beyond[worst]), show.lane_inputs(sample.inputs, worst)
    return IntervalVerdict(found, outside, beyond)


def _explained(
    library: Library, name: str, sample: Sample, got: Any, lanes: npt.NDArray[np.intp], on: Backend
) -> Mask:
    """Which of these lanes a rearrangement explains that the specification allows."""
    table = on.judged_by if on.target in DEFAULT_TABLES else ""
    return explained(library, name, rows(sample.inputs, lanes), on.target, rows(got, lanes), table)


def excess(low: Any, high: Any, got: Any) -> Doubles:
    """Distance from the middle of the interval over half its width, per lane: of the worst component."""
    worst: Doubles | None = None
    for a, b, x in zip(_columns(low), _columns(high), _columns(got), strict=True):
        with np.errstate(all="ignore"):
            half = (b - a) / 2.0
            share = np.abs(x - (a + half)) / half
            share = np.where((x >= a) & (x <= b), np.minimum(np.nan_to_num(share), 1.0), share)
        share = np.where(np.isnan(share), np.inf, share)
        worst = share if worst is None else np.maximum(worst, share)
    assert worst is not None
    return worst


def _columns(value: Any) -> Iterator[Doubles]:
    if isinstance(value, dict):
        for part in value.values():
            yield from _columns(part)
        return
    a = np.asarray(value).astype(np.float64)
    if a.ndim == 2:
        yield from (a[:, k] for k in range(a.shape[1]))
    else:
        yield a
