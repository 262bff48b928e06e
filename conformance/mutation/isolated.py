"""A mutant in a process of its own: the changed module is compiled from its tree, the tests run on top.

All that the tests need is imported once, here; every mutant is a fork of this warm process, which imports
anew what depends on the changed module. No file is changed, so that nobody else ever sees a mutant.
"""

from __future__ import annotations

import ast
import contextlib
import gc
import importlib
import importlib.abc
import importlib.machinery
import io
import os
import select
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import CodeType
from typing import Any

import pytest

from conformance.mutation.seen import Selection, Watch

ROOT = Path(__file__).parents[2]
QUIET = ("-q", "--no-header", "--tb=line", "--assert=plain", "-p", "no:cacheprovider")
"""Plain assertions: nobody reads them, and rewriting takes longer than the tests."""
AGAIN = ("-W", "ignore::pytest.PytestAssertRewriteWarning")
"""Plugins that the first session has imported are not to be rewritten either."""

SURVIVED, KILLED, TIMED_OUT, REFUSED = "survived", "killed", "timed out", "refused"
"""What comes of a mutant; the front end refuses some changes of shading functions, which are no mutants."""
NOTHING_NOTICED = (int(pytest.ExitCode.OK), int(pytest.ExitCode.NO_TESTS_COLLECTED))
"""Exit statuses of a mutant that no test noticed; one that leaves no test to run goes on to all tests."""


COMPILED = "codegen/intervals/"
"""Where constants of compiled loops are defined."""


def _imports(path: str) -> set[str]:
    """Dotted names that a file imports, and what it imports from them."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(Path(path).read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return found


def dependants(name: str) -> set[str]:
    """The loaded modules that import a module, directly or not, tests among them, and the module itself."""
    loaded = {other: getattr(module, "__file__", None) or "" for other, module in list(sys.modules.items())}
    installed = (sys.prefix, sys.base_prefix)
    imported = {
        other: _imports(path)
        for other, path in loaded.items()
        if path.endswith(".py") and not path.startswith(installed)
    }
    found = {name}
    while more := {other for other, names in imported.items() if other not in found and names & found}:
        found |= more
    return found


def forget(names: set[str]) -> None:
    """Let the next import of these modules run their code again."""
    for name in names:
        sys.modules.pop(name, None)
        package, _, last = name.rpartition(".")
        if package in sys.modules and hasattr(sys.modules[package], last):
            delattr(sys.modules[package], last)  # "from package import name" looks there first


def keep_nothing_compiled() -> None:
    """Loops that are compiled from now on are not kept on disk: numba would take them for the original's."""
    with contextlib.suppress(ImportError):
        importlib.import_module("numba.core.caching").IndexDataCacheFile.save = lambda *_: None


class _Loader(importlib.machinery.SourceFileLoader):
    """Loads one module from a tree instead of its file."""

    def __init__(self, name: str, path: str, tree: ast.Module) -> None:
        super().__init__(name, path)
        self.tree = tree

    def get_code(self, fullname: str) -> CodeType:
        return compile(self.tree, self.path, "exec")


class _Finder(importlib.abc.MetaPathFinder):
    """Finds that module before the usual finders do."""

    def __init__(self, path: str, tree: ast.Module) -> None:
        self.name = path.removesuffix(".py").replace("/", ".")
        self.path = str(ROOT / path)
        self.tree = tree

    def find_spec(self, fullname: str, path: Any = None, target: Any = None) -> Any:
        if fullname != self.name:
            return None
        loader = _Loader(fullname, self.path, self.tree)
        return importlib.util.spec_from_file_location(fullname, self.path, loader=loader)


@dataclass(frozen=True)
class Change:
    """What a trial puts in place of a file: another tree of a module, another text of data, or nothing."""

    path: str
    tree: ast.Module | None = None
    text: str | None = None

    def put(self) -> None:
        """From now on this process sees the change instead of the file."""
        if self.tree is not None:
            sys.meta_path.insert(0, _Finder(self.path, self.tree))
        if self.text is not None:
            _read_instead(ROOT / self.path, self.text)


def _read_instead(changed: Path, text: str) -> None:
    read_text = Path.read_text

    def reading(self: Path, *arguments: Any, **named: Any) -> str:
        return text if self == changed else read_text(self, *arguments, **named)

    Path.read_text = reading  # type: ignore[method-assign]


@dataclass(frozen=True)
class Session:
    """Tests to run in a fork.

    tests     files and node ids, as pytest takes them
    stale     modules to import anew
    chosen    node ids to run alone, in that order; empty: all
    excluded  node ids to leave out
    without   beginnings of node ids to leave out
    watched   files whose calls are noted, and
    notes     where
    """

    tests: tuple[str, ...]
    stale: frozenset[str]
    chosen: tuple[str, ...] = ()
    excluded: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    watched: tuple[str, ...] = ()
    notes: Path | None = None

    def run(self, change: Change) -> int:
        """Run in this process with a file replaced; returns pytest's exit status. For forks only."""
        watch = Watch(ROOT, self.watched)
        forget(set(self.stale))
        change.put()
        if change.tree is not None and change.path.startswith(COMPILED):
            keep_nothing_compiled()
        plugins: list[Any] = [Selection(self.chosen, self.excluded, self.without)]
        if self.notes is not None:
            plugins.append(watch)
            watch.begin()
        # Of a file whose chosen tests are known, nothing else is collected.
        files = dict.fromkeys(name.partition("::")[0] for name in self.chosen)
        status = int(pytest.main(["-x", *QUIET, *AGAIN, *(files or self.tests)], plugins=plugins))
        if self.notes is not None:
            watch.write(self.notes)
        return status


class Trial:
    """Tests of one change in a fork of this process: `work` returns pytest's exit status."""

    def __init__(self, work: Callable[[], int], limit: float) -> None:
        self.deadline = time.monotonic() + limit
        self.read, write = os.pipe()
        sys.stdout.flush()
        sys.stderr.flush()
        gc.freeze()  # pages that no collection touches stay shared
        self.pid = os.fork()
        if self.pid == 0:
            _child(write, work)
        os.close(write)
        self.output = b""

    def wait(self) -> str:
        """SURVIVED, KILLED or TIMED_OUT; `output` then holds what the tests said last."""
        ended = False
        while not ended and (left := self.deadline - time.monotonic()) > 0:
            if select.select([self.read], [], [], left)[0]:
                part = os.read(self.read, 65536)
                self.output += part
                ended = not part
        if not ended:
            os.killpg(self.pid, signal.SIGKILL)
        os.close(self.read)
        _, status = os.waitpid(self.pid, 0)
        if not ended:
            return TIMED_OUT
        return SURVIVED if os.waitstatus_to_exitcode(status) in NOTHING_NOTICED else KILLED


def _child(write: int, work: Callable[[], int]) -> None:
    """The fork: never returns."""
    code = 70
    try:
        os.setpgid(0, 0)
        os.dup2(write, 1)
        os.dup2(write, 2)
        os.chdir(ROOT)
        sys.stdout = sys.stderr = io.TextIOWrapper(os.fdopen(write, "wb"), line_buffering=True)
        code = work()
        sys.stdout.flush()
    except BaseException as e:  # whatever a mutant does, the fork ends here
        with contextlib.suppress(Exception):
            print(f"{type(e).__name__}: {e}", flush=True)
    finally:
        os._exit(code)
