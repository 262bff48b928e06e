"""`vair report`: speed against error on this machine's drivers, as data, page and picture."""

from __future__ import annotations

import shlex
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.progress import Progress, TaskID

from codegen.backends import TARGETS
from codegen.costs import recorded
from codegen.errors import UserError, unknown
from codegen.library import Library, load_library
from conformance.bench.emission import emission_figures
from conformance.bench.inputs import groups
from conformance.bench.record import rounded
from conformance.bench.run import Options, measure, places
from conformance.bench.visits import LEAST_VISITS
from conformance.light import plan
from conformance.light.record import keep as keep_light
from conformance.light.record import recorded as recorded_light
from conformance.light.run import measure as measure_light
from conformance.report.agreement import agreement
from conformance.report.model import build, read_report
from conformance.report.scenes import figures_of

EMISSION_RUNS = 5


@click.command("report")
@click.option("-o", "--output", "folder", type=click.Path(path_type=Path), required=True, help="The folder.")
@click.option("--quick", is_flag=True, help="Two minutes: fewer rounds, fewer inputs, core functions first.")
@click.option(
    "--function", "functions", multiple=True, help="Only this function and its variants; repeatable."
)
@click.option("--target", "targets", multiple=True, help="glsl, wgsl or opencl; repeatable.")
@click.option("--driver", "drivers", multiple=True, help="A driver of vair doctor by name; repeatable.")
@click.option(
    "--scene",
    "scenes",
    multiple=True,
    type=click.Path(path_type=Path),
    help="A scene file, or a folder that vair scene wrote: figures before and after; repeatable.",
)
@click.option("--from-recorded", is_flag=True, help="Measure nothing: show what was recorded.")
@click.option("--against", type=click.Path(path_type=Path), help="Say where an earlier report disagrees.")
@click.option("--record", is_flag=True, help="Keep the results for the README and vair emit --max-error.")
def command(
    folder: Path,
    quick: bool,
    functions: tuple[str, ...],
    targets: tuple[str, ...],
    drivers: tuple[str, ...],
    scenes: tuple[Path, ...],
    from_recorded: bool,
    against: Path | None,
    record: bool,
) -> None:
    """Measure the speed of every variant beside its error, and write report.html and report.json."""
    library = load_library()
    wanted = tuple(library.function(name).name for name in functions)
    groups(library, wanted)  # refuses here what every worker would refuse
    for name in targets:
        if name not in TARGETS:
            raise unknown("target", name, TARGETS)
    if record and (quick or wanted or from_recorded):
        raise UserError(
            "--record keeps whole measurements: leave out --quick, --function and --from-recorded"
        )
    if from_recorded and (quick or drivers):
        raise UserError("--from-recorded measures nothing: leave out --quick and --driver")
    where = [] if from_recorded else places(targets if targets or drivers else TARGETS, drivers)
    try:
        from conformance.report.picture import overview
        from conformance.report.write import keep, prepare, write
    except ImportError as error:
        raise UserError(f"the report needs the package {error.name}; install vair[report]") from error
    prepare(folder)
    before = read_report(against) if against is not None else None
    shown = [figures_of(path, folder) for path in scenes]
    skipped: dict[str, str] = {}
    emission: list[dict[str, Any]] = []
    light: dict[str, Any] | None = None
    if from_recorded:
        results = kept_results(library, targets, wanted)
        light = None if wanted else recorded_light()
    else:
        if not (quick or wanted):
            emission = [f.as_data() for f in emission_figures(library, EMISSION_RUNS)]
        with_light = not wanted and plan.maps_are_here()
        options = Options.quick(wanted) if quick else Options(wanted, at_once=1 if record else 2)
        if quick and with_light:
            options = replace(options, seconds=options.seconds - plan.QUICK_SECONDS)
        results, skipped = measured(where, options, named=bool(targets or drivers))
        if with_light:
            chosen = plan.Plan.quick() if quick else plan.Plan()
            with Watcher() as watcher:
                light, _ = measure_light(where, chosen, watcher, at_once=options.at_once, quick=quick)
    report = build(
        library,
        results,
        command=shlex.join(["vair", *sys.argv[1:]]),
        recorded=from_recorded,
        skipped=skipped,
        emission=rounded(emission),
        scenes=shown,
        light=light,
    )
    say_skipped(results, skipped)
    for path in write(library, report, folder):
        click.echo(f"wrote     {path}")
    if record:
        for path in keep(results, overview(report)):
            click.echo(f"recorded  {path.name}")
        for path in keep_light(light) if light is not None else ():
            click.echo(f"recorded  light/{path.name}")
    if before is not None:
        say_agreement(results, before["drivers"])


