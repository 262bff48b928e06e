"""`vair table`: a function of two arguments as a texture."""

from __future__ import annotations

import json
from pathlib import Path

import click
from rich.console import Console

from codegen.commands.factor import numbers
from codegen.errors import UserError
from codegen.files import write_folder
from codegen.library import load_library
from codegen.maps.undated import undated_exr
from codegen.tables.arguments import two_arguments
from codegen.tables.tabulate import LARGEST, Table, tabulate
from codegen.version import VERSION


@click.command("table")
@click.argument("function")
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help="The folder to write.")
@click.option("--budget", default=1.0 / 510.0, show_default="half an 8-bit step", help="The largest error.")
@click.option("--set", "settings", multiple=True, metavar="NAME=VALUE", help="Hold a parameter; repeatable.")
@click.option("--range", "ranges", multiple=True, metavar="NAME=LOW:HIGH", help="Cover less of an argument.")
@click.option("--largest", default=LARGEST, show_default=True, help="Texels along a side, at most.")
def command(
    function: str,
    output: Path,
    budget: float,
    settings: tuple[str, ...],
    ranges: tuple[str, ...],
    largest: int,
) -> None:
    """Tabulate a library FUNCTION of two arguments; the budget decides on axes and size.

    Numbers, or two directions by their cosines with t or n, are arguments. Writes table.exr and table.json.
    """
    console = Console(stderr=True)
    with console.status(f"tabulating {function}"):
        held, covered = numbers(settings), intervals(ranges)
        table = tabulate(*two_arguments(load_library(), function, held, covered), budget, largest)
    write_folder(output, files(function, held, budget, table))
    if console.is_terminal:
        height, width = table.values.shape
        console.print(f"{function}: {width} x {height}, error {table.error:.2g}", highlight=False)


def intervals(ranges: tuple[str, ...]) -> dict[str, tuple[float, float]]:
    """The intervals of --range NAME=LOW:HIGH options by name; raises UserError for one that is none."""
    found = {}
    for text in ranges:
        name, _, ends = text.partition("=")
        low, _, high = ends.partition(":")
        try:
            found[name.strip()] = (float(low), float(high))
        except ValueError:
            raise UserError(f'--range "{text}": it is NAME=LOW:HIGH') from None
    return found


def files(function: str, held: dict[str, float], budget: float, table: Table) -> dict[str, bytes]:
    """The files that are written, by name."""
    height, width = table.values.shape
    manifest = {
        "schema": 1,
        "version": VERSION,
        "function": function,
        "held": held,
        "width": width,
        "height": height,
        "x": vars(table.x),
        "y": vars(table.y),
        "lookup": "coordinate c of an axis in [0, 1] -> texture coordinate (c (size - 1) + 0.5) / size",
        "budget": budget,
        "error": float(f"{table.error:.4g}"),
    }
    return {
        "table.exr": undated_exr(table.values),
        "table.json": (json.dumps(manifest, indent=1) + "\n").encode(),
    }
