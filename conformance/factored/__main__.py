"""`python -m conformance.factored`: how well reflectances factor, and what that costs."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.markdown import Markdown

from codegen.backends import TARGETS
from codegen.files import write_text
from codegen.version import VERSION
from conformance.bench.record import as_json, slug
from conformance.bench.run import Place, in_worker, places, side_by_side
from conformance.command_line import run
from conformance.factored import page, worker
from conformance.factored.fits import MATERIALS, fit_row, material_row
from conformance.factored.plan import library, read_plan
from conformance.factored.published import WATERLOO


@click.command()
@click.option(
    "--target",
    "targets",
    multiple=True,
    type=click.Choice(TARGETS),
    help="Time this target only; repeatable.",
)
@click.option("--driver", "drivers", multiple=True, help="Time this driver by its name; repeatable.")
@click.option("--fits/--no-fits", "fitted", default=True, help="Fit again, or take what is recorded.")
@click.option("--speed/--no-speed", "timed", default=True, help="Whether to time.")
@click.option("--quick", is_flag=True, help="Fewer rounds, rough factors: to see that it works.")
@click.option("--materials", type=click.Path(path_type=Path), default=WATERLOO, help="Published ones.")
@click.option("--record", is_flag=True, help="Keep the results and write README.md.")
def main(
    targets: tuple[str, ...],
    drivers: tuple[str, ...],
    fitted: bool,
    timed: bool,
    quick: bool,
    materials: Path,
    record: bool,
) -> None:
    """Fit the plan's reflectances, time the factored shades, print both as tables."""
    console = Console(width=150)
    kept = page.read_fits()
    with console.status("fitting"):
        fits = fit_all(materials, kept) if fitted else kept
    where = places(targets or (() if drivers else TARGETS), drivers) if timed else []
    with console.status("timing"):
        found, missing = side_by_side(where, 1, 0.0, partial(time_on, quick=quick)) if where else ([], {})
    for label, reason in missing.items():
        console.print(f"{label}: {reason}")
    if record:
        write_text(page.RESULTS / page.FITS, as_json(fits))
        for data in found:
            write_text(page.RESULTS / f"{slug(data['device'])}.json", as_json(data))
        write_text(page.PAGE, page.recorded())
    console.print(Markdown(page.written(fits, found)))


def time_on(place: Place, seconds: float, *, quick: bool) -> dict[str, Any] | str:
    """The measurement of one driver, or why it is not here; it takes what time it takes."""
    job = worker.job(place.target, place.driver, quick=quick)
    return in_worker("conformance.factored.worker", place, job, lambda label, event: None)


def fit_all(materials: Path, kept: dict[str, Any]) -> dict[str, Any]:
    """Errors of all fits, and what the materials are like: as recorded where their files are not here."""
    plan = read_plan()
    folders = [materials / name for name in MATERIALS]
    here = all(folder.is_dir() for folder in folders)
    return {
        "schema": 1,
        "version": VERSION,
        "samples": plan.samples,
        "fresh": plan.fresh,
        "above": plan.above,
        "fits": [fit_row(library(), plan, fit) for fit in plan.fits],
        "materials": [material_row(folder) for folder in folders] if here else kept.get("materials", []),
    }


if __name__ == "__main__":
    run(main)
