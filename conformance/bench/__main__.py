"""`./dev bench`: speed beside error on every driver of this machine, and the promised figures."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.progress import Progress, TaskID

from codegen.backends import TARGETS
from codegen.errors import UserError, unknown
from codegen.files import write_text
from codegen.library import VERSION, load_library
from conformance.bench.emission import emission_figures
from conformance.bench.record import RESULTS, SCHEMA, as_json, rounded, slug
from conformance.bench.report import LEGEND, console, figure_table, self_check_line, speed_table
from conformance.bench.run import Options, measure

EMISSION_RUNS = 5


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@click.option("--quick", is_flag=True, help="Fewer rounds and fewer inputs.")
@click.option(
    "--function", "functions", multiple=True, help="Only this function and its variants; repeatable."
)
@click.option("--target", "names", multiple=True, help="glsl, wgsl or opencl; repeatable.")
@click.option("--json", "json_file", type=click.Path(path_type=Path), help="Write everything as JSON.")
@click.option(
    "--record", is_flag=True, help="Keep the results under conformance/bench/results, one worker at a time."
)
def command(
    quick: bool, functions: tuple[str, ...], names: tuple[str, ...], json_file: Path | None, record: bool
) -> int:
    """Measure speed beside error on this machine's drivers, and the promised figures."""
    library = load_library()
    wanted = tuple(library.function(name).name for name in functions)
    for name in names:
        if name not in TARGETS:
            raise unknown("target", name, TARGETS)
    if record and (quick or wanted):
        raise UserError("--record keeps whole measurements: leave out --quick and --function")
    options = Options.quick(wanted) if quick else Options(wanted, at_once=1 if record else 2)
    if wanted:
        options = Options(**{**vars(options), "figures": 0})
    with Watcher() as watcher:
        results, missing = measure(names or TARGETS, options, watcher)
    whole = [] if wanted else [f.as_data() for f in emission_figures(library, 2 if quick else EMISSION_RUNS)]
    show(results, missing, rounded(whole))
    if json_file is not None:
        data = {"schema": SCHEMA, "version": VERSION, "skipped": missing, "emission": rounded(whole)}
        write_text(json_file, as_json({**data, "drivers": results}))
    if record:
        keep(results)
    if not results:
        raise UserError("there is no driver to measure on; see vair doctor")
    if names and missing:
        raise UserError("; ".join(f"target {t} is not available: {why}" for t, why in missing.items()))
    return 0


class Watcher(Progress):
    """Progress on a terminal, silence in a pipe."""

    def __init__(self) -> None:
        super().__init__(console=Console(stderr=True), transient=True, disable=not sys.stderr.isatty())
        self._bars: dict[str, TaskID] = {}

    def __call__(self, target: str, event: dict[str, Any]) -> None:
        if event["event"] == "started":
            self._bars[target] = self.add_task(target, total=event["total"])
        elif event["event"] == "done":
            self.update(self._bars[target], description=f"{target}: {event['what']}", advance=1)


def show(results: list[dict[str, Any]], missing: dict[str, str], emission: list[dict[str, Any]]) -> None:
    """All tables."""
    out = console()
    for target, why in missing.items():
        out.print(f"skipped   {target}: {why}")
    for result in results:
        out.print(speed_table(result))
        out.print(self_check_line(result), highlight=False)
        out.print()
    if results:
        out.print(LEGEND, highlight=False)
        out.print()
    figures = [f for result in results for f in result["figures"]] + emission
    if figures:
        out.print(figure_table(figures))


def keep(results: list[dict[str, Any]]) -> None:
    """Write each driver's result where the README's table and `vair list` read it."""
    RESULTS.mkdir(exist_ok=True)
    for result in results:
        file = RESULTS / f"{slug(result['device'])}.json"
        write_text(file, as_json(result))
        click.echo(f"recorded {file.name}")


def main() -> None:
    """Run and exit: 0 measured, 2 bad usage or no driver."""
    try:
        status = command.main(prog_name="./dev bench", standalone_mode=False)
    except UserError as e:
        click.echo(f"bench: {e}", err=True)
        sys.exit(2)
    except click.ClickException as e:
        click.echo(f"bench: {' '.join(e.format_message().split())}", err=True)
        sys.exit(2)
    except (click.Abort, KeyboardInterrupt):
        click.echo("bench: interrupted", err=True)
        sys.exit(130)
    sys.exit(status if isinstance(status, int) else 0)


if __name__ == "__main__":
    main()
