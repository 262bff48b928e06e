"""Preparing functions in another process, a few ahead of the device: a machine with two cores uses both."""

from __future__ import annotations

import contextlib
import multiprocessing
import tempfile
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from pathlib import Path

from codegen.library import Library, load_library
from conformance.check.prepared import Prepared, has_reference, prepare

WORTHWHILE = 8
"""With fewer functions than this, starting the other process takes longer than it saves."""
LEAD = 3
"""Functions prepared ahead."""


def prepare_here(name: str, tables: Sequence[str], folder: str) -> None:
    """Put references and intervals of a function into the folder."""
    ready = prepare(load_library(), name, cache=Path(folder))
    _ = ready.truth if has_reference(ready.library, name) else None
    for table in tables:
        ready.permitted(table)


def prepared_ahead(
    library: Library, names: Sequence[str], tables: Sequence[str]
) -> Iterator[tuple[str, Prepared]]:
    """Each function with its inputs, references and intervals under the tables, in order."""
    if len(names) < WORTHWHILE:
        yield from ((name, prepare(library, name)) for name in names)
        return
    # A new process, not a copy of this one: a driver does not survive being copied.
    fresh = multiprocessing.get_context("spawn")
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="vair-check-"))
        pool = stack.enter_context(ProcessPoolExecutor(1, mp_context=fresh))
        stack.callback(pool.shutdown, wait=True, cancel_futures=True)
        left, running = deque(names), deque[tuple[str, Future[None]]]()
        while left or running:
            while left and len(running) <= LEAD:
                name = left.popleft()
                running.append((name, pool.submit(prepare_here, name, tables, folder)))
            name, job = running.popleft()
            job.result()
            yield name, prepare(library, name, cache=Path(folder))
            for path in Path(folder).glob(f"{name}-*"):
                path.unlink()
