"""Fixtures for tests that need a device."""

import pytest

from conformance.unit.support.drivers import need
from targets import TARGETS, TargetUnavailable, TimedRuntime, open_runtime, probe


@pytest.fixture(scope="session", params=TARGETS)
def target(request: pytest.FixtureRequest) -> str:
    """Name of a target whose device is open; without a driver the test is skipped and says why."""
    name: str = request.param
    need(name)
    return name


def available_targets() -> list[str]:
    """Names of the targets whose driver is here."""
    return [name for name in TARGETS if not isinstance(probe(name), TargetUnavailable)]


@pytest.fixture(scope="session")
def runtime(target: str) -> TimedRuntime:
    """The runtime of the target."""
    return open_runtime(target)
