"""`vair fur`: what an engine needs to draw a scene's fur."""

from __future__ import annotations

from pathlib import Path

import click
from rich.console import Console

from codegen.errors import UserError
from codegen.files import write_folder
from codegen.library import load_library


@click.command("fur")
@click.argument("scene", metavar="SCENE.toml", type=click.Path(path_type=Path))
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help="The folder to write.")
@click.option("--fixed", is_flag=True, help="Fold the scene's parameters into the stages as constants.")
def command(scene: Path, output: Path, fixed: bool) -> None:
    """Stages, pass states and buffers for the fur of SCENE.toml, by shells and fins.

    Writes vertex and fragment stages in GLSL 3.30 and ES 3.00, a WGSL module, the mesh as fur.bin, and
    fur.json, which describes passes with their states, attributes, uniforms and what was found in the mesh.
    """
    try:
        from conformance.picture.fur.studio import set_up_fur
    except ModuleNotFoundError as error:
        raise UserError(f"fur needs the package {error.name}; install vair[render]") from error
    console = Console(stderr=True)
    with console.status(f"growing the fur of {scene}"):
        studio = set_up_fur(load_library(), scene, pictured=False)
        files = (studio.fixed() if fixed else studio).kit()
    write_folder(output, files)
    if console.is_terminal:
        for name, count in studio.mesh.findings.items():
            console.print(f"{count:8} {name}", highlight=False)
