"""How much each reader was fuzzed: results.json, and the table of README.md that is made of it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

from codegen.files import write_text
from conformance.marked import with_part

FOLDER = Path(__file__).parent
RESULTS = FOLDER / "results.json"
README = FOLDER / "README.md"
BEGIN = "<!-- results: written by python -m conformance.fuzz_parsers NAME --record -->"
END = "<!-- end of results -->"


@dataclass(frozen=True)
class Record:
    """What was run of one reader on one state of its code.

    code         hash of the modules that read, see readers.py
    by_coverage  files that followed coverage
    blind        files of bytes drawn from seeds
    taken        files that the reader took; it refused the others in a sentence
    seconds      processor time of both
    seeds        seeds of each way
    date         of the last run
    """

    code: str
    by_coverage: int = 0
    blind: int = 0
    taken: int = 0
    refused: int = 0
    seconds: float = 0.0
    seeds: Mapping[str, int] = field(default_factory=lambda: {"by_coverage": 0, "blind": 0})
    date: str = ""

    @property
    def runs(self) -> int:
        return self.by_coverage + self.blind

    def with_run(self, way: str, taken: int, refused: int, seconds: float, date: str) -> Record:
        """The record with one run more; way is by_coverage or blind, its seed the number of its runs."""
        count = {way: getattr(self, way) + taken + refused}
        return replace(
            self,
            **count,
            taken=self.taken + taken,
            refused=self.refused + refused,
            seconds=round(self.seconds + seconds, 1),
            seeds={**self.seeds, way: self.seeds[way] + 1},
            date=date,
        )


def read() -> dict[str, Record]:
    """What is recorded, by reader."""
    data = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
    return {name: Record(**entry) for name, entry in data.items()}


def recorded(name: str, code: str) -> Record:
    """What is recorded of a reader as it is now; an empty record where its code has changed since."""
    found = read().get(name)
    return found if found is not None and found.code == code else Record(code)


def keep(name: str, record: Record, order: list[str]) -> None:
    """Replace the record of one reader, and the table."""
    found = {**read(), name: record}
    data = {key: asdict(found[key]) for key in order if key in found}
    write_text(RESULTS, json.dumps(data, indent=1) + "\n")
    page = README.read_text(encoding="utf-8")
    write_text(README, with_part(page, BEGIN, END, f"\n\n{table(found)}\n\n"))


def table(found: Mapping[str, Record]) -> str:
    """The table of all readers."""
    lines = [
        "| reader | files | by coverage | blind | taken | refused | processor time, s | code | last |",
        "|---|---:|---:|---:|---:|---:|---:|---|---|",
    ]
    for name, r in found.items():
        counts = " | ".join(f"{n:,}" for n in (r.runs, r.by_coverage, r.blind, r.taken, r.refused))
        lines.append(f"| `{name}` | {counts} | {r.seconds:.0f} | `{r.code[:8]}` | {r.date} |")
    return "\n".join(lines)
