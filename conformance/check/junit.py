"""Results as JUnit XML, for CI systems."""

from __future__ import annotations

import io
from collections.abc import Iterable

from junitparser import Failure as JUnitFailure
from junitparser import JUnitXml, Skipped, TestCase, TestSuite

from conformance.check.result import FunctionResult


def junit_bytes(results: Iterable[FunctionResult], missing: Iterable[str]) -> bytes:
    """One suite per target; a missing target is a suite with one skipped case that says why."""
    xml = JUnitXml()
    suites: dict[str, TestSuite] = {}
    for r in results:
        suite = suites.setdefault(r.target, TestSuite(f"vair.{r.target}"))
        case = TestCase(r.function, f"vair.{r.target}", round(r.seconds, 3))
        if not r.passed:
            text = "\n\n".join("\n".join(f.lines()) for f in r.failures) or r.broken
            case.result = [JUnitFailure(text.splitlines()[0])]
            case.result[0].text = text
        suite.add_testcase(case)
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
