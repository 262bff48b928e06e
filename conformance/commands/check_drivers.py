"""`vair check --driver`: conformance on drivers by name, each in processes of its own."""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from datetime import date
from pathlib import Path

import click
from rich.console import Console
from rich.progress import Progress

from codegen.errors import UserError, unknown
from codegen.library import Library
from conformance.check.identity import Identity
from conformance.check.result import FunctionResult
from conformance.drivers import known
from conformance.drivers.modes import Mode, mode, modes_of
from conformance.drivers.record import FOLDER, Recorder
from conformance.drivers.run import end_all, run_driver
from targets import Device, TargetUnavailable
from targets.drivers import catalogue, present

ALL = "all"
DRIVERS_AT_ONCE = 2
"""Drivers that run side by side; the modes of one driver follow each other."""


@dataclass
class Plan:
    """What is to be checked, and what becomes of the results.

    keep    whether to record the results
    resume  whether to leave out what is recorded already, see Recorder.current
    """

    library: Library
    functions: Sequence[str]
    keep: bool = False
    resume: bool = False
    folder: Path = FOLDER
    today: date = field(default_factory=date.today)


def check_drivers(
    plan: Plan, names: tuple[str, ...], mode_names: tuple[str, ...]
) -> tuple[list[FunctionResult], list[str], list[str]]:
    """All functions on the drivers, in the modes that each of them has.

    names       of drivers; "all" stands for every one that is here
    mode_names  the default mode if none; "all" for every one
    returns     results with known failures marked, a sentence per missing driver, and what known failures
                no longer describe
    raises      UserError for an unknown name, a driver that was asked for and is not here, or none at all
    """
    for name in mode_names:
        if name != ALL:
            mode(name)
    entries = known.read()
    drivers, missing = find_drivers(names)
    chosen = {name: modes_of(catalogue()[name], mode_names) for name in drivers}
    if not any(chosen.values()):
        raise UserError(f"none of these drivers has the mode {', '.join(mode_names)}")
    console = Console(stderr=True)
    with (
        tempfile.TemporaryDirectory(prefix="vair-check-") as folder,
        Progress(console=console, transient=True, disable=not sys.stderr.isatty()) as progress,
        ThreadPoolExecutor(DRIVERS_AT_ONCE) as threads,
    ):
        cache = Path(folder) if sum(map(len, chosen.values())) > 1 else None

        def one(name: str) -> list[tuple[list[FunctionResult], list[str]]]:
            return [
                run_mode(plan, entries, name, drivers[name], how, cache, progress) for how in chosen[name]
            ]

        try:
            runs = [run for part in threads.map(one, drivers) for run in part]
        except BaseException:
            end_all()
            raise
    results = [r for found, _ in runs for r in found]
    complaints = list(dict.fromkeys(sentence for _, told in runs for sentence in told))
    return results, missing, complaints


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


def run_mode(
    plan: Plan,
    entries: Sequence[known.KnownFailure],
    name: str,
    device: Device,
    how: Mode,
    cache: Path | None,
    progress: Progress,
) -> tuple[list[FunctionResult], list[str]]:
    """One driver in one mode: its results, and what known failures no longer describe.

    cache  a folder that several runs share; None for a single one
    """
    chosen = catalogue()[name]
    recorder = Recorder(plan.library, chosen, device, how, plan.today, plan.folder)
    done = set(recorder.current(plan.functions)) if plan.resume else set()
    wanted = [f for f in plan.functions if f not in done]
    full_name = f"{name} {chosen.version_of(device)}".strip()
    complaints: list[str] = []
    task = progress.add_task(f"{name} ({how.name})", total=len(wanted))

    def told(result: FunctionResult) -> None:
        judged = known.Judged(full_name, how.name, [result])
        complaints.extend(known.judge([judged], entries, plan.today).complaints)
        if plan.keep:
            recorder.add(result)
        progress.advance(task)

    started = time.monotonic()
    run = run_driver(chosen, device, how, wanted, told, cache=cache)
    if plan.keep and wanted:
        recorder.write()
    left_out = f", {len(done)} recorded before" if done else ""
    seconds = time.monotonic() - started
    click.echo(
        f"ran       {name} ({how.name}): {len(wanted)} functions in {seconds:.0f} s{left_out}", err=True
    )
    return list(run.results), complaints


def replay_on_driver(library: Library, identity: Identity, words: str = "") -> FunctionResult:
    """One lane again, on the driver and in the mode that its identity names.

    words  the input itself, where a record brings it
    """
    name, _, mode_name = identity.target.partition("+")
    how = mode(mode_name)
    function = library.function(identity.function).name
    devices, _ = find_drivers((name,))
    if not how.fits(catalogue()[name]):
        raise UserError(f"the driver {name} has no mode {mode_name}")
    run = run_driver(catalogue()[name], devices[name], how, [function], replay=identity, words=words)
    return run.results[0]
