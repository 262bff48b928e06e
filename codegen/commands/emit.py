"""`vair emit`: one self-contained include."""

from __future__ import annotations

from pathlib import Path

import click

from codegen.backends import dialect
from codegen.emit.dialect import with_half, with_precise
from codegen.emit.module import emit
from codegen.files import write_text
from codegen.library import load_library


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
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Write this file instead of printing.")
def command(
    target: str,
    dialect_name: str | None,
    functions: tuple[str, ...],
    prefix: str | None,
    precise: bool,
    precision: str,
    output: Path | None,
) -> None:
    """Emit one self-contained include; all functions if none is named."""
    chosen = dialect(target, dialect_name)
    chosen = with_precise(chosen) if precise else chosen
    chosen = with_half(chosen) if precision == "half" else chosen
    text = emit(load_library(), chosen, list(functions) or None, prefix)
    if output is None:
        click.echo(text, nl=False)
    else:
        write_text(output, text)
