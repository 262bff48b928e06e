"""One run at a time in a folder: the operating system's lock on the folder above it.

No lock file is left behind, and the lock ends with its process, however that ends.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
from collections.abc import Iterator
from pathlib import Path

from codegen.errors import UserError


@contextlib.contextmanager
def exclusive(folder: Path) -> Iterator[None]:
    """Hold the lock; waits while another run has it. Raises UserError where there is no folder above."""
    parent = folder.resolve().parent
    try:
        handle = os.open(parent, os.O_RDONLY | os.O_DIRECTORY)
    except OSError as e:
        raise UserError(f'cannot make "{folder}": the folder "{parent}": {e.strerror}') from None
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    except BlockingIOError as e:
        raise UserError(f'"{parent}" cannot be locked: {e.strerror}') from None
    finally:
        os.close(handle)
