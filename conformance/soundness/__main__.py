"""`python -m conformance.soundness`: intervals hold the exact value, on a million points a function."""

from __future__ import annotations

import sys
import time

import click
from rich.console import Console
from rich.progress import Progress

from codegen.errors import unknown
from codegen.library import load_library
from conformance.command_line import run
from conformance.soundness import record
from conformance.soundness.sweep import sweep

POINTS = 1_000_000


@click.command()
@click.option("--function", "names", multiple=True, help="Only this function; repeatable.")
@click.option("--points", default=POINTS, show_default=True, help="Random points, beside all hard cases.")
@click.option("--seconds", default=0, help="Begin no function after so long; 0: do all.")
@click.option("--fresh", is_flag=True, help="Sweep again what is recorded as swept with as many points.")
@click.option("--record/--no-record", "keep", default=True, help="Keep what was found in results.json.")
def main(names: tuple[str, ...], points: int, seconds: int, fresh: bool, keep: bool) -> None:
    """Sweep what is not recorded yet; exit status 1 where an interval misses an exact value."""
    library = load_library()
    for name in names:
        if name not in library.public:
            raise unknown("function", name, library.public)
    entries = record.read()
    chosen = [
        name
        for name in names or library.public
        if fresh
        or name not in entries
        or entries[name]["points"] < points
        or not record.is_current(library, entries[name])
    ]
    begin, failed = time.monotonic(), False
    console = Console(stderr=True)
    with Progress(console=console, disable=not console.is_terminal) as progress:
        task = progress.add_task("functions", total=len(chosen))
        for name in chosen:
            if seconds and time.monotonic() - begin > seconds:
                break
            entry = sweep(library, name, points).entry()
            entries[name] = entry
            if not record.passed(entry):
                failed = True
                click.echo(f"{name}: an interval misses the exact value: {entry['worst']}")
            if keep:
                record.write(e for n, e in entries.items() if n in library.public)
            progress.advance(task)
    click.echo("\n".join(record.summary(entries.values())))
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    run(main)
