"""python -m conformance.mutation: run mutants, print survivors, record draws, write README.md."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from conformance.mutation import record, report
from conformance.mutation.plan import groups
from conformance.mutation.run import SEED, BaselineError, Result, all_jobs, run, sampled, tally


def main() -> int:
    """Exit status 1 where a group misses its share, 2 where the tests fail without a mutant."""
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
    parser.add_argument("--json", type=Path, help="write every outcome to this file")
    given = parser.parse_args()
    unknown = [name for name in given.groups if name not in groups()]
    if unknown:
        parser.error(f"no group {', '.join(unknown)}")
    found: dict[str, list[Result]] = {}
    missed = False
    for name in given.groups or groups():
        group = groups()[name]
        jobs = sampled(group, given.count or group.sample, given.seed) if given.sampled else all_jobs(group)
        jobs = [job for job in jobs if given.file in job[0].path]

        def told(result: Result) -> None:
            if result.outcome == "survived":
                print(f"survived  {result.mutant}", flush=True)

        try:
            found[name] = run(group, jobs, given.workers, told)
        except BaselineError as e:
            print(f"{name}: {e}", file=sys.stderr)
            return 2
        t = tally(found[name])
        share = group.sampled_share if given.sampled else group.share
        missed |= t.share < share
        print(
            f"{name}: {t.killed} killed, {t.survived} survived, {t.equivalent} equivalent, "
            f"{t.refused} refused; {t.share:.1%} of {share:.0%}",
            flush=True,
        )
    if given.json:
        rows = [
            {
                "group": name,
                "mutant": str(r.mutant),
                "key": r.mutant.key,
                "outcome": r.outcome,
                "s": r.seconds,
            }
            for name, results in found.items()
            for r in results
        ]
        given.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")
    if given.record and not given.file:
        for name, results in found.items():
            seed = given.seed if given.sampled else None
            record.add(name, record.draw_of(results, seed, len(all_jobs(groups()[name]))))
        report.write()
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
