"""Writing files so that nothing is ever half-written: to the side, then moved into place."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from codegen.errors import UserError


def write_text(path: Path, text: str) -> None:
    """Write a text file atomically (UTF-8, Unix line ends); raises UserError where that is not possible."""
    write_bytes(path, text.encode("utf-8"))


def write_bytes(path: Path, data: bytes) -> None:
    """Write a file atomically; raises UserError where that is not possible."""
    folder = path.parent
    if path.is_dir():
        raise UserError(f'cannot write "{path}": it is a folder')
    if not folder.is_dir():
        raise UserError(f'cannot write "{path}": the folder "{folder}" does not exist')
    aside: str | None = None
    try:
        handle, aside = tempfile.mkstemp(dir=folder, prefix=f".{path.name}.")
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        os.chmod(aside, path.stat().st_mode & 0o777 if path.exists() else 0o666 & ~_umask())
        os.replace(aside, path)
    except OSError as e:
        if aside is not None and os.path.exists(aside):
            os.unlink(aside)
        raise UserError(f'cannot write "{path}": {e.strerror}') from None


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current
