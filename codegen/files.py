"""Writing files so that nothing is ever half-written: to the side, then moved into place."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path

from codegen.errors import UserError


def write_text(path: Path, text: str) -> None:
    """Write a text file atomically (UTF-8, Unix line ends); raises UserError where that is not possible."""
    write_bytes(path, text.encode("utf-8"))


def write_bytes(path: Path, data: bytes) -> None:
    """Write a file atomically; raises UserError where that is not possible."""
    aside: str | None = None
    try:
        if path.is_dir():
            raise UserError(f'cannot write "{path}": it is a folder')
        if path.exists() and not path.is_file():  # a device or a pipe: written to, never replaced
            path.write_bytes(data)
            return
        target = path.resolve() if path.is_symlink() else path
        folder = target.parent
        if not folder.is_dir():
            raise UserError(f'cannot write "{path}": the folder "{folder}" does not exist')
        handle, aside = tempfile.mkstemp(dir=folder, prefix=".vair-")
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        os.chmod(aside, target.stat().st_mode & 0o777 if target.exists() else 0o666 & ~_umask())
        os.replace(aside, target)
    except OSError as e:
        if aside is not None and os.path.exists(aside):
            os.unlink(aside)
        raise UserError(f'cannot write "{path}": {e.strerror}') from None


def write_folder(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write several files into a folder, made if need be, so that either all of them are new or none is.

    They are first written beside the folder; files of other names that lie in it stay. A name may lead into a
    folder below it, with / between.

    raises  UserError where that is not possible
    """
    if folder.exists() and not folder.is_dir():
        raise UserError(f'cannot write into "{folder}": it is a file')
    parent = folder.resolve().parent
    if not parent.is_dir():
        raise UserError(f'cannot make "{folder}": the folder "{parent}" does not exist')
    try:
        with tempfile.TemporaryDirectory(dir=parent, prefix=".vair-") as aside:
            for name, data in files.items():
                path = Path(aside) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(data)
            folder.mkdir(exist_ok=True)
            for name in files:
                if (folder / name).is_dir():
                    raise UserError(f'cannot write "{folder / name}": it is a folder')
            for name in files:
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                os.replace(Path(aside) / name, folder / name)
    except OSError as e:
        raise UserError(f'cannot write into "{folder}": {e.strerror}') from None


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current
