"""Writing all files of a scene together: to a folder at the side first, then each moved into place."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path

from codegen.errors import UserError


def move_into(folder: Path, files: Mapping[str, str]) -> None:
    """Write text files into a folder, which is made where it is missing; raises UserError where it cannot be.

    Nothing is in the folder before every file is complete at its side.
    """
    made = not folder.exists()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder, prefix=".vair-") as aside:
            for name, text in files.items():
                (Path(aside) / name).write_text(text, encoding="utf-8", newline="\n")
            for name in files:
                os.replace(Path(aside) / name, folder / name)
    except OSError as e:
        if made and folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()
        raise UserError(f'cannot write to "{folder}": {e.strerror}') from None
