"""Processor time of glslangValidator, each time a process of its own, forwards and backwards in rounds."""

from __future__ import annotations

import os
import statistics
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from codegen.backends import dialect
from codegen.emit.module import emit
from codegen.library import Library
from conformance.bench.compile.shells import Shell

SEVERAL = 5
"""Copies of a shader in one process, to see what one more costs where the built-ins are parsed already."""
EMPTY = ""


@dataclass(frozen=True)
class Taken:
    """Milliseconds of one kind of process, median and least of all rounds; others disturb the least less."""

    median: float
    least: float


@dataclass(frozen=True)
class Times:
    """What a function's include costs in a shell.

    whole    a process that compiles the shader; empty: the same without an include
    several  one with SEVERAL such shaders; None for SPIR-V, where glslangValidator links them
    """

    function: str
    whole: Taken
    empty: Taken
    several: Taken | None

    @property
    def above(self) -> float:
        """What the include adds, ms."""
        return self.whole.median - self.empty.median

    @property
    def more(self) -> float | None:
        """What one more such shader adds in a process that has parsed the built-ins, ms."""
        return None if self.several is None else (self.several.median - self.whole.median) / (SEVERAL - 1)


def longest(library: Library, names: Sequence[str]) -> list[str]:
    """The functions, those with the longest includes first: glslang takes a time for each token."""
    chosen = dialect("glsl", "es300")
    return sorted(names, key=lambda name: -len(emit(library, chosen, [name])))


def measured(library: Library, glslang: str, shell: Shell, names: Sequence[str], rounds: int) -> list[Times]:
    """The times of some functions in a shell."""
    texts = {name: shell.text(emit(library, dialect("glsl", shell.dialect), [name])) for name in names}
    texts[EMPTY] = shell.text("")
    counts = (1,) if shell.options else (1, SEVERAL)
    tasks = [(name, count) for name in texts for count in (counts if name else (1,))]
    found: dict[tuple[str, int], list[float]] = {task: [] for task in tasks}
    with tempfile.TemporaryDirectory() as scratch:
        for k in range(rounds):
            for name, count in tasks if k % 2 == 0 else reversed(tasks):
                took = _milliseconds(glslang, shell, Path(scratch), texts[name], count)
                found[name, count].append(took)
    taken = {task: Taken(statistics.median(times), min(times)) for task, times in found.items()}
    return [Times(name, taken[name, 1], taken[EMPTY, 1], taken.get((name, SEVERAL))) for name in names]


def whole_library(library: Library, glslang: str, shell: Shell, rounds: int) -> Taken:
    """The time of a shader that includes every documented function, in a shell."""
    text = shell.text(emit(library, dialect("glsl", shell.dialect), sorted(library.documented)))
    with tempfile.TemporaryDirectory() as scratch:
        times = [_milliseconds(glslang, shell, Path(scratch), text, 1) for _ in range(rounds)]
    return Taken(statistics.median(times), min(times))


def _milliseconds(glslang: str, shell: Shell, place: Path, text: str, count: int) -> float:
    """Processor time of one process; RuntimeError where glslang refuses the text."""
    files = [str(place / f"{k}.{shell.stage}") for k in range(count)]
    for file in files:
        Path(file).write_text(text, encoding="utf-8")
    log = place / "log"
    command = [glslang, *shell.options, *files]
    with log.open("w") as out:
        actions = [(os.POSIX_SPAWN_DUP2, out.fileno(), 1)]
        # wait4 gives the resources of this one child; subprocess has no such call.
        process = os.posix_spawn(command[0], _in_folder(command, place), os.environ, file_actions=actions)
        _, status, used = os.wait4(process, 0)
    if status != 0:
        raise RuntimeError(f"{shell.name}: {log.read_text(encoding='utf-8')[:500]}")
    return 1e3 * (used.ru_utime + used.ru_stime)


def _in_folder(command: list[str], place: Path) -> list[str]:
    """The command with its SPIR-V written into a folder: without -o glslang writes into the working one."""
    return [*command, "-o", str(place / "out.spv")] if "-V" in command else command
