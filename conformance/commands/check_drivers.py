"""`vair check --driver`: conformance on drivers by name, each in processes of its own."""

from __future__ import annotations

import sys
from datetime import date

from rich.console import Console
from rich.progress import Progress

from codegen.errors import UserError, unknown
from codegen.library import Library
from conformance.check.identity import Identity
from conformance.check.result import FunctionResult
from conformance.drivers import known, record
from conformance.drivers.modes import mode, modes_of
from conformance.drivers.run import DriverRun, run_driver
from targets import Device, TargetUnavailable
from targets.drivers import catalogue, present

ALL = "all"


def check_drivers(
    library: Library,
    functions: list[str],
    names: tuple[str, ...],
    mode_names: tuple[str, ...],
    keep: bool,
) -> tuple[list[FunctionResult], list[str], list[str]]:
    """All functions on the drivers, in the modes that each of them has.

    names       of drivers; "all" stands for every one that is here
    mode_names  the default mode if none; "all" for every one
    keep        whether to record the results
    returns     results with known failures marked, a sentence per missing driver, and what known failures
                no longer describe
    raises      UserError for an unknown name, a driver that was asked for and is not here, or none at all
    """
    for name in mode_names:
        if name != ALL:
            mode(name)
    entries = known.read()
    drivers, missing = find_drivers(names)
    runs = [
        run_mode(library, functions, name, device, mode_name)
        for name, device in drivers.items()
        for mode_name in (m.name for m in modes_of(catalogue()[name], mode_names))
    ]
    if not runs:
        raise UserError(f"none of these drivers has the mode {', '.join(mode_names)}")
    verdict = known.judge(runs, entries, date.today())
    if keep:
        record.keep(library, runs, date.today())
    return [r for run in runs for r in run.results], missing, verdict.complaints


def find_drivers(names: tuple[str, ...]) -> tuple[dict[str, Device], list[str]]:
    """The devices of the drivers asked for, and a sentence for each that is not here."""
    for name in names:
        if name not in (*catalogue(), ALL):
            raise unknown("driver", name, (*catalogue(), ALL))
    answers = present(() if ALL in names else names)
    missing = [f"{name}: {a}" for name, a in answers.items() if isinstance(a, TargetUnavailable)]
    found = {name: a for name, a in answers.items() if isinstance(a, Device)}
    if missing and ALL not in names:
        raise UserError(f"driver {missing[0]}")
    if not found:
        raise UserError("no driver to check on; see vair doctor")
    return found, missing


def run_mode(library: Library, functions: list[str], name: str, device: Device, mode_name: str) -> DriverRun:
    """One driver in one mode, with progress on a terminal."""
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not sys.stderr.isatty()) as progress:
        task = progress.add_task(f"{name} ({mode_name})", total=len(functions))
        return run_driver(
            catalogue()[name], device, mode(mode_name), functions, lambda result: progress.advance(task)
        )


def replay_on_driver(library: Library, identity: Identity) -> FunctionResult:
    """One lane again, on the driver and in the mode that its identity names."""
    name, _, mode_name = identity.target.partition("+")
    how = mode(mode_name)
    function = library.function(identity.function).name
    devices, _ = find_drivers((name,))
    if not how.fits(catalogue()[name]):
        raise UserError(f"the driver {name} has no mode {mode_name}")
    return run_driver(catalogue()[name], devices[name], how, [function], replay=identity).results[0]
