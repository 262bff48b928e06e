"""`vair render`: a picture of a scene, shaded by one target."""

from __future__ import annotations

import time
from pathlib import Path

import click
from rich.console import Console

from codegen.errors import UserError
from codegen.library import load_library


@click.command("render")
@click.argument("scene", type=click.Path(path_type=Path))
@click.option("--target", help="glsl, wgsl, opencl, numpy (float64) or numpy32; the scene's first if none.")
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help="The PNG file to write.")
def command(scene: Path, target: str | None, output: Path) -> None:
    """A picture of SCENE.toml, shaded by that target."""
    if output.suffix.lower() != ".png":
        raise UserError(f'cannot write "{output}": pictures are PNG files, whose names end in .png')
    try:
        from conformance.picture.render import render
    except ImportError as error:
        raise UserError(f"rendering needs the package {error.name}; install vair[render]") from error
    console, start = Console(stderr=True), time.perf_counter()
    with console.status(f"rendering {scene}"):
        name, driver = render(load_library(), scene, target, output)
    if console.is_terminal:
        seconds = time.perf_counter() - start
        console.print(f"{output}: {name}, {driver}, {seconds:.1f} s", highlight=False)
