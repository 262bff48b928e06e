"""What sweeps showed, one entry per function in results.json, and which of it still counts."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from codegen.files import write_text
from codegen.library import Library
from conformance.soundness.sweep import intervals_hash

RESULTS = Path(__file__).with_name("results.json")
Entry = dict[str, Any]


def read(path: Path = RESULTS) -> dict[str, Entry]:
    """Function -> entry; empty where nothing was recorded."""
    if not path.exists():
        return {}
    entries: list[Entry] = json.loads(path.read_text(encoding="utf-8"))
    return {entry["function"]: entry for entry in entries}


def write(entries: Iterable[Entry], path: Path = RESULTS) -> None:
    """Keep entries, one a line, in the order of their functions' names."""
    lines = [json.dumps(entry) for entry in sorted(entries, key=lambda e: str(e["function"]))]
    write_text(path, "[\n" + ",\n".join(lines) + "\n]\n")


def joined(before: Entry, more: Entry) -> Entry:
    """An entry with the further batches of another, of the same sources."""
    tables = {
        table: {verdict: count + before["tables"][table][verdict] for verdict, count in counts.items()}
        for table, counts in more["tables"].items()
    }
    sums = {key: before[key] + more[key] for key in ("batches", "points", "hard")}
    seconds = round(before["seconds"] + more["seconds"], 1)
    return {**more, **sums, "seconds": seconds, "tables": tables, "worst": before["worst"] or more["worst"]}


def is_current(library: Library, entry: Entry) -> bool:
    """Whether function and intervals are still those of the entry."""
    same_source = library.select([entry["function"]]).source_hash == entry["source"]
    return same_source and bool(entry["intervals"] == intervals_hash())


def batches(library: Library, entry: Entry | None) -> int:
    """How many batches of random points an entry holds of the present sources; 0 without one."""
    return int(entry.get("batches", 0)) if entry is not None and is_current(library, entry) else 0


def passed(entry: Entry) -> bool:
    """Whether no interval missed an exact value."""
    return all(count["outside"] == 0 for count in entry["tables"].values())


def summary(entries: Iterable[Entry]) -> list[str]:
    """Functions, points and lanes by verdict, one line each; lanes of tables that promise the same once."""
    found = list(entries)
    counts = [count for entry in found for count in entry["tables"].values()]
    lines = [
        f"{len(found)} functions, {sum(e['points'] for e in found)} points, {len(counts)} tables of functions"
    ]
    for key, what in VERDICTS.items():
        lines.append(f"  {sum(count[key] for count in counts):12d} {what}")
    return lines


VERDICTS = {
    "enclosed": "held: by enclosures in float64",
    "precise": "held: in 50 digits",
    "open": "nothing promised",
    "undecided": "undecided",
    "outside": "NOT held",
}
