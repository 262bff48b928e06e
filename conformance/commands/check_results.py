"""`vair check --results`: verdicts on results that were computed elsewhere."""

from __future__ import annotations

import sys
from pathlib import Path

import click
from rich.console import Console
from rich.progress import Progress

from codegen.kit.results import read_results
from codegen.library import Library
from conformance.check.report import lines
from conformance.check.result import FunctionResult
from conformance.foreign.judge import judge


def check_results(
    library: Library, path: Path, names: tuple[str, ...], table: str | None
) -> list[FunctionResult]:
    """Judge a file, with progress on a terminal; raises UserError where it cannot be judged."""
    results = read_results(library, path)
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not sys.stderr.isatty()) as progress:
        task = progress.add_task("judging", total=len(names or results.wanted))
        found = []
        for result in judge(library, results, names, table or ""):
            found.append(result)
            progress.advance(task)
    return found


def tell_results(results: list[FunctionResult], details: bool) -> int:
    """Print the verdicts; returns the exit status."""
    for line in lines(results, details):
        click.echo(line)
    return 0 if all(r.passed for r in results) else 1
