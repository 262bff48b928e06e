"""`vair check`: conformance on this machine's drivers."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click
from rich.console import Console
from rich.progress import Progress

from codegen.backends import TARGETS
from codegen.errors import UserError, unknown
from codegen.files import write_bytes, write_text
from codegen.library import VERSION, Library, load_library
from conformance.check.engine import Backend, backend, check_function
from conformance.check.junit import junit_bytes
from conformance.check.merge import merge as join_results
from conformance.check.replay import cases_of
from conformance.check.result import FunctionResult
from conformance.check.shard import Shard
from conformance.commands.check_drivers import check_drivers, replay_on_driver
from targets import TargetUnavailable

CHECKABLE = (*TARGETS, "numpy")


@click.command("check")
@click.option(
    "--target", "names", multiple=True, help="glsl, wgsl, opencl, or numpy (the evaluator); repeatable."
)
@click.option(
    "--driver", "drivers", multiple=True, help="A driver of vair doctor by name, or all; repeatable."
)
@click.option("--mode", "modes", multiple=True, help="With --driver: a mode by name, or all; repeatable.")
@click.option("--record", is_flag=True, help="With --driver: keep the results under conformance/results.")
@click.option("--function", "functions", multiple=True, help="Check this function only; repeatable.")
@click.option("--json", "json_file", type=click.Path(path_type=Path), help="Write the results as JSON.")
@click.option(
    "--junit", "junit_file", type=click.Path(path_type=Path), help="Write the results as JUnit XML."
)
@click.option("--replay", "replayed", help="Run cases again: a printed identity, or a file of --json.")
@click.option("--shard", default="1/1", help="Check a fixed share of the functions and targets only: 2/3.")
@click.option("--merge", is_flag=True, help="Join the results in FILES instead of checking.")
@click.argument("files", nargs=-1, type=click.Path(path_type=Path))
def command(
    names: tuple[str, ...],
    drivers: tuple[str, ...],
    modes: tuple[str, ...],
    record: bool,
    functions: tuple[str, ...],
    json_file: Path | None,
    junit_file: Path | None,
    replayed: str | None,
    shard: str,
    merge: bool,
    files: tuple[Path, ...],
) -> int:
    """Check every function on every driver of this machine against references and declared bounds."""
    library = load_library()
    part = Shard.parse(shard)
    if merge or files:
        return run_merge(files, merge, json_file, junit_file)
    if replayed is not None:
        return run_replay(library, replayed)
    wanted = [library.function(name).name for name in functions] or list(library.public)
    complaints: list[str] = []
    if drivers:
        if names:
            raise UserError("--target and --driver exclude each other: a driver has its target")
        if record and part.of > 1:
            raise UserError("--record keeps the results of one machine; leave out --shard")
        wanted = [name for name in wanted if part.holds(name, "driver")]
        results, missing, complaints = check_drivers(library, wanted, drivers, modes, record)
    elif modes or record:
        raise UserError("--mode and --record need --driver")
    else:
        backends, missing = open_backends(names)
        results = run_checks(library, wanted, backends, part)
    for sentence in missing:
        click.echo(f"skipped   {sentence}")
    report(results)
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
    """The shard's functions on all backends, with progress on a terminal."""
    pairs = [(on, name) for on in backends for name in functions if part.holds(name, on.target)]
    results = []
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not sys.stderr.isatty()) as progress:
        task = progress.add_task("checking", total=len(pairs))
        for on, name in pairs:
            progress.update(task, description=f"{on.target} {name}")
            results.append(check_function(library, name, on))
            progress.advance(task)
    return results


def report(results: list[FunctionResult]) -> None:
    """Failures in full, then one line per backend."""
    for r in results:
        if r.known:
            click.echo(f"known     {r.function} on {r.backend}: {r.known}")
            continue
        if r.broken:
            click.echo(f"FAILED    {r.function} on {r.backend}: {r.broken}")
        for failure in r.failures:
            click.echo("FAILED    " + "\n          ".join(failure.lines()))
    width = max((len(r.backend) for r in results), default=9)
    for name in dict.fromkeys(r.backend for r in results):
        own = [r for r in results if r.backend == name]
        passed = sum(r.passed for r in own)
        known = sum(bool(r.known) for r in own)
        lanes = sum(r.lanes for r in own)
        bad = sum(r.non_finite for r in own)
        click.echo(
            f"{name.ljust(width)} {passed} of {len(own)} functions within their bounds, "
            f"{f'{known} known failures, ' if known else ''}{lanes} inputs, "
            f"{bad} non-finite results, {sum(r.seconds for r in own):.1f} s  ({own[0].driver})"
        )


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
    report(merged.results)
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
        if case.identity is not None and "+" in case.target:
            status |= show_replay(replay_on_driver(library, case.identity))
            continue
        if case.target not in CHECKABLE:
            raise unknown("target", case.target, CHECKABLE)
        (on,), _ = open_backends((case.target,))
        status |= show_replay(check_function(library, case.function, on, [case.draw()]))
    return status


def show_replay(result: FunctionResult) -> int:
    """Print one replayed lane; returns the exit status."""
    if result.broken:
        click.echo(f"{result.function} on {result.driver}: {result.broken}")
    for failure in result.failures:
        click.echo("\n".join(failure.lines()[:-1]))
    for bound in result.bounds:
        if bound.lanes:
            click.echo(f"{result.function} on {result.driver}\n  inputs    {bound.worst}")
            click.echo(f"  bound     {bound.bound}\n  measured  {bound.measured:.6g}")
    click.echo("passed" if result.passed else "failed")
    return 0 if result.passed else 1
