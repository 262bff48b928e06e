"""Time and memory of emission, each time in a fresh process, and whether it repeats to the byte."""

from __future__ import annotations

import hashlib
import os
import statistics
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from codegen.backends import TARGETS
from codegen.library import Library, default_root
from conformance.bench.figures import Figure

ONE = "strand_specular"
"""The function whose emission alone is timed."""
WHOLE_SECONDS, ONE_SECONDS, MEGABYTES = 1.0, 0.3, 150.0
RSS_UNIT = 1 if sys.platform == "darwin" else 1024
"""Bytes in a unit of ru_maxrss."""


@dataclass(frozen=True)
class Run:
    """One process: seconds on the wall and of CPU, peak memory in MB, and a hash of what it wrote."""

    wall: float
    user: float
    megabytes: float
    digest: str


def emit(arguments: list[str], hash_seed: str = "random") -> Run:
    """Run `vair emit` with these arguments in a process of its own.

    errors  RuntimeError where it fails
    """
    command = [sys.executable, "-m", "codegen.cli", "emit", *arguments]
    environment = {**os.environ, "PYTHONHASHSEED": hash_seed}
    folder = default_root().parent
    environment["PYTHONPATH"] = os.pathsep.join(filter(None, (str(folder), os.environ.get("PYTHONPATH"))))
    with tempfile.TemporaryDirectory() as scratch:
        output = Path(scratch) / "emitted"
        begin = time.perf_counter()
        # wait4 gives the resources of this one child; subprocess has no such call.
        process = os.posix_spawn(command[0], [*command, "-o", str(output)], environment)
        _, status, used = os.wait4(process, 0)
        wall = time.perf_counter() - begin
        if status != 0:
            raise RuntimeError(f"vair emit {' '.join(arguments)} failed with status {status}")
        digest = hashlib.sha256(output.read_bytes()).hexdigest()
    return Run(wall, used.ru_utime + used.ru_stime, used.ru_maxrss * RSS_UNIT / 1e6, digest)


def emission_figures(library: Library, runs: int) -> list[Figure]:
    """Times as medians of this many runs, the largest memory, and differences between two generations."""
    found: list[Figure] = []
    changed, peak = 0, 0.0
    for target in TARGETS:
        whole = [emit(["--target", target], hash_seed=str(k)) for k in range(max(runs, 2))]
        changed += len({run.digest for run in whole}) - 1
        peak = max([peak, *(run.megabytes for run in whole)])
        found += _times(
            "vair emit, whole library", f"{target}, {len(library.public)} functions", whole, WHOLE_SECONDS
        )
    for target in TARGETS:
        alone = [emit(["--target", target, "--function", ONE]) for _ in range(runs)]
        found += _times(f"vair emit --function {ONE}", target, alone, ONE_SECONDS)
    what = "differences between generations"
    domain = f"{max(runs, 2)} processes per target, different hash seeds"
    return [
        *found,
        Figure("vair emit, peak memory", "whole library, every target", "", MEGABYTES, peak, "MB"),
        Figure(what, domain, "", 0.0, float(changed), "files"),
    ]


def _times(what: str, domain: str, runs: list[Run], goal: float) -> list[Figure]:
    wall, user = (statistics.median(getattr(run, name) for run in runs) for name in ("wall", "user"))
    where = f"{domain}; median of {len(runs)} fresh processes"
    return [
        Figure(what, where, "", goal, wall, "s wall"),
        Figure(what, where, "", None, user, "s CPU"),
    ]
