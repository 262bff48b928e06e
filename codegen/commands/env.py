"""`vair env`: an environment map made ready for shaders."""

from __future__ import annotations

from pathlib import Path

import click
from rich.console import Console

from codegen.files import write_folder
from codegen.maps.prepared import Settings, prepare, unexpected


@click.command("env")
@click.argument("source", metavar="MAP", type=click.Path(path_type=Path))
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help="The folder to write.")
@click.option("--mapping", default="dual-paraboloid", show_default=True, help="Or octahedral.")
@click.option("--size", default=256, show_default=True, help="Texels along a side of the largest level.")
@click.option("--border", default=1.2, show_default=True, help="Paraboloids: how far beyond the rim.")
@click.option("--plain", is_flag=True, help="Average texels of the chain without their solid angles.")
@click.option("--prefilter", "exponents", multiple=True, type=float, help="A Phong lobe; repeatable.")
@click.option("--clean", is_flag=True, help="Mend NaN, infinite and negative values instead of refusing.")
def command(
    source: Path,
    output: Path,
    mapping: str,
    size: int,
    border: float,
    plain: bool,
    exponents: tuple[float, ...],
    clean: bool,
) -> None:
    """A latitude-longitude MAP (.exr, .hdr, .png) as a paraboloid or octahedral map with its chain.

    Writes one OpenEXR file per level and per prefiltered lobe, and env.json, which describes them.
    """
    console = Console(stderr=True)
    weighting = "plain" if plain else "solid-angle"
    settings = Settings(mapping, size, border, weighting, exponents, clean)
    with console.status("reading") as status:
        prepared = prepare(source, settings, lambda step: status.update(step))
        status.update(f"writing {output}")
        write_folder(output, prepared.files())
    if unexpected(settings):
        click.echo(f"note: {unexpected(settings)}", err=True)
    if console.is_terminal:
        count = len(prepared.manifest["levels"])
        console.print(f"{output}: {count} levels, {len(exponents)} prefiltered lobes", highlight=False)
