"""A vendored folder against its lock, and against what would be written now."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from codegen.errors import UserError
from codegen.vendor.lock import NAME, Lock, file_hash

UNFINISHED = ".vair-new"
"""Folder below a vendored one that holds a set whose move into place was interrupted."""


@dataclass(frozen=True)
class FileState:
    """What is wrong with a file: edited, missing, unexpected or stale; `note` says more."""

    file: str
    state: str
    note: str = ""


def held(folder: Path, name: str) -> bytes | None:
    """A file of the folder; None where there is none, or a link leads elsewhere."""
    path = folder / name
    try:
        if links(folder, name) or not path.is_file():
            return None
        return path.read_bytes()
    except OSError as e:
        raise UserError(f"{path}: cannot be read ({e.strerror})") from None


def links(folder: Path, name: str) -> bool:
    """Whether a name passes through a symbolic link below the folder."""
    path = folder
    for part in Path(name).parts:
        path = path / part
        if path.is_symlink():
            return True
    return False


def edited(folder: Path, lock: Lock | None, new: Mapping[str, str]) -> list[str]:
    """Files that hold what neither the lock nor the new texts know: writing would lose a person's work."""
    found = []
    for name in sorted({*(lock.files if lock else ()), *new}):
        if links(folder, name) or (folder / name).is_dir():
            found.append(name)
            continue
        data = held(folder, name)
        known = {lock.files.get(name) if lock else None}
        known |= {file_hash(new[name].encode("utf-8"))} if name in new else set()
        if data is not None and file_hash(data) not in known:
            found.append(name)
    return found


def states(folder: Path, lock: Lock, new: Mapping[str, str]) -> list[FileState]:
    """Every file that is not as it should be, by name.

    new  what would be written now
    """
    found = []
    for name in sorted({*lock.files, *new}):
        data = held(folder, name)
        now = file_hash(new[name].encode("utf-8")) if name in new else None
        if name not in lock.files:
            found.append(FileState(name, "stale", "not yet there; this version writes it"))
            continue
        if links(folder, name):
            found.append(FileState(name, "edited", "a link stands in its place"))
        elif data is None:
            found.append(FileState(name, "missing"))
        elif file_hash(data) != lock.files[name]:
            found.append(FileState(name, "edited"))
        if now is None:
            found.append(FileState(name, "stale", "this version writes no such file"))
        elif now != lock.files[name]:
            found.append(FileState(name, "stale"))
    found += [FileState(name, "unexpected") for name in _others(folder, lock)]
    if (folder / UNFINISHED).is_dir():
        found.append(
            FileState(UNFINISHED, "unexpected", "an update was interrupted; vair vendor finishes it")
        )
    return found


def _others(folder: Path, lock: Lock) -> Iterator[str]:
    """Files that the lock does not list, folders in folders by their own name."""
    own = {Path(name).parts[0] for name in lock.files if "/" in name}
    for path in sorted(folder.iterdir()):
        if path.name in own and path.is_dir() and not path.is_symlink():
            inner = (f"{path.name}/{entry.name}" for entry in sorted(path.iterdir()))
            yield from (name for name in inner if name not in lock.files)
        elif path.name not in lock.files and path.name not in (NAME, UNFINISHED):
            yield path.name
