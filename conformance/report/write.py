"""Writing a report: everything to the side, then moved into place."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

from codegen.errors import UserError
from codegen.library import Library
from conformance.bench.record import RESULTS, as_json, slug, without_raw
from conformance.report import worst
from conformance.report.page import page
from conformance.report.picture import overview

DATA, PAGE, PICTURE = "report.json", "report.html", "overview.png"


def prepare(folder: Path) -> None:
    """Make the folder before anything is measured; raises UserError where it cannot be written to."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as e:
        raise UserError(f'cannot write the report into "{folder}": {e.strerror}') from None


def write(library: Library, report: dict[str, Any], folder: Path) -> list[Path]:
    """Write data, page, picture and the records of the worst inputs; returns the first three."""
    prepare(folder)
    with tempfile.TemporaryDirectory(dir=folder, prefix=".vair-") as scratch:
        aside = Path(scratch)
        (aside / DATA).write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
        (aside / PAGE).write_text(page(library, report), encoding="utf-8")
        (aside / PICTURE).write_bytes(overview(report))
        for place, text in worst.files(report["drivers"]).items():
            (aside / place).parent.mkdir(parents=True, exist_ok=True)
            (aside / place).write_text(text, encoding="utf-8")
        if (aside / worst.FOLDER).exists():
            shutil.rmtree(folder / worst.FOLDER, ignore_errors=True)
            os.replace(aside / worst.FOLDER, folder / worst.FOLDER)
        for name in (DATA, PICTURE, PAGE):
            os.replace(aside / name, folder / name)
    return [folder / name for name in (PAGE, DATA, PICTURE)]


def keep(results: list[dict[str, Any]], picture: bytes, folder: Path = RESULTS) -> list[Path]:
    """Write each driver's result where `vair emit --max-error`, `vair list` and the README read it."""
    prepare(folder)
    texts = {folder / f"{slug(r['device'])}.json": as_json(without_raw(r)).encode() for r in results}
    for path, content in {**texts, folder / PICTURE: picture}.items():
        aside = path.with_name(f".{path.name}")
        aside.write_bytes(content)
        os.replace(aside, path)
    return list(texts)
