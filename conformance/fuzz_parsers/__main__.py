"""`python -m conformance.fuzz_parsers NAME --runs N`: fuzz one reader, guided by coverage (atheris).

A finding is printed with the bytes that make it again; --replay HEX runs these alone. Without atheris, or
with --blind, bytes are drawn from a seed. What coverage found is kept in build/fuzz_parsers/NAME, from which
the next run goes on; --record adds the run to results.json.
"""

from __future__ import annotations

import datetime
import os
import random
import shutil
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import click

from conformance.fuzz_parsers import readers, record

STARTED = time.monotonic()
LONGEST = 1024
"""Bytes of one input."""
CORPUS = readers.ROOT / "build" / "fuzz_parsers"


@dataclass
class Run:
    """What one run of this program did.

    stored  files of earlier runs that come first and do not count again
    """

    name: str
    runs: int
    seconds: float
    stored: int = 0
    said: Counter[bool] = field(default_factory=Counter)
    begin: float = STARTED
    cpu: float = field(default_factory=time.process_time)

    def count(self, refused: bool) -> None:
        """One file more."""
        if self.stored:
            self.stored -= 1
        else:
            self.said[refused] += 1

    @property
    def over(self) -> bool:
        """Whether the files or the time are used up."""
        took = time.monotonic() - self.begin
        return self.said.total() >= self.runs or 0 < self.seconds < took


@click.command()
@click.argument("name")
@click.option("--runs", default=10_000, show_default=True, help="How many files are read.")
@click.option("--seconds", default=0.0, help="End after this time.  [default: when all runs are done]")
@click.option("--seed", type=int, help="[default: 1; with --record the first that was not used]")
@click.option("--replay", help="Bytes of a finding, in hex.")
@click.option("--blind", is_flag=True, help="Draw bytes from the seed instead of following coverage.")
@click.option("--record", "keep", is_flag=True, help="Add the run to results.json and the table.")
def main(
    name: str, runs: int, seconds: float, seed: int | None, replay: str | None, blind: bool, keep: bool
) -> None:
    """Fuzz the reader NAME, such as scene, lock or mesh; README.md lists them."""
    if name not in readers.MODULES:
        sys.exit(f"fuzz_parsers: no reader {name}; there are {', '.join(readers.MODULES)}")
    atheris = None if blind or replay is not None else _atheris()
    if atheris is not None:
        # What is included is told apart by packages alone.
        with atheris.instrument_imports(include=list(readers.PACKAGES), exclude=readers.others(name)):
            from conformance.fuzz_parsers import mutation, parsers, sandbox
    else:
        from conformance.fuzz_parsers import mutation, parsers, sandbox
    warnings.filterwarnings(
        "error", module="codegen|conformance"
    )  # a person would see them beside a sentence
    parser = parsers.PARSERS[name]()
    way = "blind" if atheris is None else "by_coverage"
    before = record.recorded(name, readers.code_hash(name))
    if seed is None:
        seed = before.seeds[way] + 1 if keep else 1
    run = Run(name, runs, seconds)
    memory = Path("/dev/shm")
    with ExitStack() as stack:
        place = tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None)
        folder = stack.enter_context(place)
        box = sandbox.Sandbox(Path(folder))
        stack.enter_context(box.guarding())

        def one(data: bytes) -> None:
            file = mutation.mutated(data, parser.seeds, parser.trees, parser.write)
            try:
                run.count(bool(sandbox.examine(box, parser.read, parser.file, file)))
            except BaseException:
                traceback.print_exc()
                print(f"finding: --replay {data.hex()}\nfile: {file[:2000]!r}", flush=True)
                raise

        def end() -> None:
            taken, refused = run.said[False], run.said[True]
            cpu = time.process_time() - run.cpu
            print(f"{name}: {run.said.total()} files, {taken} taken, {refused} refused, {cpu:.0f} s, {way}")
            if keep:
                today = datetime.date.today().isoformat()
                record.keep(name, before.with_run(way, taken, refused, cpu, today), list(readers.MODULES))

        if replay is not None:
            one(bytes.fromhex(replay))
            print(f"{name}: {'taken' if run.said[False] else 'refused'}")
        elif atheris is None:
            drawn = random.Random(seed)
            while not run.over:
                one(drawn.randbytes(drawn.randrange(LONGEST)))
            end()
        else:
            _follow(atheris, one, run, end, seed, folder)


def _follow(
    atheris: Any, one: Callable[[bytes], None], run: Run, end: Callable[[], None], seed: int, folder: str
) -> None:
    """Inputs that follow coverage. libFuzzer never returns, so the process ends here.

    folder  where it leaves its own copy of a finding; what is printed replays it
    """
    corpus = CORPUS / run.name
    corpus.mkdir(parents=True, exist_ok=True)
    run.stored = sum(1 for _ in corpus.iterdir())

    def counted(data: bytes) -> None:
        one(data)
        if run.over:
            end()
            sys.stdout.flush()
            shutil.rmtree(folder)
            os._exit(0)

    options = [
        f"-seed={seed}",
        f"-max_len={LONGEST}",
        "-len_control=0",
        "-verbosity=0",
        f"-artifact_prefix={folder}/",
        "-timeout=0",
        "-rss_limit_mb=4096",
    ]
    atheris.Setup([sys.argv[0], *options, str(corpus)], counted)
    atheris.Fuzz()


def _atheris() -> Any:
    try:
        import atheris
    except ImportError:
        print("fuzz_parsers: atheris is not installed (pip install vair[fuzz]): bytes are drawn from a seed")
        return None
    return atheris


if __name__ == "__main__":
    main()
