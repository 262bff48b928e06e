"""`vair emit`: one self-contained include."""

from __future__ import annotations

import math
from pathlib import Path

import click

from codegen.backends import dialect
from codegen.choice import MEASURES, choose_all, describe
from codegen.emit.dialect import with_half, with_precise
from codegen.emit.frame import file_text
from codegen.emit.module import include
from codegen.errors import UserError
from codegen.files import write_text
from codegen.library import load_library
from codegen.lines.directives import directives_of, with_directives
from codegen.lines.linemap import as_json, map_of


@click.command("emit")
@click.option("--target", required=True, help="glsl, wgsl or opencl.")
@click.option("--dialect", "dialect_name", help="A dialect of the target; its default if none.")
@click.option(
    "--function", "functions", multiple=True, help="Emit this function with what it needs; repeatable."
)
@click.option("--prefix", help="Put before every name.  [default: vair_, vair_half_ in half precision]")
@click.option(
    "--precise", is_flag=True, help="GLSL: qualify every float local, so that nothing is reordered."
)
@click.option(
    "--precision",
    type=click.Choice(["single", "half"]),
    default="single",
    show_default=True,
    help="half: WGSL f16, GLSL mediump, OpenCL half; for the functions that are of use in it.",
)
@click.option(
    "--max-error",
    type=click.FloatRange(min=0.0),
    help="Of each function the cheapest recorded variant whose error on the whole domain is no larger.",
)
@click.option(
    "--measure",
    type=click.Choice(MEASURES),
    default="absolute",
    show_default=True,
    help="With --max-error: what the error is measured in.",
)
@click.option("--line-directives", is_flag=True, help="State the source of each line by #line; not in WGSL.")
@click.option(
    "--map", "map_file", type=click.Path(path_type=Path), help="Write line -> function, source, line as JSON."
)
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Write this file instead of printing.")
def command(
    target: str,
    dialect_name: str | None,
    functions: tuple[str, ...],
    prefix: str | None,
    precise: bool,
    precision: str,
    max_error: float | None,
    measure: str,
    line_directives: bool,
    map_file: Path | None,
    output: Path | None,
) -> None:
    """Emit one self-contained include; all functions if none is named."""
    chosen = dialect(target, dialect_name)
    chosen = with_precise(chosen) if precise else chosen
    chosen = with_half(chosen) if precision == "half" else chosen
    names = list(functions) or None
    if max_error is not None:
        if not math.isfinite(max_error):  # NaN is in every click range
            raise UserError(f"--max-error {max_error:g}: the largest error is a number from 0 on")
        if precision == "half":
            raise UserError("--max-error chooses by errors in single precision; leave out --precision half")
        names = choose_names(target, names, max_error, measure)
    head, defined = include(
        load_library(), chosen, names, prefix, " --line-directives" if line_directives else ""
    )
    directives = (
        directives_of(chosen, defined, output.name if output else "include") if line_directives else None
    )
    text = with_directives(directives, head, defined) if directives else file_text(chosen, head, defined)
    if map_file is not None:
        numbers = directives.numbers if directives and not directives.by_name else None
        write_text(map_file, as_json(map_of(chosen, text, defined, numbers)))
    if output is None:
        click.echo(text, nl=False)
    else:
        write_text(output, text)


def choose_names(target: str, names: list[str] | None, limit: float, measure: str) -> list[str]:
    """What to emit for these functions; says on standard error what it was chosen from."""
    choices = choose_all(load_library(), target, names, limit, measure)
    for choice in choices:
        for line in describe(choice, target, limit, measure):
            click.echo(line, err=True)
    return [choice.chosen for choice in choices]
