"""`vair doctor`: which backends, drivers and validators are here, and what brings the rest."""

from __future__ import annotations

import importlib
from typing import Any

import click


@click.command("doctor")
def command() -> None:
    """Say which drivers, validators and packages are here; what to install for the rest."""
    doctor: Any = importlib.import_module("targets.doctor")
    rows = [*doctor.report(), *doctor.drivers_by_name()]
    width = max(len(row.component) for row in rows)
    kind = ""
    for row in rows:
        if row.kind != kind:
            click.echo(f"{row.kind}s")
            kind = row.kind
        state = row.version if row.found else f"missing; {row.hint}"
        click.echo(f"  {'+' if row.found else '-'} {row.component.ljust(width)}  {state}")
    drivers = [row for row in rows if row.kind == "driver"]
    found = sum(row.found for row in drivers)
    click.echo(
        f"\nvair check --driver NAME checks on a named driver\n{found} of {len(drivers)} drivers are ready"
    )
