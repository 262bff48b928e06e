"""`vair scene`: the minimal library for a scene, proven, with a report."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

from codegen.backends import open_runtime
from codegen.commands.progress import progress
from codegen.errors import UserError
from codegen.evaluate.pages import hold_freed
from codegen.files import write_folder
from codegen.library import Library, load_library
from codegen.scene.build import Builder, Outcome, TargetResult
from codegen.scene.description.document import read_scene
from codegen.scene.report.markdown import as_markdown, summary
from codegen.scene.report.report import as_data, as_json
from codegen.scene.report.text import included

NO_DRIVERS = "left out by --no-drivers"
COLLECTED_AFTER = 1_000_000
"""New objects that may refer to others, after which Python looks for cycles."""


@click.command("scene")
@click.argument("scene_file", metavar="SCENE.toml", type=click.Path(path_type=Path))
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help="Folder for the files.")
@click.option("--no-drivers", is_flag=True, help="Prove by the float32 evaluation only; no device is opened.")
@click.option("--no-timing", is_flag=True, help="Leave the speed on the drivers out of the report.")
@click.option(
    "--map",
    "maps",
    type=click.Path(path_type=Path),
    help="Write line maps as vair emit does into this folder.",
)
def command(scene_file: Path, output: Path, no_drivers: bool, no_timing: bool, maps: Path | None) -> None:
    """Write the minimal function for a scene, for each of its targets, with report.md and report.json."""
    library = load_library()
    scene = read_scene(scene_file, library)
    for folder in (output, maps):
        if folder is not None and folder.exists() and not folder.is_dir():
            raise UserError(f'cannot write to "{folder}": it is a file')
    hold_freed()
    runtimes: dict[str, Any] = {}
    for target in scene.dialects:
        runtimes[target] = NO_DRIVERS if no_drivers else _runtime(target)
    with progress("reading the scene") as say, _rare_collection():
        outcome = Builder(library, scene, runtimes, timed=not no_timing, say=say).build()
    data = as_data(outcome)
    files = {result.file: result.text for result in outcome.targets}
    files |= {"report.md": as_markdown(data), "report.json": as_json(data)}
    write_folder(output, {name: text.encode("utf-8") for name, text in files.items()})
    if maps is not None:
        write_folder(
            maps, {f"{r.file}.json": line_map(library, outcome, r).encode() for r in outcome.targets}
        )
    click.echo(summary(data, output))


def line_map(library: Library, outcome: Outcome, result: TargetResult) -> str:
    """The line map of a target's file as JSON."""
    from codegen.lines import linemap  # few ask for it

    dialect, _, defined = included(library, outcome.scene, outcome.general, result.reduced)
    return linemap.as_json(linemap.map_of(dialect, result.text, defined))


@contextmanager
def _rare_collection() -> Iterator[None]:
    """Python's search for cycles less often: a search makes millions of objects and hardly a cycle."""
    before = gc.get_threshold()
    gc.set_threshold(COLLECTED_AFTER, *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)


def _runtime(target: str) -> Any:
    """The runtime of a target, or the reason why there is none."""
    try:
        return open_runtime(target)
    except UserError as e:
        return str(e)
