"""`vair show`: what a function means, and its text."""

from __future__ import annotations

import click

from codegen.backends import TARGETS, dialect
from codegen.describe import describe
from codegen.emit.module import emit
from codegen.errors import UserError
from codegen.library import load_library


@click.command("show")
@click.argument("function")
@click.option("--target", help="Show the text of this target only: glsl, wgsl or opencl.")
@click.option("--dialect", "dialect_name", help="A dialect of that target.")
def command(function: str, target: str | None, dialect_name: str | None) -> None:
    """Print a function's documentation and emitted text."""
    if dialect_name is not None and target is None:
        raise UserError("--dialect needs --target: dialects belong to a target")
    library = load_library()
    found = library.function(function)
    chosen = [dialect(t, dialect_name) for t in ([target] if target else TARGETS)]
    click.echo("\n".join(describe(library, found)))
    for d in chosen:
        click.echo(f"\n{'-' * 20} {d.title} {'-' * 20}\n")
        click.echo(emit(library, d, [function]), nl=False)
