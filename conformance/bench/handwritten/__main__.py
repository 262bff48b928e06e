"""`python -m conformance.bench.handwritten`: a scene's function beside hand-written ones, on every target.

--record keeps the result and the tables of README.md.
"""

from __future__ import annotations

import datetime
import os

import click
from rich.console import Console
from rich.table import Table

from codegen.backends import TARGETS
from codegen.errors import UserError
from codegen.library import load_library
from codegen.scene.report.speed import CHAINS, ROUNDS
from conformance.bench.handwritten import record
from conformance.bench.handwritten.beside import BY_HAND, FIXED, POINTS, Row, rows
from conformance.bench.record import machine_data
from conformance.command_line import run
from targets import TargetUnavailable, open_runtime
from targets.protocol import Device


@click.command()
@click.option("--target", "targets", multiple=True, type=click.Choice(TARGETS), help="Repeatable.")
@click.option("--record", "keep", is_flag=True, help="Keep the result and the tables of README.md.")
def main(targets: tuple[str, ...], keep: bool) -> None:
    """Time and error of the scene's function, the general one and two written by hand, in one process."""
    console, library = Console(width=110), load_library()
    if keep and targets:
        raise UserError("--record keeps every target; leave --target out")
    found: dict[str, tuple[str, list[Row]]] = {}
    for target in targets or TARGETS:
        try:
            runtime = open_runtime(target)
        except TargetUnavailable as e:
            console.print(f"{target}: {e}")
            continue
        found[target] = _driver(runtime.device), rows(library, runtime, target)
        console.print(table(found[target][1], f"{target}: {found[target][0]}"))
    if keep:
        record.keep(record.as_data(_about(), found))


def _driver(device: Device) -> str:
    return f"{device.device}; {device.driver}"


def _about() -> dict[str, str]:
    return {
        "date": datetime.date.today().isoformat(),
        "method": (
            f"Medians and quartiles of {ROUNDS} rounds, forwards and backwards in one process, {CHAINS} "
            "independent chains a lane, above a kernel that adds up the inputs; CPU time of the driver's "
            f"computing threads; errors over {POINTS:,} points; {machine_data()['cpu']}, load average "
            f"{os.getloadavg()[0]:.1f} at the end, {os.cpu_count()} processors"
        ),
    }


def table(found: list[Row], title: str) -> Table:
    """One driver's rows, with the time relative to both hand-written functions."""
    by_name = {row.function: row for row in found}
    shown = Table(title=title, title_justify="left")
    for column in (
        "function", "ns [quartiles]", "of by hand", "of fixed", "ordinary", "hard", "not finite",
    ):  # fmt: skip
        shown.add_column(column, justify="left" if column == "function" else "right")
    for row in found:
        shown.add_row(
            row.function,
            f"{row.ns:.2f} [{row.low:.2f}-{row.high:.2f}]",
            f"{row.ns / by_name[BY_HAND].ns:.2f}",
            f"{row.ns / by_name[FIXED].ns:.2f}",
            f"{row.ordinary:.3g}",
            f"{row.hard:.3g}",
            str(row.non_finite),
        )
    return shown


if __name__ == "__main__":
    run(main)
