"""`vair check`: conformance on this machine's drivers."""

from __future__ import annotations

import json
import sys
from datetime import date
from pathlib import Path

import click
from rich.console import Console
from rich.progress import Progress

from codegen.backends import TARGETS
from codegen.errors import UserError, unknown
from codegen.files import write_bytes, write_text
from codegen.library import Library, load_library
from codegen.version import VERSION
from conformance.check.ahead import prepared_ahead
from conformance.check.backend import Backend, backend
from conformance.check.engine import check_function
from conformance.check.junit import junit_bytes
from conformance.check.merge import merge as join_results
from conformance.check.replay import cases_of
from conformance.check.report import lines, verdict_lines
from conformance.check.result import FunctionResult
from conformance.check.shard import Shard
from conformance.commands.check_drivers import Plan, check_drivers, replay_on_driver
from conformance.commands.check_results import check_results, tell_results
from conformance.drivers import known
from conformance.drivers.modes import DEFAULT
from targets import TargetUnavailable

CHECKABLE = (*TARGETS, "numpy")
DETAILED = 6
"""Up to so many functions that were asked for by name are reported one by one."""


@click.command("check")
@click.option(
    "--target", "names", multiple=True, help="glsl, wgsl, opencl, or numpy (the evaluator); repeatable."
)
@click.option(
    "--driver", "drivers", multiple=True, help="A driver of vair doctor by name, or all; repeatable."
)
@click.option("--mode", "modes", multiple=True, help="With --driver: a mode by name, or all; repeatable.")
@click.option("--record", is_flag=True, help="With --driver: keep the results under conformance/results.")
@click.option("--resume", is_flag=True, help="With --record: leave out what is recorded of these sources.")
@click.option("--function", "functions", multiple=True, help="Check this function only; repeatable.")
@click.option("--json", "json_file", type=click.Path(path_type=Path), help="Write the results as JSON.")
@click.option(
    "--junit", "junit_file", type=click.Path(path_type=Path), help="Write the results as JUnit XML."
)
@click.option("--details", is_flag=True, help="Verdicts and accuracy of each function; as with --function.")
@click.option("--replay", "replayed", help="Run cases again: a printed identity, or a file of --json.")
@click.option("--shard", default="1/1", help="Check a fixed share of the functions and targets only: 2/3.")
@click.option(
    "--results", "computed", type=click.Path(path_type=Path), help="Judge results made with a vair kit."
)
@click.option("--table", help="With --results: the accuracy table that judges.")
@click.option("--merge", is_flag=True, help="Join the results in FILES instead of checking.")
@click.argument("files", nargs=-1, type=click.Path(path_type=Path))
def command(
    names: tuple[str, ...],
    drivers: tuple[str, ...],
    modes: tuple[str, ...],
    record: bool,
    resume: bool,
    functions: tuple[str, ...],
    json_file: Path | None,
    junit_file: Path | None,
    details: bool,
    replayed: str | None,
    shard: str,
    computed: Path | None,
    table: str | None,
    merge: bool,
    files: tuple[Path, ...],
) -> int:
    """Check every function on this machine's drivers.

    Every result is judged twice: by the interval that the target's specification permits, and by the declared
    error bounds against a float64 reference. Finite input must give finite results.
    """
    library = load_library()
    part = Shard.parse(shard)
    if merge or files:
        return run_merge(files, merge, json_file, junit_file)
    if replayed is not None:
        return run_replay(library, replayed)
    wanted = [library.function(name).name for name in functions] or list(library.public)
    is_detailed = details or 0 < len(functions) <= DETAILED
    if computed is not None:
        if names or drivers or record:
            raise UserError("--results judges what was computed elsewhere: leave out --target and --driver")
        judged = check_results(library, computed, functions, table)
        write_results(judged, [], part, json_file, junit_file)
        return tell_results(judged, is_detailed)
    if table is not None:
        raise UserError("--table needs --results: a driver is judged by the table of its target")
    if resume and not record:
        raise UserError("--resume needs --record")
    complaints: list[str] = []
    if drivers:
        if names:
            raise UserError("--target and --driver exclude each other: a driver has its target")
        if record and part.of > 1:
            raise UserError("--record keeps the results of one machine; leave out --shard")
        wanted = [name for name in wanted if part.holds(name, "driver")]
        plan = Plan(library, wanted, record, resume)
        results, missing, complaints = check_drivers(plan, drivers, modes)
    elif modes or record:
        raise UserError("--mode and --record need --driver")
    else:
        backends, missing = open_backends(names)
        results = run_checks(library, wanted, backends, part)
        complaints = judge_known(results, backends)
    for sentence in missing:
        click.echo(f"skipped   {sentence}")
    for line in lines(results, is_detailed):
        click.echo(line)
    for sentence in complaints:
        click.echo(f"FAILED    {sentence}")
    write_results(results, missing, part, json_file, junit_file)
    return 0 if all(r.accepted for r in results) and not complaints else 1


