"""`vair demo`: what the library does, to look at and to play with."""

from __future__ import annotations

import tempfile
import webbrowser
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import click
from rich.console import Console

from codegen.errors import UserError
from codegen.files import write_folder
from codegen.library import load_library


@click.group("demo")
def command() -> None:
    """The library to look at: `demo web` is a page with a furry bunny to turn."""


@command.command("web")
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Keep the page in this folder.")
@click.option("--scene", type=click.Path(path_type=Path), help="A scene with fur, shaded by fakefur.")
@click.option("--port", type=click.IntRange(0, 65535), default=0, help="The port; a free one if not given.")
@click.option("--no-browser", is_flag=True, help="Do not open a browser.")
@click.option("--no-serve", is_flag=True, help="Only write the folder of -o, for another web server.")
def web(output: Path | None, scene: Path | None, port: int, no_browser: bool, no_serve: bool) -> None:
    """A page with a furry bunny to turn, drawn by WebGPU or WebGL2 from the generated stages.

    It is served on 127.0.0.1 until Ctrl-C, and needs no network. The folder of -o is static: any web server
    will do.
    """
    if no_serve and output is None:
        raise UserError("--no-serve needs -o FOLDER, where the page is to be written")
    try:
        from conformance.web.build import page_files
    except ModuleNotFoundError as error:
        raise UserError(f"the page needs the package {error.name}; install vair[render]") from error
    from conformance.web.serve import address, open_server

    with Console(stderr=True).status("growing the fur of the page"):
        files = page_files(load_library(), scene)
    with _folder(output) as folder:
        write_folder(folder, files)
        if no_serve:
            return
        with open_server(folder, files, port) as server:
            click.echo(f"{address(server)}  (Ctrl-C ends it)")
            if not no_browser:
                webbrowser.open(address(server))
            try:
                server.serve_forever()
            except KeyboardInterrupt:
                click.echo("", err=True)


@contextmanager
def _folder(output: Path | None) -> Iterator[Path]:
    """The folder that was asked for, or one that is gone afterwards."""
    if output is not None:
        yield output
        return
    with tempfile.TemporaryDirectory(prefix="vair-web-") as made:
        yield Path(made)
