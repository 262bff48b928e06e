"""`python -m conformance.sweep`: every number in the domain of every function of one argument."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import click
import numpy as np
from rich.console import Console
from rich.progress import Progress

from codegen.backends import TARGETS
from codegen.errors import UserError, unknown
from codegen.library import load_library
from conformance.command_line import run
from conformance.executor import Job, Result, available, open_executor
from conformance.executor.state import State
from conformance.sweep.plan import pieces, short
from conformance.sweep.positions import Positions, order_of, sweepable
from conformance.sweep.record import RESULTS, Entry, keep, passed
from conformance.sweep.sweep import sweep

STATE = Path("build/sweep/state.jsonl")


@click.command()
@click.option("--function", "names", multiple=True, help="Only this function; repeatable.")
@click.option("--target", "targets", multiple=True, help="Only this target; repeatable.")
@click.option("--stride", default=1, show_default=True, help="Every n-th number only.")
@click.option("--range", "words", help="Only from one 32-bit word in hex to another: 3f000000:3f800000.")
@click.option("--short", "only_short", is_flag=True, help="2^24 numbers around the critical ones.")
@click.option("--workers", default=2, show_default=True, help="Processes of this machine.")
@click.option("--scheduler", help="Use the workers of a Dask scheduler: tcp://host:8786.")
@click.option("--state", type=click.Path(path_type=Path), default=STATE, show_default=True)
@click.option("--fresh", is_flag=True, help="Forget what was done before.")
@click.option(
    "--record/--no-record", default=True, help="Keep what was found under conformance/sweep/results."
)
def main(
    names: tuple[str, ...],
    targets: tuple[str, ...],
    stride: int,
    words: str | None,
    only_short: bool,
    workers: int,
    scheduler: str | None,
    state: Path,
    fresh: bool,
    record: bool,
) -> None:
    """Sweep and say what was found; exit status 1 where a bound is missed, 2 for bad usage."""
    library = load_library()
    swept = sweepable(library)
    for name in names:
        if name not in swept:
            raise unknown("function of one number", name, swept)
    swept = {name: swept[name] for name in names or swept}
    jobs: dict[str, list[Job]] = {name: [] for name in swept}
    for target in targets or TARGETS:
        reason = "" if scheduler else available(target)
        if reason:
            click.echo(f"skipped   {target}: {reason}")
        elif only_short:
            for job in short(library, swept, target):
                jobs[job.function].append(job)
        else:
            for name, where in swept.items():
                start, stop = places(where, words)
                jobs[name] += pieces(name, target, where, start, stop, stride)
    if fresh:
        state.unlink(missing_ok=True)
    numbers, well, started = 0, True, time.perf_counter()
    executor, done_before = open_executor(workers, scheduler), State(state)
    with Progress(console=Console(stderr=True), transient=True, disable=not sys.stderr.isatty()) as bar:
        task = bar.add_task("sweeping", total=sum(map(len, jobs.values())))

        def advance(result: Result) -> None:
            bar.update(task, description=f"{result.job.target} {result.job.function}", advance=1)

        # One function after the other, so that what is found is told and kept even if the sweep is stopped.
        for asked in jobs.values():
            entries, failed = sweep(
                library, swept, asked, executor, done_before, advance, together=scheduler is None
            )
            for entry in entries:
                click.echo(told(entry))
            for job, reason in failed.items():
                click.echo(f"FAILED    {job.identity}: {reason}")
            if record and entries and not only_short and words is None:
                for path in keep(entries, RESULTS):
                    click.echo(f"recorded  {path}")
            numbers += sum(entry["numbers"] for entry in entries)
            well &= not failed and all(map(passed, entries))
    click.echo(f"{numbers} numbers, {time.perf_counter() - started:.0f} s")
    raise SystemExit(0 if well else 1)


def places(where: Positions, words: str | None) -> tuple[int, int]:
    """First and last place + 1 of a range of words; the whole domain without one."""
    if words is None:
        return 0, where.count
    try:
        low, high = (int(word, 16) for word in words.split(":"))
        ends = [order_of_word(word) if where.floats else word for word in (low, high)]
    except ValueError:
        raise UserError(f'"{words}" is no range of words; write 3f000000:3f800000') from None
    start, stop = (min(max(end, where.first), where.last) - where.first for end in sorted(ends))
    return start, stop + 1


def order_of_word(word: int) -> int:
    """A word's number in the order of all floats."""
    return order_of(float(np.uint32(word).view(np.float32)))


def told(entry: Entry) -> str:
    """One function on one target in a few lines."""
    verdict = "passed   " if passed(entry) else "FAILED   "
    share = "all" if entry["kind"] == "bound" else f"{entry['numbers']} of {entry['of']}"
    lines = [f"{verdict} {entry['function']} on {entry['target']}: {share} numbers, {entry['kind']}s"]
    if entry["non_finite"]:
        lines.append(f"          {entry['non_finite']} results are not finite: {entry['not_finite']}")
    for b in entry["bounds"]:
        missed = f"; {b['failures']} miss it: {' '.join(b['failed'])}" if b["failures"] else ""
        lines.append(f"          {b['measured']:.4g} at {b['worst']} ({b['bound']}){missed}")
    return "\n".join(lines)


if __name__ == "__main__":
    run(main)
