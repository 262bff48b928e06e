"""Writing a folder with folders in it as a whole: made beside its place, then moved there."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterable
from pathlib import Path, PurePosixPath

from codegen.errors import UserError


class NewFolder:
    """A folder that takes the place of an old one, or of none, when it is whole; see `place`.

    marker  a file that an old folder must hold to be replaced, so that nothing else is ever removed
    """

    def __init__(self, folder: Path, marker: str) -> None:
        """Raises UserError where the folder could not be put into its place."""
        self.folder, self.marker = folder, marker
        parent = folder.resolve().parent
        if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
            raise UserError(f'cannot write into "{folder}": it is no folder')
        if not parent.is_dir():
            raise UserError(f'cannot make "{folder}": the folder "{parent}" does not exist')
        if folder.is_dir() and any(folder.iterdir()) and not (folder / marker).is_file():
            raise UserError(f'"{folder}" holds other files: name an empty folder, or one with a {marker}')
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

    def place(self) -> None:
        """Move the folder to its place; what was there before is gone."""
        try:
            if self.folder.exists():
                os.replace(self.folder, self._aside / "old")
            os.replace(self._aside / "new", self.folder)
        except OSError as e:
            raise UserError(f'cannot write into "{self.folder}": {e.strerror}') from None
