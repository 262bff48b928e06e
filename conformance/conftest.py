"""Fixtures for tests that need a device; and what all test runs share."""

import atexit
import gc
from collections.abc import Generator

import pytest

from conformance.memory import give_back
from conformance.unit.support.drivers import need
from targets import TARGETS, TargetUnavailable, TimedRuntime, forget_programs, open_runtime, probe


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_collection() -> Generator[None, object, object]:
    """Collect without looking for garbage, and never look at what was collected.

    Thousands of tests and the modules behind them stay to the end; searching them again and again for circles
    that nobody holds takes a good part of a run. At exit all is given back: some libraries count their
    objects then, and report what is left.
    """
    gc.disable()
    atexit.register(gc.unfreeze)
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """Between two files of tests, drop the first one's programs and give back what was freed."""
    if nextitem is None or nextitem.path != item.path:
        forget_programs()
        give_back()


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
