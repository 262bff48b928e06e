"""Damaged sources are answered with a sentence.

Plan. Random valid programs lose, gain, repeat or swap tokens, letters and lines. What is left either is a
valid program, whose IR is well formed and which every target prints, or is refused with one line.
"""

from __future__ import annotations

import pytest

from conformance.fuzz.refusals import MUTANTS, Refusals, damaged, read_damaged

SEED = 3
PROGRAMS, NIGHTLY_PROGRAMS = 14, 2_500


def check(numbers: range) -> Refusals:
    found = Refusals()
    for number in numbers:
        read_damaged(SEED, number, MUTANTS, found)
    print("\n".join(found.lines()))
    shown = [f"program {n}, version {k}: {what}\n{text}" for n, k, what, text in found.crashes[:3]]
    assert not found.crashes, "\n".join(shown)
    return found


def test_damaged_sources_get_a_sentence() -> None:
    found = check(range(PROGRAMS))
    assert len(found.sentences) > 10, "the damage is too uniform to say anything"
    assert found.accepted


@pytest.mark.nightly
@pytest.mark.timeout(2 * 3600)
def test_many_damaged_sources_get_a_sentence() -> None:
    check(range(PROGRAMS, PROGRAMS + NIGHTLY_PROGRAMS))


def test_damage_is_the_same_each_time() -> None:
    assert damaged(SEED, 4, 2) == damaged(SEED, 4, 2)
