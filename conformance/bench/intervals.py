"""How long interval evaluation takes: python -m conformance.bench.intervals [--function F]... [--table T]...

Processor time per point, of one thread and of all that the evaluator uses, on uniform points of the domain;
the least of some runs, since other work only adds. Nothing is claimed from it: it says where to look.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

import click

from codegen.errors import unknown
from codegen.intervals import TABLES, permitted
from codegen.library import Library, load_library
from conformance.cases.drawing import UNIFORM, draw
from conformance.command_line import run

POINTS = 65536
RUNS = 2
GOAL = 2.0
"""Seconds that a million points of a function should take at most."""


def processor_time(library: Library, name: str, inputs: Mapping[str, Any], table: str, runs: int) -> float:
    """Seconds of processor time of one evaluation, the least of some; a first one warms up."""
    permitted(library, name, inputs, table)
    least = float("inf")
    for _ in range(runs):
        begin = time.process_time()
        permitted(library, name, inputs, table)
        least = min(least, time.process_time() - begin)
    return least


@click.command()
@click.option("--function", "functions", multiple=True, help="Functions; all public ones by default.")
@click.option("--table", "tables", multiple=True, type=click.Choice(TABLES), help="Tables; all by default.")
@click.option("--points", default=POINTS, show_default=True, help="Points per function.")
@click.option("--runs", default=RUNS, show_default=True, help="Timed runs, of which the least counts.")
def main(functions: tuple[str, ...], tables: tuple[str, ...], points: int, runs: int) -> None:
    """Print nanoseconds per point, a line per function, slow ones marked."""
    library = load_library()
    for name in functions:
        if name not in library.public:
            raise unknown("function", name, library.public)
    chosen = tables or TABLES
    slow = 0
    click.echo(f"{'ns a point':36s}" + "".join(f"{t:>16s}" for t in chosen))
    for name in functions or library.public:
        inputs = draw(library.function(name), UNIFORM, points)
        taken = [processor_time(library, name, inputs, t, runs) / points for t in chosen]
        slow += (is_slow := max(taken) * 1e6 > GOAL)
        row = "".join(f"{seconds * 1e9:16.0f}" for seconds in taken)
        click.echo(f"{name:36s}{row}{'  slow' if is_slow else ''}")
    click.echo(f"{slow} of {len(functions or library.public)} need more than {GOAL:g} s for a million points")


if __name__ == "__main__":
    run(main)
