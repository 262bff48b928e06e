"""`python -m conformance.metamorphic`: every pair of inputs and of programs, on every target."""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.progress import Progress

from codegen.files import write_text
from codegen.library import load_library
from conformance.command_line import run
from conformance.executor import Result, available, open_executor
from conformance.executor.state import State
from conformance.metamorphic.engine import Report
from conformance.metamorphic.task import pieces, run_jobs, source_hash
from targets import TARGETS

STATE = Path("build/metamorphic/state.jsonl")
RESULTS = Path(__file__).with_name("results.json")
LANES = 256


@click.command()
@click.option("--target", "names", multiple=True, type=click.Choice(TARGETS), help="Targets; all by default.")
@click.option("--lanes", default=LANES, show_default=True, help="Inputs of each pair.")
@click.option("--workers", default=2, show_default=True, help="Processes of this machine.")
@click.option("--scheduler", help="Use the workers of a Dask scheduler: tcp://host:8786.")
@click.option("--state", type=click.Path(path_type=Path), default=STATE, show_default=True)
@click.option("--record/--no-record", default=True, help="Keep the counts in results.json.")
def main(
    names: tuple[str, ...], lanes: int, workers: int, scheduler: str | None, state: Path, record: bool
) -> None:
    """Run all pairs; what was done before is not done again. Exit status 1 where two results disagree."""
    begin = time.monotonic()
    targets = [name for name in names or TARGETS if scheduler or not available(name)]
    for name in set(names or TARGETS) - set(targets):
        click.echo(f"skipped   {name}: {available(name)}")
    jobs = pieces(load_library(), targets, lanes)
    with Progress(console=Console(stderr=True), transient=True, disable=not sys.stderr.isatty()) as bar:
        task = bar.add_task("pairs", total=len(jobs))

        def advance(result: Result) -> None:
            bar.update(task, description=result.job.function, advance=1)

        report, undone = run_jobs(open_executor(workers, scheduler), jobs, State(state), advance)
    click.echo("\n".join([*report.lines(), *report.failures, *undone]))
    click.echo(f"{time.monotonic() - begin:.0f} s")
    if record and targets and not undone:
        write_text(RESULTS, json.dumps(recorded(report, targets, lanes), indent=1) + "\n")
    sys.exit(1 if report.failures or undone else 0)


def recorded(report: Report, targets: list[str], lanes: int) -> dict[str, Any]:
    """The counts as data, relation by relation."""
    return {
        "source": source_hash(),
        "targets": targets,
        "lanes": lanes,
        "pairs": report.pairs,
        "failures": report.failures,
        "relations": {name: vars(count) for name, count in sorted(report.counts.items())},
    }


if __name__ == "__main__":
    run(main)
