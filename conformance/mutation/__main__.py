"""python -m conformance.mutation: run mutants, print survivors, record draws, write README.md."""

from __future__ import annotations

import argparse
import dataclasses
import json
import sys
import time
from math import inf
from pathlib import Path
from typing import Any

from conformance.mutation import record, report
from conformance.mutation.isolated import SURVIVED
from conformance.mutation.plan import excuse, groups
from conformance.mutation.run import SEED, BaselineError, Result, all_jobs, run, sampled, tally
from conformance.mutation.sites import Mutant

BETWEEN_WRITES = 5.0
"""Seconds of work that an interrupted run loses at most."""


class Kept:
    """Outcomes in a file, so that what takes long can be done in pieces."""

    def __init__(self, path: Path | None, resume: bool, again: bool) -> None:
        self.path = path
        self.rows: list[dict[str, Any]] = []
        self.written = time.monotonic()
        if path is not None and resume and path.exists():
            rows = json.loads(path.read_text(encoding="utf-8"))
            self.rows = [row for row in rows if not (again and row["outcome"] == SURVIVED)]
        self.found = {
            (r["group"], str(m)): Result(m, r["outcome"], r["s"])
            for r in self.rows
            for m in [Mutant(**r["mutant"])]
        }

    def add(self, group: str, result: Result) -> None:
        """Keep one more."""
        mutant = dataclasses.asdict(result.mutant)
        self.rows.append({"group": group, "mutant": mutant, "outcome": result.outcome, "s": result.seconds})
        if time.monotonic() - self.written > BETWEEN_WRITES:
            self.write()

    def write(self) -> None:
        """All that is there."""
        self.written = time.monotonic()
        if self.path is not None:
            self.path.write_text(json.dumps(self.rows, indent=1), encoding="utf-8")


def main() -> int:
    """Exit status 1 where a group misses its share, 2 where the tests fail unmutated, 3 where time is up."""
    parser = argparse.ArgumentParser(prog="python -m conformance.mutation", description=__doc__)
    parser.add_argument(
        "groups", nargs="*", metavar="GROUP", help=f"of {', '.join(groups())}; all by default"
    )
    parser.add_argument("--sampled", action="store_true", help="a fixed sample of each group")
    parser.add_argument("--count", type=int, help="size of the sample")
    parser.add_argument("--seed", type=int, default=SEED, help="seed of the sample")
    parser.add_argument("--file", default="", help="only mutants of files whose path holds this")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--record", action="store_true", help="keep the draw in results.json and README.md")
    parser.add_argument("--json", type=Path, help="write every outcome to this file, as it comes")
    parser.add_argument("--seconds", type=float, default=inf, help="begin no mutant after this time")
    parser.add_argument(
        "--effort",
        type=float,
        default=inf,
        metavar="SECONDS",
        help="try only the quickest tests that call what is changed, so many seconds of them",
    )
    parser.add_argument("--resume", action="store_true", help="go on with the outcomes of --json")
    parser.add_argument("--again", action="store_true", help="with --resume: try survivors of --json anew")
    given = parser.parse_args()
    unknown = [name for name in given.groups if name not in groups()]
    if unknown:
        parser.error(f"no group {', '.join(unknown)}")
    if given.resume and not given.json:
        parser.error("--resume goes on with a file: --json FILE")
    if given.record and given.effort < inf:
        parser.error("--record keeps what all tests say; --effort leaves some out")
    ends = time.monotonic() + given.seconds
    kept = Kept(given.json, given.resume, given.again)
    found: dict[str, list[Result]] = {}
    missed = unfinished = False
    for name in given.groups or groups():
        group = groups()[name]
        jobs = sampled(group, given.count or group.sample, given.seed) if given.sampled else all_jobs(group)
        jobs = [job for job in jobs if given.file in job[0].path]
        done = [job for job in jobs if (name, str(job[1])) in kept.found and not excuse(job[1])]
        results = [kept.found[name, str(mutant)] for _, mutant in done]
        waiting = [job for job in jobs if job not in done]

        def told(result: Result, name: str = name) -> None:
            kept.add(name, result)
            if result.outcome == SURVIVED:
                print(f"survived  {result.mutant}", flush=True)

        try:
            results += run(group, waiting, given.workers, told, given.effort, ends)
        except BaselineError as e:
            print(f"{name}: {e}", file=sys.stderr)
            return 2
        finally:
            kept.write()
        found[name] = results
        t = tally(results)
        share = group.sampled_share if given.sampled else group.share
        missed |= t.share < share
        unfinished |= len(results) < len(jobs)
        print(
            f"{name}: {len(results)} of {len(jobs)} tried: {t.killed} killed, {t.survived} survived, "
            f"{t.equivalent} equivalent, {t.refused} refused; {t.share:.1%} of {share:.0%}",
            flush=True,
        )
    if unfinished:
        print("time is up; the same command with --resume goes on")
        return 3
    if given.record and not given.file:
        for name, results in found.items():
            seed = given.seed if given.sampled else None
            record.add(name, record.draw_of(results, seed, len(all_jobs(groups()[name]))))
        report.write()
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
