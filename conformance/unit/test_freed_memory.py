"""Memory that was freed goes back to the system, and what a process holds is told."""

from __future__ import annotations

import ctypes

import pytest

from conformance.memory import give_back, resident

PART, PARTS = 100_000, 2000
"""Bytes and number of pieces, each too small to be mapped on its own: 200 MB."""


def test_what_was_freed_is_given_back() -> None:
    try:
        ctypes.CDLL(None).malloc_trim  # noqa: B018 - whether the C library has it
    except (AttributeError, OSError, TypeError):
        pytest.skip("this C library gives back memory in its own way")
    before = resident()
    if not before:
        pytest.skip("the system does not tell what a process holds")
    held = [bytes([k % 251]) * PART for k in range(PARTS)]
    last = held[-1]
    full = resident()
    assert full - before > PART * PARTS // 2
    del held  # the last piece, on top of the heap, keeps the rest from going back by itself
    give_back()
    assert resident() - before < (full - before) // 4
    assert len(last) == PART
