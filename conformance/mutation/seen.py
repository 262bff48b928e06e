"""Which tests run which functions of the mutated files, so that a mutant meets those first that can see it.

One run of a subject's tests without any mutant is watched: every call of a function of a watched file is
noted under the test in whose time it happens. A value that is made once and kept (a cached table) shows under
the first test only; so the map orders tests, and leaves none out.
"""

from __future__ import annotations

import ast
import json
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import accumulate
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

NEEDS_A_DEVICE = ("runtime", "target")
"""Fixtures that open a driver, which neither a fork does well nor a mutant of ours needs."""


def opens_a_device(item: pytest.Item) -> bool:
    """Whether a test takes one of these fixtures, and no parameter of its own by that name."""
    fixtures = set(NEEDS_A_DEVICE) & set(getattr(item, "fixturenames", ()))
    own = {name for mark in item.iter_markers("parametrize") for name in _names(mark.args[0])}
    return bool(fixtures - own)


def _names(given: str | Sequence[str]) -> list[str]:
    return [name.strip() for name in given.split(",")] if isinstance(given, str) else list(given)


class Selection:
    """A pytest plugin: leaves out tests that open devices, and runs the chosen ones alone, in that order.

    excluded  node ids to leave out
    without   beginnings of node ids to leave out
    """

    def __init__(
        self, chosen: Sequence[str] = (), excluded: Sequence[str] = (), without: Sequence[str] = ()
    ) -> None:
        self.rank = {name: k for k, name in enumerate(chosen)}
        self.excluded, self.without = frozenset(excluded), tuple(without)

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        kept = [
            item
            for item in items
            if not opens_a_device(item)
            and item.nodeid not in self.excluded
            and not item.nodeid.startswith(self.without or ("\0",))
            and (not self.rank or item.nodeid in self.rank)
        ]
        items[:] = sorted(kept, key=lambda item: self.rank.get(item.nodeid, 0))


class Watch:
    """A pytest plugin that notes the calls of every test, and how long it took; and the calls before any."""

    def __init__(self, root: Path, paths: Sequence[str]) -> None:
        self.paths = {str(root / path): path for path in paths}
        self.tests: dict[str, dict[str, Any]] = {}
        self.calls: set[tuple[str, int]] = set()
        self.imported: dict[str, list[int]] = {}

    def begin(self) -> None:
        """Note what is called while modules are imported and tests collected."""
        sys.settrace(self._on_call)

    def pytest_collection_finish(self) -> None:
        sys.settrace(None)
        self.imported = self._by_file()

    def _on_call(self, frame: FrameType, event: str, argument: Any) -> None:
        code = frame.f_code
        if code.co_filename in self.paths:
            self.calls.add((self.paths[code.co_filename], code.co_firstlineno))

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        self.calls = set()
        started = time.perf_counter()
        sys.settrace(self._on_call)
        try:
            return (yield)
        finally:
            sys.settrace(None)
            self.tests[item.nodeid] = {"s": time.perf_counter() - started, "calls": self._by_file()}

    def _by_file(self) -> dict[str, list[int]]:
        found: dict[str, list[int]] = {}
        for path, line in self.calls:
            found.setdefault(path, []).append(line)
        return found

    def write(self, path: Path) -> None:
        """Keep what was seen for another process."""
        told = {"tests": self.tests, "imported": self.imported}
        path.write_text(json.dumps(told), encoding="utf-8")


@dataclass(frozen=True)
class Seen:
    """What Watch has written: seconds and calls of every test, and the calls of imports."""

    tests: dict[str, dict[str, Any]]
    imported: dict[str, list[int]] = field(default_factory=dict)

    @classmethod
    def read(cls, path: Path) -> Seen:
        """From a file of Watch.write."""
        return cls(**json.loads(path.read_text(encoding="utf-8")))

    @property
    def seconds(self) -> float:
        """All tests together."""
        return float(sum(test["s"] for test in self.tests.values()))

    def by(self, path: str, text: str, line: int) -> list[str]:
        """The tests that call the function around a line, or any where there is none; quickest first."""
        first, last = function_around(text, line)
        seeing = {
            name: test["s"]
            for name, test in self.tests.items()
            if any(first <= called <= last for called in test["calls"].get(path, ()))
        }
        return sorted(seeing, key=lambda name: seeing[name])

    def runs_at_import(self, path: str, text: str, line: int) -> bool:
        """Whether a function around a line runs while modules are imported, or there is none."""
        called = self.imported.get(path, ())
        return not (around := functions_around(text, line)) or any(first in called for first, _ in around)


def function_around(text: str, line: int) -> tuple[int, int]:
    """First and last line of the innermost function that holds a line; of the whole file if none does."""
    return [(0, len(text.splitlines())), *functions_around(text, line)][-1]


def functions_around(text: str, line: int) -> list[tuple[int, int]]:
    """First and last lines of the functions that hold a line, decorators included, the outermost first."""
    found: list[tuple[int, int]] = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef):
            ends = min([node.lineno, *(d.lineno for d in node.decorator_list)]), node.end_lineno or 0
            if ends[0] <= line <= ends[1]:
                found.append(ends)
    return sorted(found)


def within(seconds: Sequence[float], budget: float) -> int:
    """How many of some tests fit into so many seconds, one at least."""
    return max(1, sum(total <= budget for total in accumulate(seconds)))
