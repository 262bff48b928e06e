"""`python -m conformance.fuzz_parsers.campaign --seconds 280`: go on until each reader had a million files.

Takes up what results.json lacks, reader after reader: first what follows coverage, then the rest from seeds.
Each reader runs in a process of its own, which records itself; an interrupted campaign is started again.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator

import click

from conformance.fuzz_parsers import readers, record

LEAST_SECONDS = 25.0
"""Time in which a reader does more than start."""


def lacking(names: tuple[str, ...], until: int, by_coverage: int) -> Iterator[tuple[str, str, int]]:
    """Reader, way and number of files that are not recorded yet of its present code."""
    for way in ("by_coverage", "blind"):
        for name in names:
            found = record.recorded(name, readers.code_hash(name))
            count = by_coverage - found.by_coverage if way == "by_coverage" else until - found.runs
            if count > 0:
                yield name, way, count


@click.command()
@click.argument("names", nargs=-1)
@click.option("--until", default=1_000_000, show_default=True, help="Files of each reader.")
@click.option("--by-coverage", default=200_000, show_default=True, help="Of these by coverage, at least.")
@click.option("--seconds", default=3600.0, show_default=True, help="End after about this time.")
def main(names: tuple[str, ...], until: int, by_coverage: int, seconds: float) -> None:
    """Fuzz the readers NAMES, all if none is named, until each had its files."""
    end = time.monotonic() + seconds
    for name, way, count in lacking(names or tuple(readers.MODULES), until, by_coverage):
        left = end - time.monotonic()
        if left < LEAST_SECONDS:
            return
        options = ["--runs", str(count), "--seconds", f"{left:.0f}", "--record"]
        options += ["--blind"] if way == "blind" else []
        done = subprocess.run(
            [sys.executable, "-m", "conformance.fuzz_parsers", name, *options],
            cwd=readers.ROOT,
            capture_output=True,
            text=True,
            check=False,
        )
        print((done.stdout.strip().splitlines() or ["it said nothing"])[-1], flush=True)
        if done.returncode:
            sys.exit(f"{done.stdout[-4000:]}\n{done.stderr[-4000:]}")


if __name__ == "__main__":
    main()
