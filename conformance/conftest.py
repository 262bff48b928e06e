"""Fixtures for tests that need a device."""

import os

import pytest

from targets import TARGETS, TargetUnavailable, TimedRuntime, open_runtime, probe

REQUIRED_VARIABLE = "VAIR_REQUIRE_TARGETS"
"""Names of targets, separated by commas, whose missing driver is a failure instead of a skip."""


@pytest.fixture(scope="session", params=TARGETS)
def target(request: pytest.FixtureRequest) -> str:
    """Name of a target whose device is open; without a driver the test is skipped and says why."""
    name: str = request.param
    answer = probe(name)
    if isinstance(answer, TargetUnavailable):
        reason = f"{name}: {answer}"
        if name in required_targets():
            pytest.fail(f"{REQUIRED_VARIABLE} names a target that cannot run here; {reason}", pytrace=False)
        pytest.skip(reason)
    return name


def available_targets() -> list[str]:
    """Names of the targets whose driver is here."""
    return [name for name in TARGETS if not isinstance(probe(name), TargetUnavailable)]


@pytest.fixture(scope="session")
def runtime(target: str) -> TimedRuntime:
    """The runtime of the target."""
    return open_runtime(target)


def required_targets() -> list[str]:
    """Targets that the environment requires."""
    return [name.strip() for name in os.environ.get(REQUIRED_VARIABLE, "").split(",")]
