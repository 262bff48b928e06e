"""Random programs from the command line.

python -m conformance.fuzz                        1000 programs on every target that is here
python -m conformance.fuzz --seed 1 --case 17     that program alone, with its reduction if it fails
python -m conformance.fuzz --count 100000 --workers 2
                                                  as many as that, on processes that may die
python -m conformance.fuzz --record --count 5000  programs that follow those in results.json, kept there
python -m conformance.fuzz --again                the findings in results.json; notes which are mended
python -m conformance.fuzz --refusals             damaged sources instead
"""

from __future__ import annotations

import sys
import time
from datetime import date
from pathlib import Path

import click

from conformance.executor import open_executor
from conformance.fuzz import record
from conformance.fuzz.engine import Tally, run_cases
from conformance.fuzz.refusals import MUTANTS, Refusals, read_damaged
from conformance.fuzz.report import explain
from conformance.fuzz.task import pieces, run_jobs
from targets import TARGETS, Runtime, TargetUnavailable, open_runtime


@click.command()
@click.option("--seed", default=1, show_default=True, help="Seed of the programs.")
@click.option("--case", "number", type=int, help="Run this program alone.")
@click.option("--first", default=0, show_default=True, help="Number of the first program.")
@click.option("--count", default=1000, show_default=True, help="How many programs.")
@click.option("--target", "names", multiple=True, type=click.Choice(TARGETS), help="Targets; all by default.")
@click.option("--refusals", is_flag=True, help="Damage the sources; each must be read or refused in words.")
@click.option(
    "--record", "keep", is_flag=True, help="Go on after what results.json holds, and keep it there."
)
@click.option("--again", is_flag=True, help="Run the findings of results.json again, and note the mended.")
@click.option(
    "--results",
    type=click.Path(path_type=Path),
    default=record.RESULTS,
    help="With --record and --again: the file.",
)
@click.option("--workers", default=1, show_default=True, help="Processes of this machine.")
@click.option("--scheduler", help="Use the workers of a Dask scheduler: tcp://host:8786.")
def main(
    seed: int,
    number: int | None,
    first: int,
    count: int,
    names: tuple[str, ...],
    refusals: bool,
    keep: bool,
    again: bool,
    results: Path,
    workers: int,
    scheduler: str | None,
) -> None:
    """Make random programs, run them on every target, judge the results by interval."""
    if keep and (refusals or first or number is not None):
        raise click.UsageError("--record goes on by itself: it takes no --case, --first or --refusals")
    if again and (keep or refusals or first or number is not None):
        raise click.UsageError(
            "--again runs what was recorded: it takes no --case, --first, --record or --refusals"
        )
    if again:
        sys.exit(run_again(results))
    numbers = range(first, first + count) if number is None else range(number, number + 1)
    started = time.monotonic()
    if refusals:
        read = Refusals()
        for n in numbers:
            read_damaged(seed, n, MUTANTS, read)
        print("\n".join([*read.lines(), *(f"{n}/{k}: {what}\n{text}" for n, k, what, text in read.crashes)]))
        sys.exit(bool(read.crashes))
    runtimes = open_targets(names or TARGETS)
    targets = [r.device.target for r in runtimes]
    if keep:
        first = record.following(record.read(results), seed, targets)
        numbers = range(first, first + count)
    tally = Tally()
    if workers > 1 or scheduler:
        jobs = pieces(seed, numbers.start, len(numbers), targets)
        tally = run_jobs(open_executor(workers, scheduler), jobs)
    else:
        run_cases(numbers, seed, runtimes, tally)
    if keep:
        new = record.entry(tally, seed, first, targets, date.today())
        record.write(record.added(record.read(results), new), results)
    for finding in tally.findings:
        print(explain(finding, runtimes))
    print("\n".join(tally.lines()))
    print(f"{time.monotonic() - started:.0f} s")
    sys.exit(bool(tally.findings))


def run_again(results: Path) -> bool:
    """Run the findings of a file once more; keep there what is mended. Whether any finding is left."""
    opened: dict[str, Runtime] = {}

    def run(seed: int, number: int, targets: list[str]) -> Tally:
        opened.update(
            {r.device.target: r for r in open_targets(tuple(t for t in targets if t not in opened))}
        )
        if missing := [t for t in targets if t not in opened]:
            raise click.UsageError(f"case {number} was run on {missing[0]}, which is not here")
        tally = Tally()
        run_cases(range(number, number + 1), seed, [opened[t] for t in targets], tally)
        return tally

    before = record.read(results)
    after = record.checked_again(before, run)
    record.write(after, results)
    mended = sum(len(new["mended"]) - len(old["mended"]) for old, new in zip(before, after, strict=True))
    left = [finding for entry in after for finding in entry["findings"]]
    print("\n".join([*left, f"{mended} mended, {len(left)} left"]))
    return bool(left)


def open_targets(names: tuple[str, ...]) -> list[Runtime]:
    """The runtimes of these targets; those that are not here are named and left out."""
    runtimes: list[Runtime] = []
    for name in names:
        try:
            runtimes.append(open_runtime(name))
        except TargetUnavailable as reason:
            print(f"{name} is left out: {reason}")
    return runtimes


if __name__ == "__main__":
    main()