def measured(
    where: list[Any], options: Options, *, named: bool
) -> tuple[list[dict[str, Any]], dict[str, str]]:
    """The results of the drivers, and why others are missing; raises UserError where none is left."""
    with Watcher() as watcher:
        results, missing = measure(where, options, watcher)
    if not results:
        raise UserError(f"there is no driver to measure on: {'; '.join(missing.values())}; see vair doctor")
    if named and missing:
        raise UserError("; ".join(f"{label} is not available: {why}" for label, why in missing.items()))
    return results, missing


def kept_results(library: Library, targets: tuple[str, ...], wanted: tuple[str, ...]) -> list[dict[str, Any]]:
    """The recorded results, of some targets and functions if any are named."""
    results = [r for r in recorded() if not targets or r["device"]["target"] in targets]
    if not results:
        raise UserError("nothing is recorded; measure with vair report -o DIR, and keep it with --record")
    if not wanted:
        return results
    bases = {f["base"] for r in results for f in r["functions"] if f["name"] in wanted}
    for name in wanted:
        if not any(f["name"] == name for r in results for f in r["functions"]):
            raise UserError(f"nothing is recorded of {name}: only functions with variants are measured")
    return [
        {
            **r,
            "functions": [f for f in r["functions"] if f["base"] in bases],
            "groups": [g for g in r["groups"] if g["base"] in bases],
        }
        for r in results
    ]


def say_skipped(results: list[dict[str, Any]], skipped: dict[str, str]) -> None:
    """Drivers that are not here, and functions that the time did not suffice for."""
    for label, why in skipped.items():
        click.echo(f"skipped   {label}: {why}")
    for r in results:
        if r["left_out"]:
            count = len(r["left_out"])
            click.echo(f"left out  {r['device']['short']}: {count} functions for want of time")


def say_agreement(now: list[dict[str, Any]], before: list[dict[str, Any]]) -> None:
    """How far the orders of two measurements agree."""
    found = agreement(now, before)
    click.echo(
        f"agreement {found.differ} pairs differ by more than 5 %, {found.decided} of them are decided in "
        f"both reports; {len(found.contradictions)} come in another order"
    )
    for pair in found.contradictions:
        click.echo(f"          {pair}")
    once = [which for which, results in (("this", now), ("the earlier", before)) if visited_once(results)]
    if once:
        click.echo(
            f"          single visits in {' and '.join(once)} report: such orders may not be reproducible"
        )


def visited_once(results: list[dict[str, Any]]) -> bool:
    """Whether any result rests on single visits, as quick ones and those of earlier versions do."""
    modes = [data for r in results for g in r["groups"] for data in g["modes"].values()]
    visits = [data.get("visits") for data in modes]
    return any(not isinstance(v, list) or len(v) < LEAST_VISITS for v in visits)


class Watcher(Progress):
    """Progress on a terminal, silence in a pipe."""

    def __init__(self) -> None:
        super().__init__(console=Console(stderr=True), transient=True, disable=not sys.stderr.isatty())
        self._bars: dict[str, TaskID] = {}

    def __call__(self, label: str, event: dict[str, Any]) -> None:
        if event["event"] == "started":
            self._bars[label] = self.add_task(label, total=event["total"])
        elif event["event"] == "done":
            self.update(self._bars[label], description=f"{label}: {event['what']}", advance=1)
