"""Sources on disk: random programs become a library as any other source does, by the front end."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from codegen.library import Library
from conformance.fuzz.case import HEADER, Case

FOLDER = "numeric"


def write(root: Path, cases: Sequence[Case]) -> Library:
    """The library of the cases' sources, one file each, below a folder."""
    folder = root / FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    for case in cases:
        (folder / f"{case.entry}.py").write_text(HEADER + "\n\n" + case.text, encoding="ascii")
    return Library(root)
