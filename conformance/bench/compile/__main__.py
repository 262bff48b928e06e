"""`python -m conformance.bench.compile`: what compiling an include with glslang costs.

The functions with the longest includes are measured in every shell, forwards and backwards in rounds; so
is the whole library.
--record keeps the result and the table of README.md.
"""

from __future__ import annotations

import datetime
import os
import sys

import click

from codegen.library import load_library
from conformance.bench.compile import record
from conformance.bench.compile.shells import SHELLS
from conformance.bench.compile.times import longest, measured, whole_library
from conformance.bench.record import machine_data
from targets.glsl.validate import MISSING_VALIDATOR
from targets.packages import find_tool

LEAST_ROUNDS = 5


@click.command()
@click.option(
    "--function", "functions", multiple=True, help="Measure these instead of those with the longest includes."
)
@click.option("--longest", "count", default=3, show_default=True, help="So many functions.")
@click.option("--rounds", type=click.IntRange(LEAST_ROUNDS), default=LEAST_ROUNDS, show_default=True)
@click.option("--record", "keep", is_flag=True, help="Keep the result and the table of README.md.")
def main(functions: tuple[str, ...], count: int, rounds: int, keep: bool) -> None:
    """Milliseconds of processor time: shader, empty shader, their difference, one more in the process."""
    glslang = find_tool("glslangValidator", "glslang")
    if glslang is None:
        sys.exit(MISSING_VALIDATOR)
    library = load_library()
    names = list(functions) or longest(library, sorted(library.documented))[:count]
    found, everything = {}, {}
    for shell in SHELLS:
        everything[shell] = whole_library(library, glslang, shell, rounds)
        print(f"{shell.name}: all functions {everything[shell].median:.0f} ms", flush=True)
        found[shell] = measured(library, glslang, shell, names, rounds)
        for t in found[shell]:
            more = "" if t.more is None else f", one more {t.more:.0f}"
            whole, above = t.whole.median, t.above
            print(f"{shell.name}: {t.function} {whole:.0f} ms, {above:.0f} above empty{more}", flush=True)
    machine = machine_data()
    about = {
        "date": datetime.date.today().isoformat(),
        "method": (
            f"Processor time of glslangValidator, medians (and least) of {rounds} rounds; the {len(names)} "
            f"functions of {len(library.documented)} with the longest includes; {machine['cpu']}, load "
            f"average {os.getloadavg()[0]:.1f} at the end, {os.cpu_count()} processors; other programs "
            "lengthen processor times too"
        ),
    }
    if keep:
        record.keep(record.as_data(about, found, everything))


if __name__ == "__main__":
    main()
