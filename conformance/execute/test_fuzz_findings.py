"""What random programs once found has a verdict on every target: permitted, or permitted once rearranged.

Plan. fuzz_findings.toml holds each finding as a reduced function with its inputs in hex. All are executed on
every target that is here and judged as the random programs are.
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.execute import execute
from conformance.programs import judge
from conformance.programs.rearranged import explained
from conformance.unit.support.drivers import need
from conformance.unit.support.sources import library_of
from targets import TARGETS, open_runtime

FINDINGS: dict[str, dict[str, Any]] = tomllib.loads(
    (Path(__file__).parent / "fuzz_findings.toml").read_text(encoding="utf-8")
)


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", FINDINGS)
def test_finding_has_a_verdict(name: str, target: str, tmp_path: Path) -> None:
    need(target)
    finding = FINDINGS[name]
    library = library_of(tmp_path, finding["source"])
    inputs = {
        parameter: np.array([int(word, 16) for word in words], np.uint32).view(np.float32)
        for parameter, words in finding["inputs"].items()
    }
    got = execute(library, "probe", inputs, open_runtime(target))
    wrong = judge.judge(judge.intervals(library, "probe", inputs, target), got).wrong
    wrong &= ~explained(library, "probe", inputs, target, got)
    assert not wrong.any(), f"{finding['found']}: {finding['why']}: lanes {np.flatnonzero(wrong)}"
