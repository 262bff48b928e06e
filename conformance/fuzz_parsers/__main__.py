"""`python -m conformance.fuzz_parsers NAME --runs N`: fuzz one reader, guided by coverage (atheris).

A finding is printed with the bytes that make it again; --replay HEX runs these alone. Without atheris, or
with --blind, bytes are drawn from a seed.
"""

from __future__ import annotations

import os
import random
import shutil
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

LONGEST = 1024
"""Bytes of one input."""


@click.command()
@click.argument("name")
@click.option("--runs", default=10_000, show_default=True, help="How many files are read.")
@click.option("--seconds", default=0, help="End after this time.  [default: when all runs are done]")
@click.option("--seed", default=1, show_default=True)
@click.option("--replay", help="Bytes of a finding, in hex.")
@click.option("--blind", is_flag=True, help="Draw bytes from the seed instead of following coverage.")
def main(name: str, runs: int, seconds: int, seed: int, replay: str | None, blind: bool) -> None:
    """Fuzz the reader NAME: scene, picture, lock, results, kit, waterloo, samples or mesh."""
    atheris = None if blind or replay is not None else _atheris()
    if atheris is not None:
        with atheris.instrument_imports(include=["codegen", "conformance"]):
            from conformance.fuzz_parsers import mutation, parsers, sandbox
    else:
        from conformance.fuzz_parsers import mutation, parsers, sandbox
    if name not in parsers.PARSERS:
        sys.exit(f"fuzz_parsers: no reader {name}; there are {', '.join(parsers.PARSERS)}")
    parser = parsers.PARSERS[name]()
    said: Counter[bool] = Counter()
    begin = time.monotonic()
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as folder:
        box = sandbox.Sandbox(Path(folder))

        def one(data: bytes) -> None:
            file = mutation.mutated(data, parser.seeds, parser.trees, parser.write)
            try:
                said[bool(sandbox.examine(box, parser.read, parser.file, file))] += 1
            except BaseException:
                traceback.print_exc()
                print(f"finding: --replay {data.hex()}\nfile: {file[:2000]!r}", flush=True)
                raise

        def over() -> bool:
            took = time.monotonic() - begin
            if said.total() < runs and not 0 < seconds < took:
                return False
            print(f"{name}: {said.total()} files, {said[False]} taken, {said[True]} refused, {took:.0f} s")
            return True

        if replay is not None:
            one(bytes.fromhex(replay))
            print(f"{name}: {'taken' if said[False] else 'refused'}")
        elif atheris is None:
            _draw(one, over, seed)
        else:
            _follow(atheris, one, over, seed, folder)


def _draw(one: Callable[[bytes], None], over: Callable[[], bool], seed: int) -> None:
    """Inputs of seeded bytes."""
    drawn = random.Random(seed)
    while not over():
        one(drawn.randbytes(drawn.randrange(LONGEST)))


def _follow(
    atheris: Any, one: Callable[[bytes], None], over: Callable[[], bool], seed: int, folder: str
) -> None:
    """Inputs that follow coverage. libFuzzer never returns, so the process ends here.

    folder  where it leaves its own copy of a finding; what is printed replays it
    """

    def counted(data: bytes) -> None:
        one(data)
        if over():
            sys.stdout.flush()
            shutil.rmtree(folder)
            os._exit(0)

    options = [
        f"-seed={seed}",
        f"-max_len={LONGEST}",
        "-len_control=0",
        "-verbosity=0",
        f"-artifact_prefix={folder}/",
    ]
    options += ["-timeout=0", "-rss_limit_mb=4096"]
    atheris.Setup([sys.argv[0], *options], counted)
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
