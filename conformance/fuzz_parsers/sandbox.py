"""One run of a reader on one file: a value or one sentence, within seconds, and no write elsewhere."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

from codegen.errors import UserError

SECONDS = 10.0
"""After which a run hangs; the slowest file here takes well below one."""
LOOKS = 10
"""How often a run is looked at until then."""
LONGEST_SENTENCE = 2000
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_CHANGES = (
    "os.rename",
    "os.remove",
    "os.rmdir",
    "os.mkdir",
    "os.link",
    "os.symlink",
    "os.truncate",
    "os.chmod",
)


class Outside(BaseException):
    """A file outside of the sandbox was to be changed; no reader catches this."""


class Hangs(BaseException):
    """A run took too long."""


class Sandbox:
    """A folder that alone may be changed while a reader runs; one per process, since audit hooks stay."""

    _hooked = False
    _inside: Path | None = None

    def __init__(self, folder: Path) -> None:
        self.folder = folder.resolve()
        self.guarded = False
        self.began = 0.0
        if not Sandbox._hooked:
            sys.addaudithook(Sandbox._watch)
            Sandbox._hooked = True

    @classmethod
    def _watch(cls, event: str, arguments: tuple[Any, ...]) -> None:
        if cls._inside is None:
            return
        if event == "open":
            path, _, flags = arguments
            paths = [path] if isinstance(flags, int) and flags & _WRITING else []
        elif event in _CHANGES:
            if event != "os.truncate" and arguments[-1] >= 0:
                return  # in a folder that is open, as shutil.rmtree has it, whose name was checked
            paths = [a for a in arguments[: 2 if event == "os.rename" else None] if not isinstance(a, int)]
            paths = paths[1:] if event in ("os.link", "os.symlink") else paths
        else:
            return
        for path in paths:
            if isinstance(path, str | bytes | os.PathLike) and path != os.devnull:
                cls._refuse_outside(event, os.fsdecode(path))

    @classmethod
    def _refuse_outside(cls, event: str, path: str) -> None:
        named = Path(os.path.abspath(path))
        real = Path(os.path.realpath(named.parent)) / named.name
        assert cls._inside is not None
        if not real.is_relative_to(cls._inside):
            raise Outside(f"{event} {path!r}")

    @contextmanager
    def guarding(self) -> Iterator[None]:
        """Refuse runs without end while many follow each other: one timer looks at all of them."""

        def look(signum: int, frame: Any) -> None:
            if Sandbox._inside is not None and time.monotonic() - self.began > SECONDS:
                raise Hangs(f"no answer after {SECONDS:g} s")

        previous = signal.signal(signal.SIGALRM, look)
        signal.setitimer(signal.ITIMER_REAL, SECONDS / LOOKS, SECONDS / LOOKS)
        self.guarded = True
        try:
            yield
        finally:
            self.guarded = False
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            signal.signal(signal.SIGALRM, previous)

    def watch(self, read: Callable[[Path], object], path: Path) -> None:
        """Let a reader read; refuse changes elsewhere."""
        self.began = time.monotonic()
        Sandbox._inside = self.folder
        try:
            read(path)
        finally:
            Sandbox._inside = None


def examine(sandbox: Sandbox, read: Callable[[Path], object], name: str, data: bytes) -> str:
    """Let a reader read a file of this content; returns what it said of it, "" where it took it.

    errors  whatever but UserError comes out of the reader; AssertionError for a sentence that is none
    """
    path = sandbox.folder / name
    with open(path, "wb", buffering=0) as file:
        file.write(data)
    try:
        with nullcontext() if sandbox.guarded else sandbox.guarding():
            sandbox.watch(read, path)
    except UserError as e:
        sentence = str(e)
        assert sentence.strip(), "an empty sentence"
        assert sentence.isprintable(), f"more than a line: {sentence!r}"
        assert len(sentence) <= LONGEST_SENTENCE, f"{len(sentence)} characters: {sentence[:200]!r}"
        return sentence
    return ""
