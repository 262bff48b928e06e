"""`vair where`: which source line an emitted line, or a compiler's message, speaks of."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from codegen.documents import read_text
from codegen.errors import UserError
from codegen.lines.linemap import read_map
from codegen.lines.where import Message, annotated, origin_of


@click.command("where")
@click.argument("map_file", metavar="MAP.json", type=click.Path(path_type=Path))
@click.argument("line", type=click.IntRange(1), required=False)
@click.option(
    "--log", type=click.Path(path_type=Path), help='Explain this log of a compiler; "-": what is piped in.'
)
@click.option(
    "--first",
    type=click.IntRange(1),
    default=1,
    show_default=True,
    help="The line of the host's text in which the emitted file begins.",
)
def command(map_file: Path, line: int | None, log: Path | None, first: int) -> None:
    """Say which source line a line of an emitted file comes from, by the map that --map wrote."""
    found = read_map(map_file)
    if (line is None) == (log is None):
        raise UserError("vair where needs a line of the emitted file, or a compiler's messages by --log")
    if log is not None:
        text = sys.stdin.read() if str(log) == "-" else read_text(log)
        click.echo("\n".join(annotated(found, text, first)))
        return
    assert line is not None
    origin = origin_of(found, Message("", 0, line), first)
    if origin is None:
        last = first + found.lines - 1
        if not first <= line <= last:
            raise UserError(f"line {line} is not in the emitted file, which takes lines {first} to {last}")
        click.echo(f"line {line} defines nothing: it is a comment, a guard or empty")
        return
    click.echo(str(origin))
