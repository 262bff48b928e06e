"""Runs that end early: a step of the file system that fails as if the process ended, a process to kill."""

import contextlib
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import pytest


class Stop(BaseException):
    """The process ends here; nothing catches this."""


def stopping(
    monkeypatch: pytest.MonkeyPatch, steps: Sequence[tuple[Any, str]], at: int, *, after: bool
) -> Callable[[], int]:
    """Let the step of number `at` raise Stop, before or after it is done; returns what counts the steps.

    steps  functions that each make a step: owner and name
    """
    taken = 0

    def counted(original: Callable[..., Any]) -> Callable[..., Any]:
        def step(*args: Any, **kwargs: Any) -> Any:
            nonlocal taken
            taken += 1
            if taken == at and not after:
                raise Stop
            result = original(*args, **kwargs)
            if taken == at:
                raise Stop
            return result

        return step

    for owner, name in steps:
        monkeypatch.setattr(owner, name, counted(getattr(owner, name)))
    return lambda: taken


@contextlib.contextmanager
def forked(work: Callable[[], None]) -> Iterator[int]:
    """A process that does this work and nothing of what this one still has to do; gives its number."""
    child = os.fork()
    if child == 0:
        try:
            work()
            os._exit(0)
        except BaseException as e:
            print(f"{type(e).__name__}: {e}", file=sys.stderr, flush=True)
            os._exit(1)
    yield child
