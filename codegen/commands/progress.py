"""One line that says what is being done, where a person may watch."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def progress(first: str) -> Iterator[Callable[[str], None]]:
    """What changes the line, which is there until the end and starts with `first`."""
    if not sys.stderr.isatty():
        yield lambda sentence: None
        return
    from rich.console import Console  # takes longer to load than to say anything

    with Console(stderr=True).status(first) as status:
        yield status.update
