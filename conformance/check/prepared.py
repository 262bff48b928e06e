"""All that judging a function needs and no device gives: inputs, references, exemptions, intervals.

It is the same for every backend, so it is computed once per function and shared: in memory between the
targets of one process, in files between the processes of several drivers.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import pickle
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from codegen.evaluate import evaluate
from codegen.intervals import Permitted, permitted
from codegen.ir.nodes import Function
from codegen.library import Library
from conformance.check.draws import Draw, draws
from conformance.check.sample import Sample, rows, together
from conformance.reference import PROPERTY_ONLY, ambiguous, reference_for

Kept = TypeVar("Kept")

COSTLY = ("poulin_fournier_value*",)
"""Functions with so many open comparisons that following each way takes seconds: a part of the lanes is
followed, the others have the hull of all ways."""
FOLLOWED = 8
"""One lane of so many of them is followed."""


@dataclass(frozen=True)
class Truth:
    """The reference's values, and the mask of the lanes of which only finiteness is asked."""

    expected: Any
    doubtful: npt.NDArray[np.bool_]


@dataclass
class Prepared:
    """The inputs of one function, and what is known of the right results.

    cache  a folder in which processes share the references and intervals; none: they are kept here only
    key    names the inputs in the folder
    """

    library: Library
    name: str
    sample: Sample
    cache: Path | None = None
    key: str = ""
    _kept: dict[str, Any] = field(default_factory=dict)

    @property
    def function(self) -> Function:
        return self.library.function(self.name)

    @property
    def truth(self) -> Truth:
        """Expected values and exempt lanes; KeyError for a function without a reference."""
        return self._once("truth", self._truth)

    def permitted(self, table: str) -> Permitted:
        """The intervals under an accuracy table."""
        return self._once(f"permitted-{table}", lambda: self._permitted(table))

    def _permitted(self, table: str) -> Permitted:
        inputs = self.sample.inputs
        if not any(fnmatchcase(self.name, glob) for glob in COSTLY):
            return permitted(self.library, self.name, inputs, table)
        whole = permitted(self.library, self.name, inputs, table, follow_forks=False)
        lanes = np.arange(0, self.sample.lanes, FOLLOWED)
        return narrowed(whole, lanes, permitted(self.library, self.name, rows(inputs, lanes), table))

    def _truth(self) -> Truth:
        function = self.function
        reference = find_reference(self.library, function)
        if reference is None:
            raise KeyError(self.name)
        base = function.base if function.kind == "variant" else None
        return Truth(
            expected_of(reference, self.sample.inputs), ambiguous(self.name, self.sample.inputs, base)
        )

    def _once(self, what: str, compute: Callable[[], Kept]) -> Kept:
        if what not in self._kept:
            path = self.cache / f"{self.name}-{self.key}-{what}.pickle" if self.cache else None
            self._kept[what] = compute() if path is None else shared(path, compute)
        found: Kept = self._kept[what]
        return found


def prepare(
    library: Library, name: str, drawn: Iterable[Draw] | None = None, cache: Path | None = None
) -> Prepared:
    """The inputs of a function, all its draws as one; drawn anew unless they are given."""
    parts = list(draws(library.function(name))) if drawn is None else list(drawn)
    key = "-".join(f"{d.family}.{d.count}" for d in parts) if cache else ""
    return Prepared(library, name, together(parts), cache, hash_of(key))


def narrowed(whole: Permitted, lanes: npt.NDArray[np.intp], part: Permitted) -> Permitted:
    """The intervals of all lanes, some of them replaced by narrower ones."""
    codes = whole.codes.copy()
    codes[lanes] = np.where(part.codes > 0, part.codes + len(whole.causes), 0)
    low, high = _replaced(whole.low, lanes, part.low), _replaced(whole.high, lanes, part.high)
    return Permitted(low, high, codes, (*whole.causes, *part.causes))


def _replaced(value: Any, lanes: npt.NDArray[np.intp], part: Any) -> Any:
    if isinstance(value, Mapping):
        return {name: _replaced(v, lanes, part[name]) for name, v in value.items()}
    changed = value.copy()
    changed[lanes] = part
    return changed


def hash_of(text: str) -> str:
    """A short name for a long one."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def shared(path: Path, compute: Callable[[], Kept]) -> Kept:
    """What a file holds, computed by the first process that asks; the others wait for it."""
    with open(path.with_suffix(".lock"), "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not path.exists():
            value = compute()
            aside = path.with_suffix(f".{os.getpid()}")
            aside.write_bytes(pickle.dumps(value, protocol=pickle.HIGHEST_PROTOCOL))
            aside.replace(path)
            return value
    found: Kept = pickle.loads(path.read_bytes())
    return found


def has_reference(library: Library, name: str) -> bool:
    """Whether there is something to compare a function with."""
    return find_reference(library, library.function(name)) is not None


def find_reference(library: Library, function: Function) -> Callable[..., Any] | None:
    """The independent reference; where no formula fixes a function, the evaluator: all targets agree.

    What such a function must do is tested by its properties.
    """
    if function.name in PROPERTY_ONLY:
        names = [p.name for p in function.parameters]
        return lambda *values: evaluate(library, function.name, dict(zip(names, values, strict=True)))
    try:
        return reference_for(function.name, function.base if function.kind == "variant" else None)
    except KeyError:
        return None


def expected_of(reference: Callable[..., Any], inputs: Mapping[str, Any]) -> Any:
    """The reference's values: it gets the exact float32 inputs, widened."""
    return reference(*(_widen(value) for value in inputs.values()))


def _widen(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {name: _widen(v) for name, v in value.items()}
    a = np.asarray(value)
    return a.astype(np.float64) if a.dtype == np.float32 else a
