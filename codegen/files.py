"""Writing files so that nothing is ever half-written: to the side, then moved into place."""

from __future__ import annotations

import glob
import os
import shutil
import tempfile
from collections.abc import Iterable, Mapping
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path

from codegen.errors import UserError
from codegen.vendor.exchange import exchange


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
    folder below it, with / between. One run at a time writes. Where nothing but these files lies in the
    folder, old and new change places in one step, so that a run that is killed leaves one set or the other;
    elsewhere they move in one by one.

    raises  UserError where that is not possible
    """
    if folder.exists() and not folder.is_dir():
        raise UserError(f'cannot write into "{folder}": it is a file')
    place = folder.resolve()
    if not place.parent.is_dir():
        raise UserError(f'cannot make "{folder}": the folder "{place.parent}" does not exist')
    try:
        with alone(place):
            _clear(place)
            with tempfile.TemporaryDirectory(dir=place.parent, prefix=_stem(place)) as aside:
                # An inner folder changes places, so that what it then holds goes with the outer one.
                stage = Path(aside) / "new"
                _fill(stage, files)
                if not place.exists():
                    os.rename(stage, place)
                elif not (_holds_only(place, files) and _replace(place, stage)):
                    _move(stage, place, folder, files)
    except OSError as e:
        raise UserError(f'cannot write into "{folder}": {e.strerror}') from None


def alone(folder: Path) -> AbstractContextManager[None]:
    """One run at a time in a folder, where the system can lock the one above it; Windows cannot."""
    if os.name != "posix":
        return nullcontext()
    from codegen.vendor.exclusive import exclusive

    return exclusive(folder)


def swapped(a: Path, b: Path) -> bool:
    """Let two folders change places in one step; False where the system has no such step."""
    return os.name == "posix" and exchange(a, b)


def _fill(stage: Path, files: Mapping[str, bytes]) -> None:
    stage.mkdir()
    for name, data in files.items():
        (stage / name).parent.mkdir(parents=True, exist_ok=True)
        (stage / name).write_bytes(data)


def _replace(place: Path, stage: Path) -> bool:
    """Let a folder that nobody stands in and its new content change places; False where that cannot be."""
    here = Path.cwd()
    if here == place or place in here.parents or os.path.ismount(place):
        return False
    stage.chmod(place.stat().st_mode & 0o7777)
    return swapped(stage, place)


def _move(stage: Path, place: Path, folder: Path, names: Iterable[str]) -> None:
    """One file after another."""
    for name in names:
        if (place / name).is_dir():
            raise UserError(f'cannot write "{folder / name}": it is a folder')
    for name in names:
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        os.replace(stage / name, place / name)


def _holds_only(place: Path, names: Iterable[str]) -> bool:
    """Whether nothing lies in a folder but plain files of these names; links stay where they are."""
    found = [path for path in place.rglob("*") if path.is_symlink() or not path.is_dir()]
    known = {place / name for name in names}
    return all(path in known and path.is_file() and not path.is_symlink() for path in found)


def _clear(place: Path) -> None:
    """Remove what killed runs left beside the folder."""
    for left in place.parent.glob(f"{glob.escape(_stem(place))}*"):
        if left.is_dir() and not left.is_symlink():
            shutil.rmtree(left)


def _stem(place: Path) -> str:
    return f".vair-{place.name}-"


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current
