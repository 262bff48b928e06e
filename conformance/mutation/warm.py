"""A pytest session that has collected its tests and goes on to something else: forks run them at once."""

from __future__ import annotations

import contextlib
import importlib
import io
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import pytest

from conformance.mutation.isolated import AGAIN, NOTHING_NOTICED, QUIET
from conformance.mutation.seen import Selection
from conformance.mutation.swapped import Swap

Then = Callable[["Warm"], None]


@dataclass(frozen=True)
class Warm:
    """Collected tests, in a session that is under way."""

    session: pytest.Session

    def load(self, beginnings: Sequence[str]) -> bool:
        """Run the tests whose ids begin so, for what they load that forks then share; whether they pass."""
        chosen = [item for item in self.session.items if item.nodeid.startswith(tuple(beginnings))]
        return self._passes(chosen)

    def run(self, chosen: Sequence[str], swap: Swap) -> int:
        """Run the chosen tests with functions changed, to the first failure; pytest's exit status.

        For forks only: what tests leave behind stays.
        """
        swap.put()
        items = {item.nodeid: item for item in self.session.items}
        passes = self._passes([items[name] for name in chosen if name in items])
        return int(pytest.ExitCode.OK if passes else pytest.ExitCode.TESTS_FAILED)

    def _passes(self, queue: Sequence[pytest.Item]) -> bool:
        for item, following in zip(queue, [*queue[1:], None], strict=True):
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            if self.session.testsfailed:
                return False
        return True


class _InPlaceOfTests:
    """A pytest plugin: the tests are collected, and then this happens instead of running them."""

    def __init__(self, then: Then) -> None:
        self.then, self.out = then, sys.stdout
        self.raised: BaseException | None = None

    def pytest_runtestloop(self, session: pytest.Session) -> bool | None:
        if session.testsfailed:
            return None  # pytest says what could not be collected
        try:
            with contextlib.redirect_stdout(self.out):
                self.then(Warm(session))
        except BaseException as e:  # pytest would print it and go on
            self.raised = e
        return True


def collected(tests: Sequence[str], without: Sequence[str], then: Then) -> str:
    """Collect tests, which imports all that they need, and go on from there.

    Returns what pytest says where they cannot be collected, else nothing; raises what `then` raises.
    """
    with contextlib.suppress(ImportError):
        importlib.import_module("numba")  # a second that no fork then spends
    instead = _InPlaceOfTests(then)
    plugins = [Selection(without=without), instead]
    with contextlib.redirect_stdout(io.StringIO()) as told:
        status = int(pytest.main([*QUIET, *AGAIN, "--capture=no", *tests], plugins=plugins))
    if instead.raised is not None:
        raise instead.raised
    return told.getvalue()[-2000:] if status not in NOTHING_NOTICED else ""
