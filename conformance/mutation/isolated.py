"""A mutant in a process of its own: the changed module is compiled from its tree, the tests run on top.

All that the tests need is imported once, here; every mutant is a fork of this warm process, which imports
anew what depends on the changed module. No file is changed, so that nobody else ever sees a mutant.
"""

from __future__ import annotations

import ast
import contextlib
import importlib
import importlib.abc
import importlib.machinery
import io
import os
import select
import signal
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from types import CodeType
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
QUIET = ("-q", "--no-header", "--tb=line", "--assert=plain", "-p", "no:cacheprovider")
"""Plain assertions: nobody reads them, and rewriting takes longer than the tests."""
AGAIN = ("-W", "ignore::pytest.PytestAssertRewriteWarning")
"""Plugins that the first session has imported are not to be rewritten either."""

SURVIVED, KILLED, TIMED_OUT = "survived", "killed", "timed out"


def warm_up(tests: Sequence[str]) -> int:
    """Import all that these tests need by collecting them; returns pytest's exit status."""
    with contextlib.redirect_stdout(io.StringIO()) as told:
        status = int(pytest.main(["--collect-only", *QUIET, *AGAIN, *tests]))
    if status:
        print(told.getvalue()[-2000:])
    return status


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


def run_tests(tests: Sequence[str], path: str, tree: ast.Module | None, stale: set[str]) -> int:
    """Run tests in this process with a module replaced; returns pytest's exit status. For forks only."""
    forget(stale)
    if tree is not None:
        sys.meta_path.insert(0, _Finder(path, tree))
    return int(pytest.main(["-x", *QUIET, *AGAIN, *tests]))


class Trial:
    """One mutant under test in a fork of this process. `tree` None is the unchanged module."""

    def __init__(
        self, tests: Sequence[str], path: str, tree: ast.Module | None, stale: set[str], limit: float
    ) -> None:
        self.deadline = time.monotonic() + limit
        self.read, write = os.pipe()
        sys.stdout.flush()
        sys.stderr.flush()
        self.pid = os.fork()
        if self.pid == 0:
            _child(write, tests, path, tree, stale)
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
        return SURVIVED if os.waitstatus_to_exitcode(status) == 0 else KILLED


def _child(write: int, tests: Sequence[str], path: str, tree: ast.Module | None, stale: set[str]) -> None:
    """The fork: never returns."""
    code = 70
    try:
        os.setpgid(0, 0)
        os.dup2(write, 1)
        os.dup2(write, 2)
        os.chdir(ROOT)
        sys.stdout = sys.stderr = io.TextIOWrapper(os.fdopen(write, "wb"), line_buffering=True)
        code = run_tests(tests, path, tree, stale)
        sys.stdout.flush()
    except BaseException as e:  # whatever a mutant does, the fork ends here
        with contextlib.suppress(Exception):
            print(f"{type(e).__name__}: {e}", flush=True)
    finally:
        os._exit(code)
