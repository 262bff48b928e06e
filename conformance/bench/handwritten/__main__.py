"""`python -m conformance.bench.handwritten`: a scene's function beside hand-written ones, on every target."""

from __future__ import annotations

import click
from rich.console import Console
from rich.table import Table

from codegen.backends import TARGETS
from codegen.library import load_library
from conformance.bench.handwritten.beside import BY_HAND, FIXED, Row, rows
from conformance.command_line import run
from targets import TargetUnavailable, open_runtime


@click.command()
@click.option("--target", "targets", multiple=True, type=click.Choice(TARGETS), help="Repeatable.")
def main(targets: tuple[str, ...]) -> None:
    """Time and error of the scene's function, the general one and two written by hand, in one process."""
    console, library = Console(width=110), load_library()
    for target in targets or TARGETS:
        try:
            runtime = open_runtime(target)
        except TargetUnavailable as e:
            console.print(f"{target}: {e}")
            continue
        console.print(table(rows(library, runtime, target), f"{target}: {runtime.device.device}"))


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
