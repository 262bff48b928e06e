"""A plan into a folder, so that a reader finds the old files or the new ones, never some of each.

Everything is first written beside the folder. Where the folder holds nothing but what a lock lists, the two
then change places in one step of the file system: an interruption at any moment leaves one set or the other.
Where other files lie in it, where it is the working directory, or where the system has no such step, the
finished set moves into it as `.vair-new` (one step), and from there file by file, the lock last. What an
interruption leaves of that, the next `vair vendor` finishes before anything else, and `vair verify` reports.
"""

from __future__ import annotations

import glob
import os
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path

from codegen.errors import UserError
from codegen.vendor.exchange import exchange
from codegen.vendor.exclusive import exclusive
from codegen.vendor.lock import NAME, Lock, read_lock
from codegen.vendor.plan import Plan
from codegen.vendor.state import UNFINISHED, edited, held, links

SHOWN = 3


def install(folder: Path, plan: Plan, *, force: bool = False) -> list[str]:
    """Write the files and the lock; returns the names of the files that changed.

    raises  UserError where a file would be lost that a person edited or put there (unless `force`), or where
            the folder cannot be written
    """
    if folder.is_symlink() or folder.exists():
        folder = folder.resolve()
    if folder.exists() and not folder.is_dir():
        raise UserError(f'cannot write into "{folder}": it is a file')
    try:
        with exclusive(folder):
            _clear(folder)
            _finish(folder, force=force)
            return _install(folder, plan, force)
    except OSError as e:
        raise UserError(f'cannot write into "{folder}": {e.strerror or e}') from None


def read_old_lock(folder: Path, *, force: bool = False) -> Lock | None:
    """The lock of a folder; None where there is none, or, with `force`, one that cannot be read."""
    if not (folder / NAME).exists():
        return None
    try:
        return read_lock(folder / NAME)
    except UserError:
        if force:
            return None
        raise


def _install(folder: Path, plan: Plan, force: bool) -> list[str]:
    old = read_old_lock(folder, force=force)
    if not force:
        _refuse_loss(folder, old, plan.files)
    changed = [name for name, text in plan.files.items() if held(folder, name) != text.encode("utf-8")]
    gone = [name for name in (old.files if old else {}) if name not in plan.files]
    if not changed and not gone and held(folder, NAME) == plan.lock_text.encode("utf-8"):
        return []
    files = {**plan.files, NAME: plan.lock_text}
    if not folder.exists():
        os.rename(_staged(folder, files, folder.parent), folder)
        return changed
    if _is_ours(folder, {*(old.files if old else {}), NAME}):
        stage = _staged(folder, files, folder.parent)
        if exchange(stage, folder):
            shutil.rmtree(stage)
            return changed
        shutil.rmtree(stage)
    beside = os.access(folder.parent, os.W_OK) and not os.path.ismount(folder)
    os.rename(_staged(folder, files, folder.parent if beside else folder), folder / UNFINISHED)
    _finish(folder, force=force)
    return changed


def _refuse_loss(folder: Path, old: Lock | None, files: Mapping[str, str]) -> None:
    lost = edited(folder, old, files)
    if lost:
        shown = ", ".join(lost[:SHOWN]) + (f" and {len(lost) - SHOWN} more" if len(lost) > SHOWN else "")
        ours = [name for name in lost if old is not None and name in old.files]
        why = "edited since Vair wrote it" if ours else "there, and Vair did not write it"
        raise UserError(f'"{folder}": {shown}: {why}; --force replaces it')


def _is_ours(folder: Path, names: set[str]) -> bool:
    """Whether the folder can be replaced as one: it holds no other file, and nobody stands in it."""
    if not os.access(folder.parent, os.W_OK) or os.path.ismount(folder):
        return False
    found = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if not _is_folder(path)}
    return found <= names and not _holds_working_directory(folder)


def _is_folder(path: Path) -> bool:
    return path.is_dir() and not path.is_symlink()


def _holds_working_directory(folder: Path) -> bool:
    here = Path.cwd()
    return here == folder or folder in here.parents


def _staged(folder: Path, files: Mapping[str, str], where: Path) -> Path:
    """A new folder in `where` that holds the files."""
    stage = Path(tempfile.mkdtemp(dir=where, prefix=_stem(folder)))
    stage.chmod(folder.stat().st_mode & 0o7777 if folder.exists() else 0o777 & ~_umask())
    for name, text in files.items():
        path = stage / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")
    return stage


def _stem(folder: Path) -> str:
    return f".vair-{folder.name}-"


def _clear(folder: Path) -> None:
    """Remove what interrupted runs left beside the folder or in it; a finished set stays."""
    for where in (folder.parent, folder):
        for left in where.glob(f"{glob.escape(_stem(folder))}*") if where.is_dir() else ():
            if _is_folder(left):
                shutil.rmtree(left)


def _finish(folder: Path, *, force: bool) -> None:
    """Move a finished set into place, the lock last; may be repeated until it is done.

    force  drop a set whose lock cannot be read, which no interruption leaves
    """
    stage = folder / UNFINISHED
    if not _is_folder(stage):
        return
    if not (stage / NAME).exists():  # the lock has moved, only the empty folder is left
        shutil.rmtree(stage)
        return
    new = read_old_lock(stage, force=force)
    if new is None:
        shutil.rmtree(stage)
        return
    old = read_old_lock(folder, force=True)
    for name in [name for name in (old.files if old else {}) if name not in new.files]:
        if not links(folder, str(Path(name).parent)):
            (folder / name).unlink(missing_ok=True)
            inner = (folder / name).parent
            if inner != folder and inner.is_dir() and not any(inner.iterdir()):
                inner.rmdir()
    for name in new.files:
        target = folder / name
        if links(folder, str(Path(name).parent)):
            raise UserError(f'"{folder}": {Path(name).parts[0]} is a link that leads elsewhere; remove it')
        if (stage / name).exists():
            if _is_folder(target):
                raise UserError(f'cannot write "{target}": it is a folder')
            target.parent.mkdir(exist_ok=True)
            os.replace(stage / name, target)
    os.replace(stage / NAME, folder / NAME)
    shutil.rmtree(stage)


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current
