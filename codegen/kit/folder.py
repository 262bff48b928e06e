"""Writing a folder with folders in it as a whole: made beside its place, then moved there."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterable
from pathlib import Path, PurePosixPath

from codegen.errors import UserError
from codegen.files import alone, swapped

LIST = "written-by-vair.txt"
"""Names every file of such a folder: only a folder that holds nothing else is replaced."""


class NewFolder:
    """A folder that takes the place of an old one, or of none, when it is whole; see `place`."""

    def __init__(self, folder: Path) -> None:
        """Raises UserError where the folder could not be put into its place, or holds files of others."""
        self.folder = folder
        self._names: list[str] = []
        parent = folder.resolve().parent
        if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
            raise UserError(f'cannot write into "{folder}": it is no folder')
        if not parent.is_dir():
            raise UserError(f'cannot make "{folder}": the folder "{parent}" does not exist')
        foreign = sorted(_files(folder) - _listed(folder)) if folder.is_dir() else []
        if foreign:
            raise UserError(f'"{folder}" holds other files, as {foreign[0]}: name a new or an empty folder')
        try:
            self._aside = Path(tempfile.mkdtemp(dir=parent, prefix=".vair-"))
        except OSError as e:
            raise UserError(f'cannot make "{folder}": {e.strerror}') from None

    def __enter__(self) -> NewFolder:
        return self

    def __exit__(self, *_: object) -> None:
        shutil.rmtree(self._aside, ignore_errors=True)

    def add(self, files: Iterable[tuple[str, bytes]]) -> None:
        """Write files by their paths inside the folder; raises UserError where that is not possible."""
        for name, data in files:
            path = self._aside / "new" / PurePosixPath(name)
            try:
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(data)
            except OSError as e:
                raise UserError(f'cannot write "{self.folder / name}": {e.strerror}') from None
            self._names.append(name)

    def place(self) -> None:
        """Move the folder to its place, one run at a time; what Vair wrote there before is gone.

        Old and new change places in one step where the system has one: a run that is killed leaves either.
        """
        self.add([(LIST, "".join(f"{name}\n" for name in sorted([*self._names, LIST])).encode())])
        try:
            with alone(self.folder):
                if self.folder.exists() and swapped(self._aside / "new", self.folder):
                    return
                if self.folder.exists():
                    os.replace(self.folder, self._aside / "old")
                os.replace(self._aside / "new", self.folder)
        except OSError as e:
            raise UserError(f'cannot write into "{self.folder}": {e.strerror}') from None


def _files(folder: Path) -> set[str]:
    """Everything in a folder that is none itself; links count as files."""
    found = (p for p in folder.rglob("*") if p.is_symlink() or not p.is_dir())
    return {p.relative_to(folder).as_posix() for p in found}


def _listed(folder: Path) -> set[str]:
    try:
        return set((folder / LIST).read_text(encoding="utf-8").splitlines())
    except (OSError, UnicodeDecodeError):
        return set()
