"""`vair check`: conformance on this machine's drivers."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.progress import Progress

from codegen.backends import TARGETS
from codegen.errors import UserError, unknown
from codegen.files import write_bytes, write_text
from codegen.library import VERSION, Library, load_library
from conformance.check.engine import Backend, Draw, backend, check_function, draw
from conformance.check.identity import Identity
from conformance.check.junit import junit_bytes
from conformance.check.result import FunctionResult
from targets import TargetUnavailable

CHECKABLE = (*TARGETS, "numpy")


@click.command("check")
@click.option("--target", "names", multiple=True, help="glsl, wgsl, opencl, or numpy (the evaluator); repeatable.")
@click.option("--function", "functions", multiple=True, help="Check this function only; repeatable.")
@click.option("--json", "json_file", type=click.Path(path_type=Path), help="Write the results as JSON.")
@click.option("--junit", "junit_file", type=click.Path(path_type=Path), help="Write the results as JUnit XML.")
@click.option("--replay", help="Run one case again: the identity that a failure printed.")
def command(
    names: tuple[str, ...],
    functions: tuple[str, ...],
    json_file: Path | None,
    junit_file: Path | None,
    replay: str | None,
) -> int:
    """Check every function on every driver of this machine against references and declared bounds."""
    library = load_library()
    if replay is not None:
        return run_replay(library, Identity.parse(replay))
    wanted = [library.function(name).name for name in functions] or list(library.public)
    backends, missing = open_backends(names)
    for sentence in missing:
        click.echo(f"skipped   {sentence}")
    results = run_checks(library, wanted, backends)
    report(results, len(wanted), backends)
    if json_file is not None:
        write_text(json_file, as_json(results, missing))
    if junit_file is not None:
        write_bytes(junit_file, junit_bytes(results, missing))
    return 0 if all(r.passed for r in results) else 1


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


def report(results: list[FunctionResult], functions: int, backends: list[Backend]) -> None:
    """Failures in full, then one line per backend."""
    for r in results:
        if r.broken:
            click.echo(f"FAILED    {r.function} on {r.target}: {r.broken}")
        for failure in r.failures:
            click.echo("FAILED    " + "\n          ".join(failure.lines()))
    for on in backends:
        own = [r for r in results if r.target == on.target]
        passed = sum(r.passed for r in own)
        lanes = sum(r.lanes for r in own)
        bad = sum(r.non_finite for r in own)
        click.echo(
            f"{on.target:<9} {passed} of {functions} functions within their bounds, {lanes} inputs, "
            f"{bad} non-finite results, {sum(r.seconds for r in own):.1f} s  ({on.driver})"
        )


def as_json(results: list[FunctionResult], missing: list[str]) -> str:
    """The machine-readable result."""
    data = {"version": VERSION, "skipped": missing, "results": [r.as_data() for r in results]}
    return json.dumps(data, indent=1) + "\n"


def run_replay(library: Library, identity: Identity) -> int:
    """Draw one input again, run it, and print what came out and what was expected."""
    if identity.target not in CHECKABLE:
        raise unknown("target", identity.target, CHECKABLE)
    function = library.function(identity.function)
    (on,), _ = open_backends((identity.target,))
    whole = draw(function, identity.family, identity.count, identity.seed)
    result = check_function(library, function.name, on, [only_lane(whole, identity.lane)])
    for failure in result.failures:
        click.echo("\n".join(failure.lines()[:-1]))
    for bound in result.bounds:
        if bound.lanes:
            click.echo(f"{function.name} on {on.driver}\n  inputs    {bound.worst}")
            click.echo(f"  bound     {bound.bound}\n  measured  {bound.measured:.6g}")
    click.echo("passed" if result.passed else "failed")
    return 0 if result.passed else 1


def only_lane(whole: Draw, lane: int) -> Draw:
    """The draw cut down to one lane."""

    def cut(value: Any) -> Any:
        if isinstance(value, dict):
            return {name: cut(v) for name, v in value.items()}
        return value[lane : lane + 1]

    return replace(whole, inputs=cut(whole.inputs))
