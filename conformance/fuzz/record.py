"""Which random programs have been run, one entry per run in results.json: the record grows, run by run.

Programs are known by seed and number. A further run of a seed on the same targets begins where the last one
ended, so that no program is counted twice; `source` tells of which generator, backends and intervals. A
finding stays until its program is run again and found right: then its number stands under `mended`.
"""

from __future__ import annotations

import functools
import json
import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from datetime import date
from pathlib import Path
from typing import Any

from codegen.files import write_text
from conformance.fuzz.engine import Tally
from conformance.fuzz.task import COUNTS
from conformance.sources import hash_of

RESULTS = Path(__file__).with_name("results.json")
PARTS = ("frontend", "ir", "ops", "passes", "emit", "evaluate", "intervals")
SOURCES = (*(f"codegen/{part}" for part in PARTS), "targets", "conformance/fuzz", "conformance/programs")
"""What programs, texts and verdicts depend on."""
SAME = ("seed", "targets", "source")
"""Entries that agree in these are one run."""
Entry = dict[str, Any]


def read(path: Path = RESULTS) -> list[Entry]:
    """All entries; none where nothing was recorded."""
    return list(json.loads(path.read_text(encoding="utf-8"))) if path.exists() else []


def entry(tally: Tally, seed: int, first: int, targets: Sequence[str], today: date) -> Entry:
    """A run as data."""
    return {
        "seed": seed,
        "first": first,
        "programs": tally.programs,
        "targets": list(targets),
        "source": source_hash(),
        "date": today.isoformat(),
        **{name: dict(sorted(getattr(tally, name).items())) for name in COUNTS},
        "findings": [str(finding) for finding in tally.findings],
        "mended": [],
    }


def following(entries: Iterable[Entry], seed: int, targets: Sequence[str]) -> int:
    """The first program of a seed that was not run yet on these targets."""
    stops = [
        e["first"] + e["programs"] for e in entries if e["seed"] == seed and e["targets"] == list(targets)
    ]
    return max(stops, default=0)


def added(entries: Sequence[Entry], new: Entry) -> list[Entry]:
    """Entries with one more, joined to the run that it continues."""
    for k, old in enumerate(entries):
        follows = old["first"] + old["programs"] == new["first"]
        if follows and all(old[key] == new[key] for key in SAME):
            return [*entries[:k], _joined(old, new), *entries[k + 1 :]]
    return [*entries, new]


def _joined(old: Entry, new: Entry) -> Entry:
    sums = {}
    for name in COUNTS:
        count = Counter[str](old[name]) + Counter[str](new[name])
        sums[name] = dict(sorted(count.items()))
    return {
        **new,
        "first": old["first"],
        "programs": old["programs"] + new["programs"],
        **sums,
        **{name: [*old[name], *new[name]] for name in ("findings", "mended")},
    }


def checked_again(entries: Iterable[Entry], run: Callable[[int, int, list[str]], Tally]) -> list[Entry]:
    """Entries whose findings were run once more, by run(seed, number, targets); what is right is mended."""
    found = []
    for e in entries:
        wrong: list[str] = []
        mended = list(e["mended"])
        for finding in e["findings"]:
            number = number_of(finding)
            left = run(e["seed"], number, e["targets"]).findings
            wrong += map(str, left)
            mended += [] if left else [number]
        found.append({**e, "findings": list(dict.fromkeys(wrong)), "mended": sorted(set(mended))})
    return found


def number_of(finding: str) -> int:
    """The number of the program that a finding in words is about."""
    told = re.search(r"--case (\d+)", finding)
    assert told is not None
    return int(told[1])


def write(entries: Iterable[Entry], path: Path = RESULTS) -> None:
    """Keep entries, one a line."""
    write_text(path, "[\n" + ",\n".join(json.dumps(e) for e in entries) + "\n]\n")


@functools.cache
def source_hash() -> str:
    """Of everything that a verdict depends on, so that entries say what they hold of."""
    return hash_of(SOURCES)
