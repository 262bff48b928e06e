"""Values that interval evaluation drops and computes again stay the values that they were.

Plan. An operation that is asked for after its result was dropped gives a value of the same number, which is
what makes x - x vanish, and of the same causes, which name the first line; what forks is never dropped. And
whole functions, some of which compute values again, have the same intervals, codes and causes as with every
value kept, under every table.
"""

from __future__ import annotations

import gc

import numpy as np
import pytest

from codegen.intervals import TABLES, permitted
from codegen.intervals.memory import Memory
from codegen.intervals.values import Range, always
from codegen.library import load_library
from conformance.cases.drawing import UNIFORM, draw
from conformance.metamorphic.pairs import columns

LANES = 200
FUNCTIONS = (
    "fakefur_shade_printed",
    "strand_pdf",
    "hammersley",
    "scheuermann_shade",
    "poulin_fournier_value",
)


def number() -> Range:
    return Range(np.zeros(3), np.ones(3))


def test_dropped_value_keeps_its_number() -> None:
    memory = Memory(forgets=True)
    first = memory.keep(("*", 1, 2), number())
    assert memory.recall(("*", 1, 2)) is first
    known = first.number
    assert known != number().number
    del first
    gc.collect()
    assert memory.recall(("*", 1, 2)) is None
    again = memory.keep(("*", 1, 2), number())
    assert again.number == known
    assert memory.recall(("*", 1, 2)) is again
    assert memory.recall(("*", 2, 1)) is None


def test_dropped_value_keeps_its_causes() -> None:
    memory = Memory(forgets=True)
    unbounded = number()
    unbounded.cause = first_line = np.ones(3, np.int16)
    memory.keep(("/", 1), unbounded)
    memory.keep(("/", 2), number())
    del unbounded
    gc.collect()
    assert memory.recall(("/", 1)) is None, "it is dropped, since it may be large"
    for operand, causes in ((1, first_line), (2, None)):
        again = number()
        again.cause = np.full(3, 2, np.int16)
        assert memory.keep(("/", operand), again).cause is causes


@pytest.mark.parametrize("key", [("floor", 1), ("i32()", 1), ("u32()", 1)])
def test_forks_are_kept(key: tuple[str, int]) -> None:
    memory = Memory(forgets=True)
    known = memory.keep(key, number()).number
    assert memory.recall(key).number == known


def test_truths_vectors_and_ways_are_kept() -> None:
    memory = Memory(forgets=True)
    memory.keep(("<", 1), always(True))
    memory.keep(("cross", 1), (number(), number()))
    assert all(memory.recall((op, 1)) is not None for op in ("<", "cross"))
    following = Memory(forgets=False)
    following.keep(("*", 1), number())
    assert following.recall(("*", 1)) is not None


@pytest.mark.parametrize("name", FUNCTIONS)
def test_intervals_do_not_depend_on_what_is_dropped(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    library = load_library()
    inputs = draw(library.function(name), UNIFORM, LANES)
    dropping = [permitted(library, name, inputs, table) for table in TABLES]
    plain = Memory.__init__
    monkeypatch.setattr(Memory, "__init__", lambda self, forgets: plain(self, False))
    for table, found in zip(TABLES, dropping, strict=True):
        kept = permitted(library, name, inputs, table)
        ends = [columns({"low": p.low, "high": p.high}) for p in (found, kept)]
        assert all(np.array_equal(a, b) for a, b in zip(*ends, strict=True))
        assert np.array_equal(found.codes, kept.codes)
        assert found.causes == kept.causes
