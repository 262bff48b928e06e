"""Bugs that other shader generators, compilers and libraries had, as programs: ours must not have them.

Plan. other_projects_bugs.toml holds each bug as a function of the source language with inputs and results, or
with the sentence that keeps it out. The functions are compiled together and executed on every target; the
evaluator of the IR must give the same.
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.errors import SourceError
from codegen.evaluate import evaluate
from codegen.evaluate.arrays import Value
from codegen.ir.nodes import Function
from codegen.ir.types import BOOL, F32, I32, U32, Type, Vector
from codegen.library import Library, load_library
from conformance.programs import batch
from conformance.unit.support.sources import HEADER
from targets import TimedRuntime

FILE = Path(__file__).with_suffix("").parent / "other_projects_bugs.toml"
LANES = 8
NAMES = re.compile(r"\b(probe|both|make|Inner|Outer)\b")
"""What the sources define; each bug's get its name appended, since all stand in one library."""
DTYPES: dict[Type, Any] = {F32: np.float32, U32: np.uint32, I32: np.int32, BOOL: np.bool_}


@dataclass(frozen=True)
class Bug:
    """One bug: a source, and what it must give or how it is refused."""

    name: str
    origin: str
    source: str
    inputs: dict[str, list[Any]] = field(default_factory=dict, hash=False)
    expected: list[Any] = field(default_factory=list, hash=False)
    tolerance: float = 0.0
    refused: str = ""

    @property
    def text(self) -> str:
        """The source, its functions and structs under names of their own."""
        own = NAMES.sub(lambda found: f"{found.group()}_{self.name}", self.source)
        return f"{HEADER}{own}\n"

    @property
    def entry(self) -> str:
        return f"probe_{self.name}"


def bugs() -> list[Bug]:
    data = tomllib.loads(FILE.read_text(encoding="utf-8"))
    return [Bug(name=name, **entry) for name, entry in data.items()]


EXECUTED = [bug for bug in bugs() if not bug.refused]
REFUSED = [bug for bug in bugs() if bug.refused]


def named(bug: Bug) -> str:
    return bug.name


@cache
def library(folder: Path) -> Library:
    """The library's own sources and the bugs' beside them."""
    root = folder / "shaderlib"
    source = load_library().root
    for path in source.rglob("*.py"):
        copy = root / path.relative_to(source)
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(path.read_bytes())
    for bug in EXECUTED:
        (root / "numeric" / f"{bug.entry}.py").write_text(bug.text, encoding="ascii")
    return Library(root)


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> Library:
    return library(tmp_path_factory.getbasetemp() / "bugs")


def inputs_of(bug: Bug, function: Function) -> dict[str, Any]:
    """The inputs, repeated to fill the lanes."""
    return {p.name: _array(p.type, bug.inputs[p.name]) for p in function.parameters}


def _array(type_: Type, values: list[Any]) -> Any:
    element = type_.element if isinstance(type_, Vector) else type_
    repeated = [values[k % len(values)] for k in range(LANES)]
    return np.array(repeated, DTYPES[element])


def assert_right(bug: Bug, got: Value) -> None:
    assert isinstance(got, np.ndarray)
    wanted = np.array([bug.expected[k % len(bug.expected)] for k in range(LANES)])
    if bug.tolerance:
        error = np.abs(got.astype(np.float64) - wanted) / (1.0 + np.abs(wanted))
        assert error.max() <= bug.tolerance, f"{bug.origin}: {got} instead of {wanted}"
    else:
        assert (got == wanted.astype(got.dtype)).all(), f"{bug.origin}: {got} instead of {wanted}"


def test_no_target_has_the_bugs(runtime: TimedRuntime, sources: Library) -> None:
    jobs = [batch.Job(bug.entry, inputs_of(bug, sources.function(bug.entry))) for bug in EXECUTED]
    for bug, value in zip(EXECUTED, batch.run(sources, jobs, runtime, LANES), strict=True):
        assert_right(bug, value)


@pytest.mark.parametrize("bug", EXECUTED, ids=named)
def test_the_evaluator_does_not_have_it(bug: Bug, sources: Library) -> None:
    function = sources.function(bug.entry)
    assert_right(bug, evaluate(sources, bug.entry, inputs_of(bug, function)))


@pytest.mark.parametrize("bug", REFUSED, ids=named)
def test_the_source_language_keeps_it_out(bug: Bug, tmp_path: Path) -> None:
    path = tmp_path / "numeric" / "probe.py"
    path.parent.mkdir()
    path.write_text(bug.text, encoding="ascii")
    with pytest.raises(SourceError) as caught:
        assert Library(tmp_path).functions
    assert bug.refused in caught.value.sentence


def test_every_bug_names_its_origin() -> None:
    assert not [bug.name for bug in bugs() if not bug.origin or not (bug.refused or bug.expected)]
