"""`python -m conformance.soundness`: intervals hold the exact value, on a million points a function."""

from __future__ import annotations

import sys

import click
from rich.console import Console
from rich.progress import Progress

from codegen.errors import unknown
from codegen.library import load_library
from conformance.command_line import run
from conformance.executor import open_executor
from conformance.soundness import record
from conformance.soundness.jobs import missing, sweep_missing

POINTS = 1_000_000


@click.command()
@click.option("--function", "names", multiple=True, help="Only this function; repeatable.")
@click.option("--points", default=POINTS, show_default=True, help="Random points, beside all hard cases.")
@click.option("--workers", default=2, show_default=True, help="Processes of this machine.")
@click.option("--scheduler", help="Use the workers of a Dask scheduler: tcp://host:8786.")
@click.option("--fresh", is_flag=True, help="Sweep again what is recorded as swept with as many points.")
@click.option("--record/--no-record", "keep", default=True, help="Keep what was found in results.json.")
def main(
    names: tuple[str, ...], points: int, workers: int, scheduler: str | None, fresh: bool, keep: bool
) -> None:
    """Sweep what is not recorded yet; exit status 1 where an interval misses an exact value."""
    library = load_library()
    for name in names:
        if name not in library.public:
            raise unknown("function", name, library.public)
    entries = record.read()
    jobs = list(missing(library, names or list(library.public), {} if fresh else entries, points))
    failed = False
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("functions", total=len(jobs))
        for result in sweep_missing(library, open_executor(workers, scheduler), jobs, entries):
            name = result.job.function
            progress.update(task, description=name, advance=1)
            if not result.done:
                failed = True
                click.echo(f"{result.job.identity}: {result.error}")
            elif not record.passed(result.data):
                failed = True
                click.echo(f"{name}: an interval misses the exact value: {result.data['worst']}")
            if keep:
                record.write(e for n, e in entries.items() if n in library.public)
    click.echo("\n".join(record.summary(entries.values())))
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    run(main)
