"""Draws as data: what came of each sample of mutants, in the order in which they were drawn (results.json).

A group's last draw is its figure. An earlier one says what the tests of that day were worth: its survivors
have led to tests since, so that only a fresh draw, of another seed, can tell the share of all mutants.
"""

from __future__ import annotations

import datetime
import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from conformance.mutation.isolated import REFUSED, SURVIVED
from conformance.mutation.plan import excuse
from conformance.mutation.run import EQUIVALENT, Result, tally

PATH = Path(__file__).parent / "results.json"
FILE_COLUMNS = ("mutants", "killed", "equivalent", "survived")

Draw = dict[str, Any]
"""One draw: see draw_of."""


def draw_of(results: Sequence[Result], seed: int | None, of: int) -> Draw:
    """A draw as data.

    seed        of the sample; None where all mutants were tried
    of          number of all mutants of the group
    date        of the draw
    killed, survived, equivalent, refused: numbers of mutants
    seconds     a mutant takes on average, from its start to its verdict, two at a time
    files       file (folder for shading functions) -> numbers as in FILE_COLUMNS
    survivors   the mutants that no test noticed
    reasons     why mutants are equivalent -> how many
    """
    t = tally(results)
    return {
        "seed": seed,
        "of": of,
        "date": datetime.date.today().isoformat(),
        "killed": t.killed,
        "survived": t.survived,
        "equivalent": t.equivalent,
        "refused": t.refused,
        "seconds": round(sum(r.seconds for r in results) / max(len(results), 1), 1),
        "files": _files(results),
        "survivors": [str(r.mutant) for r in results if r.outcome == SURVIVED],
        "reasons": dict(Counter(excuse(r.mutant) for r in results if r.outcome == EQUIVALENT).most_common()),
    }


def _files(results: Sequence[Result]) -> dict[str, list[int]]:
    by_file: dict[str, list[Result]] = {}
    for r in results:
        if r.outcome != REFUSED:
            folder = r.mutant.path.rpartition("/")[0]
            shown = f"{folder}/" if folder.startswith("shaderlib") else r.mutant.path
            by_file.setdefault(shown, []).append(r)
    found = {}
    for path, some in sorted(by_file.items()):
        t = tally(some)
        found[path] = [len(some), t.killed, t.equivalent, t.survived]
    return found


def read(path: Path = PATH) -> dict[str, list[Draw]]:
    """Group -> its draws, oldest first."""
    found: dict[str, list[Draw]] = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    return found


def add(group: str, draw: Draw, path: Path = PATH) -> None:
    """Keep a draw; one of the same seed and day is replaced."""
    found = read(path)
    kept = [d for d in found.get(group, []) if (d["seed"], d["date"]) != (draw["seed"], draw["date"])]
    found[group] = [*kept, draw]
    path.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
