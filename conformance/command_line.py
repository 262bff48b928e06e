"""How commands of this folder end: bad input is one sentence and exit status 2."""

from __future__ import annotations

import sys
from collections.abc import Callable

import click

from codegen.errors import UserError


def run(command: Callable[[], object]) -> None:
    """Run a command of click with the arguments of this process."""
    try:
        command()
    except UserError as e:
        click.echo(f"error: {e}", err=True)
        sys.exit(2)
