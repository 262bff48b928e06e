"""What codegen.intervals.machine can do: names and numbers of its instructions.

An instruction is a row of integers: the opcode; a 0; the number of its fork, or of the condition seen; then
its results; then its operands. A result or operand is a row of floats or of truth values; constants have rows
as well.
"""

from __future__ import annotations

NAMES = (
    "add",
    "subtract",
    "multiply",
    "square",
    "add nearest",
    "add points",
    "add fused",
    "fuse",
    "multiply nearest",
    "multiply points",
    "square nearest",
    "divide",
    "inverse_sqrt",
    "sqrt",
    "smaller",
    "larger",
    "negate",
    "size",
    "absolute",
    "floor point",
    "floor",
    "clamp",
    "<",
    "<=",
    "==",
    "and",
    "or",
    "seen",
    "choose",
    "choose point",
)
OPCODES = {name: number for number, name in enumerate(NAMES)}
WIDTH = 14
"""Integers of an instruction."""
FLOATS = 4
"""Parameters of an instruction, at most."""
