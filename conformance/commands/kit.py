"""`vair kit`: test vectors and stubs for a backend that is not shipped."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click
from rich.console import Console
from rich.progress import Progress

from codegen.backends import TARGETS
from codegen.errors import UserError, unknown
from codegen.kit import readme
from codegen.kit.folder import NewFolder
from codegen.kit.stubs import stub_files
from codegen.kit.vectors import FORMAT, as_json, as_npz
from codegen.library import load_library
from codegen.version import VERSION
from conformance.check.draws import SEED
from conformance.foreign.make import FAMILY, LANES, prepared_vectors, vectors


@click.command("kit")
@click.option("-o", "--output", "folder", type=click.Path(path_type=Path), required=True, help="The folder.")
@click.option("--function", "functions", multiple=True, help="Only this function; repeatable.")
@click.option("--target", "targets", multiple=True, help="Stubs for this target only; repeatable.")
@click.option(
    "--lanes",
    type=click.IntRange(1, 100_000),
    default=LANES,
    show_default=True,
    help="Random points of each function; hard cases come on top, an eighth as many of each family.",
)
def command(folder: Path, functions: tuple[str, ...], targets: tuple[str, ...], lanes: int) -> None:
    """Write vectors, texts and stubs to check an engine or a compiler that Vair does not ship."""
    library = load_library()
    for target in targets:
        if target not in TARGETS:
            raise unknown("target", target, TARGETS)
    names = list(dict.fromkeys(library.function(name).name for name in functions)) or list(library.public)
    for name in names:
        if name not in library.public:
            raise UserError(f"{name} has no vectors: only public functions of numbers are drawn")
    family = max(lanes * FAMILY // LANES, 1)
    kit = {"format": FORMAT, "version": VERSION, "lanes": lanes, "family": family, "functions": names}
    identities: dict[str, str] = {}
    source = library.select(names).source_hash
    about = {"kit": kit, "source": source, "seed": SEED, "vectors": identities}
    console = Console(stderr=True)
    with (
        NewFolder(folder) as new,
        Progress(console=console, transient=True, disable=not sys.stderr.isatty()) as progress,
    ):
        for target in targets or TARGETS:
            new.add(stub_files(library, target, names).items())
        task = progress.add_task("vectors", total=len(names))
        for name in names:
            progress.update(task, description=name)
            found = vectors(prepared_vectors(library, name, lanes, family))
            identities[name] = found.identity
            new.add([(f"vectors/{name}.json", as_json(found)), (f"vectors/{name}.npz", as_npz(found))])
            progress.advance(task)
        new.add([("kit.json", (json.dumps(about, indent=1) + "\n").encode()), ("README.md", readme())])
        new.place()
    click.echo(f"wrote     {folder}: {len(names)} functions")
