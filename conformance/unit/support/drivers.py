"""Skips tests whose drivers are missing, unless the environment requires them."""

import os

import pytest

from targets import TargetUnavailable, probe

REQUIRED_VARIABLE = "VAIR_REQUIRE_TARGETS"
"""Names of targets, separated by commas, whose missing driver is a failure instead of a skip."""


def need(*targets: str) -> None:
    """Skip the test where a target has no driver, and say why; fail where that target is required."""
    for name in targets:
        answer = probe(name)
        if isinstance(answer, TargetUnavailable):
            reason = f"{name}: {answer}"
            if name in required_targets():
                pytest.fail(
                    f"{REQUIRED_VARIABLE} names a target that cannot run here; {reason}", pytrace=False
                )
            pytest.skip(reason)


def required_targets() -> list[str]:
    """Targets that the environment requires."""
    return [name.strip() for name in os.environ.get(REQUIRED_VARIABLE, "").split(",")]