def open_backends(names: tuple[str, ...]) -> tuple[list[Backend], list[str]]:
    """The backends asked for (all targets if none), and a sentence for each that is not here.

    Raises UserError for an unknown name, for a missing target that was asked for, and where none is left.
    """
    found, missing = [], []
    for name in names or TARGETS:
        if name not in CHECKABLE:
            raise unknown("target", name, CHECKABLE)
        try:
            found.append(backend(name))
        except TargetUnavailable as e:
            if names:
                raise UserError(f"target {name} is not available: {e}") from None
            missing.append(f"{name}: {e}")
    if not found:
        raise UserError(f"no driver to check on; {'; '.join(missing)}; see vair doctor")
    return found, missing


def run_checks(
    library: Library, functions: list[str], backends: list[Backend], part: Shard
) -> list[FunctionResult]:
    """The shard's functions on all backends, with progress on a terminal; backend after backend."""
    pairs = {name: [on for on in backends if part.holds(name, on.target)] for name in functions}
    names = [name for name, on in pairs.items() if on]
    tables = list(dict.fromkeys(on.judged_by for on in backends))
    results: dict[str, list[FunctionResult]] = {on.target: [] for on in backends}
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not sys.stderr.isatty()) as progress:
        task = progress.add_task("checking", total=len(names))
        for name, prepared in prepared_ahead(library, names, tables):
            progress.update(task, description=name)
            for on in pairs[name]:
                results[on.target].append(check_function(library, name, on, prepared=prepared))
            progress.advance(task)
    return [r for found in results.values() for r in found]


def judge_known(results: list[FunctionResult], backends: list[Backend]) -> list[str]:
    """Mark the failures that are known of these devices; sentences where an entry no longer fits."""
    runs = [
        known.Judged(name, DEFAULT, [r for r in results if r.target == on.target])
        for on in backends
        if (name := known.name_of(on.device))
    ]
    return known.judge(runs, known.read(), date.today()).complaints


def write_results(
    results: list[FunctionResult],
    missing: list[str],
    part: Shard,
    json_file: Path | None,
    junit_file: Path | None,
) -> None:
    """Write the files that were asked for."""
    if json_file is not None:
        write_text(json_file, as_json(results, missing, part))
    if junit_file is not None:
        write_bytes(junit_file, junit_bytes(results, missing))


def as_json(results: list[FunctionResult], missing: list[str], part: Shard) -> str:
    """The machine-readable result."""
    data = {
        "version": VERSION,
        "source": load_library().select().source_hash,
        "shard": str(part),
        "skipped": missing,
        "results": [r.as_data() for r in results],
    }
    return json.dumps(data, indent=1) + "\n"


def run_merge(files: tuple[Path, ...], asked: bool, json_file: Path | None, junit_file: Path | None) -> int:
    """Join results, report them as one, and give the exit status of the whole."""
    if not asked:
        raise UserError(f"vair check takes no files without --merge: {files[0]}")
    if not files:
        raise UserError("--merge needs the files that vair check --json wrote")
    merged = join_results(files)
    for line in lines(merged.results, details=False):
        click.echo(line)
    for shard in merged.missing:
        click.echo(f"MISSING   shard {shard}")
    write_results(merged.results, merged.skipped, Shard(), json_file, junit_file)
    return 0 if merged.passed else 1


def run_replay(library: Library, text: str) -> int:
    """Run recorded cases again, and print what came out and what was expected."""
    status = 0
    for case in cases_of(library, text):
        for remark in case.remarks:
            click.echo(remark)
        if "+" in case.target:
            status |= show_replay(replay_on_driver(library, case.identity, case.words))
            continue
        if case.target not in CHECKABLE:
            raise unknown("target", case.target, CHECKABLE)
        (on,), _ = open_backends((case.target,))
        status |= show_replay(check_function(library, case.function, on, [case.draw()]))
    return status


def show_replay(result: FunctionResult) -> int:
    """Print one replayed lane; returns the exit status."""
    for failure in result.failures:
        click.echo("\n".join(failure.lines()[:-1]))
    if not result.failures:
        click.echo(f"{result.function} on {result.driver}" + (f": {result.broken}" if result.broken else ""))
        for line in verdict_lines(result) if not result.broken else ():
            click.echo(f"  {line}")
    click.echo("passed" if result.passed else "failed")
    return 0 if result.passed else 1
