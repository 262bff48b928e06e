"""Results as JUnit XML, for CI systems: one test case for each verdict on each function."""

from __future__ import annotations

import io
from collections.abc import Iterable

from junitparser import Failure as JUnitFailure
from junitparser import JUnitXml, Skipped, TestCase, TestSuite

from conformance.check.failure import FINITE, PERMITTED, WITHIN
from conformance.check.interval import UNGUARANTEED
from conformance.check.report import accuracy_text, interval_text
from conformance.check.result import NOT_JUDGED, FunctionResult


def junit_bytes(results: Iterable[FunctionResult], missing: Iterable[str]) -> bytes:
    """One suite per backend; a missing one is a suite with one skipped case that says why.

    Every function is two cases: `NAME [within bound]`, which holds finiteness too, and `NAME [permitted]`.
    What was expected to fail, and what a table does not bound at all, is skipped with the reason.
    """
    xml = JUnitXml()
    suites: dict[str, TestSuite] = {}
    for r in results:
        suite = suites.setdefault(r.backend or r.target, TestSuite(f"vair.{r.backend or r.target}"))
        for verdict in (WITHIN, PERMITTED):
            suite.add_testcase(_case(r, verdict))
    for sentence in missing:
        target = sentence.split(":")[0]
        suite = suites.setdefault(target, TestSuite(f"vair.{target}"))
        case = TestCase("driver", f"vair.{target}")
        case.result = [Skipped(sentence)]
        suite.add_testcase(case)
    for suite in suites.values():
        xml.add_testsuite(suite)
    out = io.BytesIO()
    xml.write(out)
    return out.getvalue()


def _case(r: FunctionResult, verdict: str) -> TestCase:
    seconds = round(r.seconds, 3) if verdict == WITHIN else 0.0
    case = TestCase(f"{r.function} [{verdict}]", f"vair.{r.backend or r.target}", seconds)
    names = (FINITE, WITHIN) if verdict == WITHIN else (PERMITTED,)
    bad = [name for name in names if name in r.failed]
    if bad and all(name in r.known for name in bad):
        case.result = [Skipped(f"known failure: {r.known[bad[0]]}")]
    elif bad:
        told = [f for f in r.failures if set(f.failed) & set(bad)]
        text = "\n\n".join("\n".join(f.lines()) for f in told) or r.broken or interval_text(r)
        case.result = [JUnitFailure(text.splitlines()[0])]
        case.result[0].text = text
    elif verdict == PERMITTED and r.interval_verdict in (UNGUARANTEED, NOT_JUDGED):
        case.result = [Skipped(interval_text(r))]
    case.system_out = "\n".join(
        [interval_text(r)] if verdict == PERMITTED else [accuracy_text(a) for a in r.accuracy]
    )
    return case
