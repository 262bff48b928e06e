"""Why a result may be anything: which operation, on which operand, at which line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from codegen.intervals.numbers import Array

Codes = Array | None
"""int16 array: 0 where a value is bounded, else the number of its cause; None where all are bounded."""


@dataclass(frozen=True)
class Cause:
    """The first operation that may give anything."""

    function: str
    line: int
    operation: str
    operand: str
    reason: str

    @property
    def what(self) -> str:
        """The cause without its line, which moves with every edit of the source."""
        operand = f" of {self.operand}" if self.operand else ""
        return f"{self.function}: {self.operation}{operand}: {self.reason}"

    def __str__(self) -> str:
        return f"line {self.line} of {self.what}"


class CauseBook:
    """Numbers causes from 1 on, each distinct one once."""

    def __init__(self) -> None:
        self.causes: list[Cause] = []
        self._codes: dict[Cause, int] = {}

    def code(self, cause: Cause) -> int:
        """The cause's number."""
        if cause not in self._codes:
            self.causes.append(cause)
            self._codes[cause] = len(self.causes)
        return self._codes[cause]


def first(*codes: Codes) -> Codes:
    """Lane by lane the first cause that there is."""
    found: Codes = None
    for c in codes:
        if c is not None:
            found = c if found is None else np.where(found > 0, found, c)
    return found


def mark(codes: Codes, where: Array, code: int) -> Codes:
    """The causes, with `code` where the mask is set and no earlier cause is there."""
    fresh = np.where(where, np.int16(code), np.int16(0))
    return first(codes, fresh)
