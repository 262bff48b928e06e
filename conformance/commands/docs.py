"""`vair docs`: the documentation as pages that need no network."""

from __future__ import annotations

import sys
from pathlib import Path

import click
from rich.console import Console
from rich.progress import Progress

from codegen.errors import UserError
from codegen.kit.folder import NewFolder
from codegen.library import load_library

INDEX = "index.html"


@click.command("docs")
@click.option("-o", "--output", "folder", type=click.Path(path_type=Path), required=True, help="The folder.")
@click.option("--function", "functions", multiple=True, help="Pages of these functions only; repeatable.")
def command(folder: Path, functions: tuple[str, ...]) -> None:
    """Write a page for every function, and the guides, as HTML that needs no network."""
    try:
        from conformance.pages.site import site
    except ImportError as error:
        raise UserError(f"the pages need the package {error.name}; install vair[report]") from error
    library = load_library()
    names = list(dict.fromkeys(library.function(name).name for name in functions)) or list(library.documented)
    console = Console(stderr=True)
    with (
        NewFolder(folder) as new,
        Progress(console=console, transient=True, disable=not sys.stderr.isatty()) as progress,
    ):
        task = progress.add_task("pages", total=len(names))
        for path, data in site(library, names):
            new.add([(path, data)])
            if path.startswith("functions/"):
                progress.advance(task)
        new.place()
    click.echo(f"wrote     {folder / INDEX}: {len(names)} functions")
