"""How long interval evaluation takes: python -m conformance.bench.intervals [--function F]... [--table T]...

Seconds for a million points, uniform over the domain: on the wall, with the threads that the evaluator has by
default or that VAIR_INTERVAL_THREADS gives it, and of processor time, of all threads together. The least of
some runs each, since other work only adds; on a busy machine the wall says little. Nothing is claimed from
it: it says where to look.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

import click
import numpy as np

from codegen.errors import unknown
from codegen.intervals import TABLES, permitted
from codegen.library import Library, load_library
from conformance.cases.drawing import UNIFORM, draw
from conformance.check.draws import length
from conformance.check.sample import rows
from conformance.command_line import run

POINTS = 1_000_000
FEW = 2048
"""Points of a first evaluation, which loads what is compiled."""
RUNS = 2
GOAL = 2.0
"""Seconds on the wall that a million points of a function should take at most."""


def seconds(
    library: Library, name: str, inputs: Mapping[str, Any], table: str, runs: int
) -> tuple[float, float]:
    """Seconds on the wall and of processor time of one evaluation, the least of some runs each."""
    permitted(library, name, rows(inputs, np.arange(min(FEW, length(inputs)))), table)
    wall, processor = [], []
    for _ in range(runs):
        begin = time.perf_counter(), time.process_time()
        permitted(library, name, inputs, table)
        wall.append(time.perf_counter() - begin[0])
        processor.append(time.process_time() - begin[1])
    return min(wall), min(processor)


@click.command()
@click.option("--function", "functions", multiple=True, help="Functions; all public ones by default.")
@click.option("--table", "tables", multiple=True, type=click.Choice(TABLES), help="Tables; all by default.")
@click.option(
    "--points", type=click.IntRange(1), default=POINTS, show_default=True, help="Points per function."
)
@click.option(
    "--runs",
    type=click.IntRange(1),
    default=RUNS,
    show_default=True,
    help="Timed runs, of which the least counts.",
)
def main(functions: tuple[str, ...], tables: tuple[str, ...], points: int, runs: int) -> None:
    """Print seconds for a million points, wall beside processor, a line per function, slow ones marked."""
    library = load_library()
    for name in functions:
        if name not in library.public:
            raise unknown("function", name, library.public)
    names, chosen = functions or tuple(library.public), tables or TABLES
    slow = 0
    click.echo(f"{'wall and processor s':36s}" + "".join(f"{t:>16s}" for t in chosen))
    for name in names:
        inputs = draw(library.function(name), UNIFORM, points)
        scale = 1e6 / points
        taken = [seconds(library, name, inputs, t, runs) for t in chosen]
        slow += (is_slow := max(wall for wall, _ in taken) * scale > GOAL)
        row = "".join(f"{wall * scale:8.2f}{processor * scale:8.2f}" for wall, processor in taken)
        click.echo(f"{name:36s}{row}{'  slow' if is_slow else ''}")
    click.echo(f"{slow} of {len(names)} need more than {GOAL:g} s on the wall for a million points")


if __name__ == "__main__":
    run(main)
