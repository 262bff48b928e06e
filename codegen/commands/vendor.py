"""`vair vendor`: files to keep a copy of, with a lock."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import click

from codegen.backends import open_runtime
from codegen.commands.progress import progress
from codegen.emit.module import DEFAULT_PREFIX, HALF_PREFIX
from codegen.errors import UserError
from codegen.files import write_folder
from codegen.library import Library, load_library
from codegen.vendor.install import install, read_old_lock
from codegen.vendor.lock import NAME
from codegen.vendor.options import PRECISIONS, SCENE_ALONE, SCENE_SINGLE, Options, choose_dialects
from codegen.vendor.plan import Plan, plan_functions
from codegen.vendor.scene_plan import plan_scene, scene_dialects

NO_DRIVERS = "left out by --no-drivers"


@click.command("vendor")
@click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@click.option("--function", "functions", multiple=True, help="This function with what it needs; repeatable.")
@click.option("--scene", type=click.Path(path_type=Path), help="The function of a scene file instead.")
@click.option("--target", "targets", multiple=True, help="glsl, wgsl or opencl; repeatable.")
@click.option("--dialect", "dialects", multiple=True, help="A dialect by name, or all; repeatable.")
@click.option(
    "--prefix",
    help=f"Put before every name.  [default: {DEFAULT_PREFIX}, {HALF_PREFIX} in half precision]",
)
@click.option("--per-function", is_flag=True, help="One file per function instead of one per dialect.")
@click.option(
    "--precision",
    type=click.Choice(PRECISIONS),
    help="half: as vair emit writes it, for the functions that are of use in it.  [default: single]",
)
@click.option("--force", is_flag=True, help="Replace files that were edited or are not Vair's.")
@click.option("--no-drivers", is_flag=True, help="With --scene: prove by the float32 evaluation only.")
@click.option(
    "--map",
    "maps",
    type=click.Path(path_type=Path),
    help="Write line maps as those of vair emit into this folder, which lies outside of DIR.",
)
def command(
    folder: Path,
    functions: tuple[str, ...],
    scene: Path | None,
    targets: tuple[str, ...],
    dialects: tuple[str, ...],
    prefix: str | None,
    per_function: bool,
    precision: str | None,
    force: bool,
    no_drivers: bool,
    maps: Path | None,
) -> None:
    """Write files and vair.lock into DIR, or update what is there.

    Without further options an existing folder keeps those of its lock. All functions if none is named; the
    default dialect of each target if none is named. Files that were edited are refused, not overwritten.
    """
    if scene is not None and (functions or per_function):
        raise UserError(SCENE_ALONE)
    if scene is not None and precision == "half":
        raise UserError(SCENE_SINGLE)
    if maps is not None and maps.resolve().is_relative_to(folder.resolve()):
        raise UserError(f'"{maps}": maps in "{folder}" would be files that vair verify does not expect')
    library = load_library()
    old = read_old_lock(folder, force=force)
    given = any((functions, scene, targets, dialects, prefix is not None, per_function, precision))
    if old is not None and not given:
        options = old.options
    else:
        chosen = choose_dialects(targets, dialects) if targets or dialects or scene is None else ()
        if scene is not None:
            chosen = scene_dialects(scene, library, chosen)
        options = Options(
            dialects=chosen,
            functions=functions,
            scene=_relative(scene, folder) if scene is not None else "",
            prefix=prefix if prefix is not None else HALF_PREFIX if precision == "half" else DEFAULT_PREFIX,
            per_function=per_function,
            precision=precision or "single",
        )
    plan = planned(library, options, folder, drivers=not no_drivers)
    changed = install(folder, plan, force=force)
    if maps is not None:
        write_folder(maps, {name: text.encode("utf-8") for name, text in plan.maps().items()})
    count = len(plan.lock.functions)
    click.echo(
        f"{folder}: {count} function{'s' if count > 1 else ''} in {len(plan.files)} "
        f"file{'s' if len(plan.files) > 1 else ''}, {len(changed) or 'none'} of them changed; {NAME}"
    )


def planned(library: Library, options: Options, folder: Path, *, drivers: bool) -> Plan:
    """What would be written now."""
    if not options.scene:
        return plan_functions(library, options)
    with progress("reading the scene") as say:
        return plan_scene(library, options, folder, runtime if drivers else lambda target: NO_DRIVERS, say)


def runtime(target: str) -> Any:
    """The runtime of a target, or the reason why there is none."""
    try:
        return open_runtime(target)
    except UserError as e:
        return str(e)


def _relative(scene: Path, folder: Path) -> str:
    """A scene as the lock names it, so that both may move together."""
    return Path(os.path.relpath(scene.resolve(), folder.resolve())).as_posix()
