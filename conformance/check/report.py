"""Results as lines for people: details of few functions, failures in full, one summary per backend."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from conformance.check.accuracy import Accuracy
from conformance.check.failure import FINITE, PERMITTED, WITHIN
from conformance.check.interval import OUTSIDE, UNGUARANTEED
from conformance.check.result import BoundResult, FunctionResult

MARGIN = 15
"""Columns before what a verdict says."""
LONGEST = 240
"""Characters of a worst input that are shown; files of --json hold all of it."""


def lines(results: Sequence[FunctionResult], details: bool) -> list[str]:
    """The whole report."""
    told: list[str] = []
    if details:
        for name in dict.fromkeys(r.function for r in results):
            told += _function([r for r in results if r.function == name])
    told += _known(results)
    for r in results:
        if r.accepted:
            continue
        if r.broken:
            told.append(f"FAILED    {r.function} on {r.backend}: {r.broken}")
        for failure in r.failures:
            told.append("FAILED    " + "\n          ".join(failure.lines()))
        told += _uncounted(r)
    return told + _summaries(results)


def _function(results: Sequence[FunctionResult]) -> list[str]:
    """One function on every backend."""
    told = [results[0].function]
    for r in results:
        told.append(f"  {r.backend}: {r.driver}")
        if not r.broken:
            told += [f"    {line}" for line in verdict_lines(r)]
    return [*told, ""]


def verdict_lines(r: FunctionResult) -> list[str]:
    """Both verdicts and the accuracy of one result that was judged."""
    told = [_row(PERMITTED, interval_text(r))]
    told += _under(WITHIN, [bound_text(b) for b in r.bounds if b.lanes])
    told.append(_row("accuracy", accuracy_text(r.accuracy[0]) if r.accuracy else "nothing was measured"))
    told += [_row("", accuracy_text(a)) for a in r.accuracy[1:]]
    if r.accuracy and r.accuracy[0].worst:
        worst = r.accuracy[0].worst
        told.append(_row("worst input", worst if len(worst) <= LONGEST else f"{worst[:LONGEST]}..."))
    shares = (
        f"NO: {r.non_finite} of {r.lanes} results are not" if r.non_finite else f"yes: all {r.lanes} results"
    )
    told.append(_row(FINITE, shares))
    only = []
    if r.uncovered:
        only.append(f"{share(r.uncovered, r.lanes)} outside the domain of every declared bound")
    if r.ambiguous:
        only.append(f"{share(r.ambiguous, r.lanes)} where rounding decides between two documented values")
    return [*told, *([_row("not measured", ", ".join(only))] if only else [])]


def interval_text(r: FunctionResult) -> str:
    """The verdict "permitted" in words."""
    i = r.permitted
    if i is None:
        return "not judged"
    open_ = f"; {share(i.unguaranteed, r.lanes)} unguaranteed: the table bounds no result there"
    tail = open_ if i.unguaranteed else ""
    if i.rearranged:
        tail += f"; {i.rearranged} only after a rearrangement that the specification allows"
    if i.verdict == UNGUARANTEED:
        return f"UNGUARANTEED: the {i.table} table bounds no result at all"
    if i.verdict == OUTSIDE:
        return f"NO: {i.outside} of {i.lanes} results are outside what the {i.table} table permits{tail}"
    return f"yes: all {i.lanes} results are inside what the {i.table} table permits{tail}"


def bound_text(b: BoundResult) -> str:
    """One declared bound in words."""
    if not b.limit:
        return f"{'NO' if b.failures else 'yes'}: {b.bound}"
    used = b.measured / b.limit
    if b.failures:
        return f"NO: {b.failures} of {b.lanes} results miss {b.bound}; largest {b.measured:.3g}"
    return f"yes: {b.measured:.3g} is {100.0 * used:.0f} % of {b.bound}"


def accuracy_text(a: Accuracy) -> str:
    """One distribution of errors in words."""
    if not a.lanes:
        return f"{a.unit}: no result to measure"
    return f"{a.unit}: maximum {a.maximum:.3g}, p99.9 {a.p999:.3g}, median {a.median:.3g}"


def share(count: int, of: int) -> str:
    """A count as a percentage that is 0 or 100 only where it is exactly."""
    if count in (0, of):
        return "0 %" if not count else "100 %"
    percent = 100.0 * count / of
    return f"{min(percent, 99.99):.2g} %" if percent < 99.0 else f"{min(percent, 99.99):.2f} %"


def _row(what: str, text: str) -> str:
    return f"{what:{MARGIN - 2}} {text}"


def _under(what: str, texts: Sequence[str]) -> list[str]:
    return [
        _row(what if not k else "", text) for k, text in enumerate(texts or ["no input is inside a bound"])
    ]


def _known(results: Iterable[FunctionResult]) -> list[str]:
    """Failures that were expected, those of one reason in one line."""
    found: dict[tuple[str, str, str], list[str]] = {}
    for r in results:
        for verdict in r.failed:
            if verdict in r.known:
                found.setdefault((r.backend, verdict, r.known[verdict]), []).append(r.function)
    return [
        f'known     not "{verdict}" on {backend}: {", ".join(names)}: {reason}'
        for (backend, verdict, reason), names in found.items()
    ]


def _uncounted(r: FunctionResult) -> list[str]:
    """How many results failed beside those that are reported in full."""
    outside = r.permitted.outside if r.permitted is not None else 0
    counts = {
        FINITE: r.non_finite,
        PERMITTED: outside,
        WITHIN: max((b.failures for b in r.bounds), default=0),
    }
    if sum(counts.values()) <= len(r.failures):
        return []
    told = ", ".join(f'{count} not "{name}"' for name, count in counts.items() if count)
    return [f"          {r.function} on {r.backend}: of {r.lanes} results {told}; the worst are above"]


def _summaries(results: Sequence[FunctionResult]) -> list[str]:
    width = max((len(r.backend) for r in results), default=9)
    told = []
    for name in dict.fromkeys(r.backend for r in results):
        own = [r for r in results if r.backend == name]
        lanes = sum(r.lanes for r in own)
        open_ = sum(r.permitted.unguaranteed for r in own if r.permitted is not None)
        known = sum(bool(r.failed) and r.accepted for r in own)
        counts = [
            f"{PERMITTED} {sum(r.interval_verdict == PERMITTED for r in own)}",
            f"{WITHIN} {sum(r.within for r in own)}",
            f"{FINITE} {sum(not r.non_finite and not r.broken for r in own)}",
        ]
        known_too = f" ({known} with a known failure)" if known else ""
        open_too = f", {share(open_, lanes)} of them unguaranteed" if open_ else ""
        functions = f"{len(own)} functions" if len(own) > 1 else "1 function"
        told.append(
            f"{name.ljust(width)} of {functions}: {', '.join(counts)}{known_too}; {lanes} inputs{open_too}; "
            f"{sum(r.seconds for r in own):.1f} s  ({own[0].driver})"
        )
    return told
