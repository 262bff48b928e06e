"""`vair list`: the public functions."""

from __future__ import annotations

import json

import click

from codegen.describe import as_data, signature
from codegen.library import load_library
from codegen.version import VERSION


@click.command("list")
@click.option(
    "--json", "as_json", is_flag=True, help="Machine-readable: signature, domain, error, operations."
)
def command(as_json: bool) -> None:
    """List the public functions: signature, section, variants, domain, declared error."""
    library = load_library()
    if as_json:
        functions = [as_data(library, f) for f in library.documented.values()]
        structs = [
            {
                "name": s.name,
                "section": s.module,
                "summary": s.doc.summary,
                "fields": [{"name": f.name, "type": f.type.name} for f in s.type.fields],
            }
            for s in library.structs.values()
        ]
        click.echo(json.dumps({"version": VERSION, "functions": functions, "structs": structs}, indent=2))
        return
    section = None
    for f in library.documented.values():
        if f.module != section:
            section = f.module
            click.echo(f"\n{section}" if f is not next(iter(library.documented.values())) else section)
        note = {"variant": f"   variant of {f.base}", "printed": f"   printed form of {f.base}"}.get(
            f.kind, ""
        )
        click.echo(f"  {signature(f)}{note}")
        for bound in library.bounds_of(f.name):
            click.echo(f"      error {bound.describe()}")
