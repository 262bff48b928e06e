"""The front end knows where statements stand, and how far their names reach.

Plan.
  lines   every kind of statement has the number of its line in the source
  names   a loop's variable is free again after it, a local after its block
Statements themselves are the business of test_frontend_lowering.py.
"""

from __future__ import annotations

from pathlib import Path

from codegen.ir import nodes as ir
from codegen.ir.types import F32, I32
from conformance.unit.support.sources import FIRST_LINE, library_of

LINES = """def probe(x: X, n: u32) -> f32:
    total = x

    for i in range(min(n, 3)):
        total += x
        part = x
    if x > 0.0:
        total = x
    elif n > 3:

        return x
    else:
        return -x
    return total
"""


def lines(body: tuple[ir.Stmt, ...]) -> list[object]:
    """The kind and the line, from the function's first one on, of every statement and then of its parts."""
    found: list[object] = []
    for s in body:
        found.append((type(s).__name__, s.line - FIRST_LINE))
        if isinstance(s, ir.For):
            found += lines(s.body)
        if isinstance(s, ir.If):
            found += [*lines(s.then), *lines(s.orelse)]
    return found


def test_statements_know_their_lines(tmp_path: Path) -> None:
    function = library_of(tmp_path, LINES).function("probe")
    assert function.place.line == FIRST_LINE
    assert lines(function.body) == [
        ("Let", 1),
        ("For", 3),
        ("Assign", 4),
        ("Let", 5),
        ("If", 6),
        ("Assign", 7),
        ("If", 8),
        ("Return", 10),
        ("Return", 12),
        ("Return", 13),
    ]


AGAIN = """def probe(x: X) -> f32:
    total = 0.0
    for i in range(3):
        part = x
        total += part
    for i in range(2):
        part = i
        total += f32(part)
    i = x
    part = total
    return part + i
"""


def test_names_are_free_after_their_blocks(tmp_path: Path) -> None:
    """They may even stand for something of another type."""
    body = library_of(tmp_path, AGAIN).function("probe").body
    first, second = (s for s in body if isinstance(s, ir.For))
    assert first.body[0] == ir.Let("part", ir.Var(F32, "x"))
    assert second.body[0] == ir.Let("part", ir.Var(I32, "i"))
    assert body[3:5] == (ir.Let("i", ir.Var(F32, "x")), ir.Let("part", ir.Var(F32, "total")))
