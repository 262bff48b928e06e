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
from conformance.check.engine import Backend, backend, check_function, draw, only_lane
from conformance.check.identity import Identity
from conformance.check.junit import junit_bytes
from conformance.check.result import FunctionResult
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
@click.option("--replay", "replayed", help="Run one case again: the identity that a failure printed.")
def command(
    names: tuple[str, ...],
    drivers: tuple[str, ...],
    modes: tuple[str, ...],
    record: bool,
    functions: tuple[str, ...],
    json_file: Path | None,
    junit_file: Path | None,
    replayed: str | None,
) -> int:
    """Check every function on every driver of this machine against references and declared bounds."""
    library = load_library()
    if replayed is not None:
        return run_replay(library, Identity.parse(replayed))
    wanted = [library.function(name).name for name in functions] or list(library.public)
    complaints: list[str] = []
    if drivers:
        if names:
            raise UserError("--target and --driver exclude each other: a driver has its target")
        if record and functions:
            raise UserError("--record keeps the results of all functions; leave out --function")
        results, missing, complaints = check_drivers(library, wanted, drivers, modes, record)
    elif modes or record:
        raise UserError("--mode and --record need --driver")
    else:
        backends, missing = open_backends(names)
        results = run_checks(library, wanted, backends)
    for sentence in missing:
        click.echo(f"skipped   {sentence}")
    report(results, len(wanted))
    for sentence in complaints:
        click.echo(f"FAILED    {sentence}")
    if json_file is not None:
        write_text(json_file, as_json(results, missing))
    if junit_file is not None:
        write_bytes(junit_file, junit_bytes(results, missing))
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


def run_checks(library: Library, functions: list[str], backends: list[Backend]) -> list[FunctionResult]:
    """All functions on all backends, with progress on a terminal."""
    results = []
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not sys.stderr.isatty()) as progress:
        task = progress.add_task("checking", total=len(functions) * len(backends))
        for on in backends:
            for name in functions:
                progress.update(task, description=f"{on.target} {name}")
                results.append(check_function(library, name, on))
                progress.advance(task)
    return results


def report(results: list[FunctionResult], functions: int) -> None:
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
            f"{name.ljust(width)} {passed} of {functions} functions within their bounds, "
            f"{f'{known} known failures, ' if known else ''}{lanes} inputs, "
            f"{bad} non-finite results, {sum(r.seconds for r in own):.1f} s  ({own[0].driver})"
        )


def as_json(results: list[FunctionResult], missing: list[str]) -> str:
    """The machine-readable result."""
    data = {"version": VERSION, "skipped": missing, "results": [r.as_data() for r in results]}
    return json.dumps(data, indent=1) + "\n"


def run_replay(library: Library, identity: Identity) -> int:
    """Draw one input again, run it, and print what came out and what was expected."""
    if "+" in identity.target:
        return show_replay(replay_on_driver(library, identity))
    if identity.target not in CHECKABLE:
        raise unknown("target", identity.target, CHECKABLE)
    function = library.function(identity.function)
    (on,), _ = open_backends((identity.target,))
    whole = draw(function, identity.family, identity.count, identity.seed)
    result = check_function(library, function.name, on, [only_lane(whole, identity.lane)])
    return show_replay(result)


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
