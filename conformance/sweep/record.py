"""What a sweep found, joined from its pieces, and the record of each driver under results."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from conformance.executor import Job

RESULTS = Path(__file__).parent / "results"
BOUND, LOWER_BOUND = "bound", "lower bound"

Entry = dict[str, Any]


def joined(pieces: Iterable[tuple[Job, Entry]], count: int, source: str) -> Entry:
    """One function on one target from the pieces of one sweep; `count` numbers are in its domain.

    pieces  must not overlap; a piece that is missing makes the result a lower bound
    """
    pieces = sorted(pieces, key=lambda piece: piece[0].start)
    first, data = pieces[0]
    bounds = [dict(b) for b in data["bounds"]]
    for _, other in pieces[1:]:
        for mine, theirs in zip(bounds, other["bounds"], strict=True):
            if theirs["measured"] > mine["measured"]:
                mine.update(measured=theirs["measured"], worst=theirs["worst"])
            mine["lanes"] += theirs["lanes"]
            mine["failures"] += theirs["failures"]
            mine["failed"] = (mine["failed"] + theirs["failed"])[:4]
    lanes = sum(piece["lanes"] for _, piece in pieces)
    return {
        "function": first.function,
        "target": first.target,
        "driver": data["driver"],
        "source": source,
        "kind": BOUND if lanes == count else LOWER_BOUND,
        "numbers": lanes,
        "of": count,
        "step": first.step,
        "denormal": sum(piece["denormal"] for _, piece in pieces),
        "non_finite": sum(piece["non_finite"] for _, piece in pieces),
        "not_finite": [word for _, piece in pieces for word in piece["not_finite"]][:4],
        "bounds": bounds,
    }


def passed(entry: Entry) -> bool:
    """Whether every number gave a finite result within its bounds."""
    return not entry["non_finite"] and not any(b["failures"] for b in entry["bounds"])


def file_of(entry: Entry, folder: Path) -> Path:
    """The record of the entry's driver: opencl-portable-computing-language-3.1.json"""
    parts: list[str] = str(entry["driver"]).split("; ")
    words = f"{entry['target']} {parts[min(1, len(parts) - 1)]}".lower()
    return folder / f"{re.sub(r'[^a-z0-9.]+', '-', words).strip('-')}.json"


def better(new: Entry, old: Entry | None) -> bool:
    """Whether an entry replaces what is recorded: it has other sources, or saw at least as many numbers."""
    return old is None or new["source"] != old["source"] or new["numbers"] >= old["numbers"]


def keep(entries: Iterable[Entry], folder: Path = RESULTS) -> list[Path]:
    """Write the entries into the records of their drivers; returns the files that changed."""
    files: dict[Path, dict[str, Entry]] = {}
    for entry in entries:
        path = file_of(entry, folder)
        if path not in files:
            files[path] = read(path)
        if better(entry, files[path].get(entry["function"])):
            files[path][entry["function"]] = entry
    for path, table in files.items():
        folder.mkdir(exist_ok=True)
        text = json.dumps([table[name] for name in sorted(table)], indent=1)
        path.write_text(text + "\n", encoding="utf-8")
    return list(files)


def read(path: Path) -> dict[str, Entry]:
    """The entries of a record by function; empty where there is none."""
    if not path.exists():
        return {}
    return {entry["function"]: entry for entry in json.loads(path.read_text(encoding="utf-8"))}
