"""`python -m conformance.light`: the report's section on estimators of light alone, as page and data."""

from __future__ import annotations

import json
from pathlib import Path

import click

from codegen.backends import TARGETS
from codegen.errors import UserError
from codegen.files import write_text
from conformance.bench.run import places
from conformance.light.plan import Plan
from conformance.light.record import keep, recorded
from conformance.light.run import measure
from conformance.report.page import light_page


@click.command()
@click.option("-o", "--output", "folder", type=click.Path(path_type=Path), required=True, help="The folder.")
@click.option("--quick", is_flag=True, help="One map, three lobes, three numbers of samples.")
@click.option("--target", "targets", multiple=True, type=click.Choice(TARGETS), help="Repeatable.")
@click.option("--driver", "drivers", multiple=True, help="A driver of vair doctor by name; repeatable.")
@click.option("--from-recorded", is_flag=True, help="Measure nothing: show what was recorded.")
@click.option("--record", is_flag=True, help="Keep the results beside this command.")
def main(
    folder: Path,
    quick: bool,
    targets: tuple[str, ...],
    drivers: tuple[str, ...],
    from_recorded: bool,
    record: bool,
) -> None:
    """Measure error against samples and time of every estimator, and write light.html and light.json."""
    try:
        if record and (quick or from_recorded):
            raise UserError("--record keeps whole measurements: leave out --quick and --from-recorded")
        folder.mkdir(parents=True, exist_ok=True)
        if from_recorded:
            section = recorded()
            if section is None:
                raise UserError("nothing is recorded; measure first, and keep it with --record")
        else:
            section, missing = measure(
                places(targets or (() if drivers else TARGETS), drivers),
                Plan.quick() if quick else Plan(),
                lambda label, event: click.echo(f"{label}: {event.get('what', event['event'])}", err=True),
                at_once=1 if record else 2,
                quick=quick,
            )
            for label, why in missing.items():
                click.echo(f"skipped   {label}: {why}")
        write_text(folder / "light.json", json.dumps(section, indent=1) + "\n")
        write_text(folder / "light.html", light_page(section))
        if record:
            keep(section)
    except UserError as e:
        click.echo(f"conformance.light: {e}", err=True)
        raise SystemExit(2) from None
    click.echo(f"wrote     {folder / 'light.html'}")


if __name__ == "__main__":
    main()
