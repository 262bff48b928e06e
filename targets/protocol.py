"""What a target's device side looks like from outside: text and 32-bit words in, 32-bit words out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:  # the generator imports this package for its dialects and must not pay for numpy
    from collections.abc import Sequence

    from targets.textures import TextureData
    from targets.words import Words


@dataclass(frozen=True)
class Device:
    """The device that executes a target's programs, in words fit for a report.

    target   name of the target: glsl, wgsl or opencl
    api      programming interface and its version
    driver   driver and its version
    device   the device's own name
    """

    target: str
    api: str
    driver: str
    device: str


class TargetUnavailable(Exception):  # noqa: N818 - says what is the case
    """A target cannot run here; the message is one sentence that names the missing package."""


class BuildFailed(Exception):  # noqa: N818 - says what happened
    """A program or a library text was refused; the message is the compiler's log with its line numbers."""

    @property
    def log(self) -> str:
        """The compiler's log."""
        return str(self)


class Runtime(Protocol):
    """Runs complete programs of one target on one device."""

    @property
    def device(self) -> Device:
        """The device in use."""
        ...

    @property
    def half_arithmetic(self) -> bool:
        """Whether the device computes in half precision; mediump of desktop GLSL is full precision."""
        ...

    def run(self, program: str, words: Words, slots_out: int, textures: Sequence[TextureData] = ()) -> Words:
        """Run a program once per lane.

        program    complete program text, see targets.harness.complete_program
        words      input words, (slots_in, n)
        slots_out  number of 32-bit words that each lane writes
        textures   maps in the order in which the program declares them
        returns    output words, (slots_out, n); a word that the program left alone reads 0xdeaddead
        errors     BuildFailed with the compiler's log; a text that was built before is not built again
        """
        ...


class Prepared(Protocol):
    """A built program with its input on the device, to be launched as often as a measurement needs."""

    def launch(self) -> None:
        """Run the program over all lanes and wait until it is done."""

    def read(self) -> Words:
        """The output words, (slots_out, n); the array may be read-only."""
        ...

    def release(self) -> None:
        """Give the device's memory back; the object is of no use afterwards."""


class TimedRuntime(Runtime, Protocol):
    """A runtime that separates building and transfers from execution."""

    def prepare(
        self, program: str, words: Words, slots_out: int, textures: Sequence[TextureData] = ()
    ) -> Prepared:
        """Build a program (unless built before) and put its input on the device.

        The lanes have to fit one chunk: see chunk_lanes of targets.lanes. Arguments and errors are those
        of run.
        """
        ...
