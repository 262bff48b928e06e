"""`python -m conformance.search`: look for the inputs on which public functions err most, and keep them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from codegen.backends import TARGETS
from codegen.library import load_library
from conformance.cases.found import FOLDER
from conformance.check import show
from conformance.check.engine import backend
from conformance.command_line import run
from conformance.search.climb import Find, climb
from conformance.search.corpus import keep
from conformance.search.objective import Objective
from targets import TargetUnavailable


@click.command()
@click.option("--function", "functions", multiple=True, help="Only this function; repeatable.")
@click.option("--target", "targets", multiple=True, help="Only this target; repeatable.")
@click.option("--seconds", default=3.0, show_default=True, help="Time per function and target.")
@click.option("--seed", default=1, show_default=True)
@click.option("--report", default=0.5, show_default=True, help="Print finds above that share of their bound.")
@click.option("--folder", type=click.Path(path_type=Path), default=FOLDER, help="Where the tables are kept.")
def main(
    functions: tuple[str, ...],
    targets: tuple[str, ...],
    seconds: float,
    seed: int,
    report: float,
    folder: Path,
) -> None:
    """Search every public function on every driver that is here; exit status 1 if a bound is exceeded."""
    library = load_library()
    exceeded = evaluations = gained = 0
    for target in targets or TARGETS:
        try:
            on = backend(target)
        except TargetUnavailable as e:
            click.echo(f"skipped   {target}: {e}")
            continue
        for name in functions or library.public:
            objective = Objective(library, name, on)
            result = climb(objective, seconds, seed)
            evaluations += result.evaluations
            for find in sorted(result.finds, key=lambda f: -f.ratio):
                exceeded += find.ratio > 1.0
                if find.ratio > report:
                    click.echo(told(find))
            gained += keep(library, result.finds, folder)
    click.echo(f"{evaluations} evaluations, {exceeded} bounds exceeded, {gained} worst inputs kept")
    raise SystemExit(1 if exceeded else 0)


def told(find: Find) -> str:
    """One find in two lines."""
    inputs: dict[str, Any] = find.inputs
    return (
        f"{find.ratio:6.3f} of its bound: {find.function} on {find.target} errs {find.error:.4g}; "
        f"{find.bound.describe()}\n       {show.lane_inputs(inputs, 0)}"
    )


if __name__ == "__main__":
    run(main)
