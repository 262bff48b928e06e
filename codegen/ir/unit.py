"""What passes work on: functions in dependency order with the structs they use."""

from __future__ import annotations

from dataclasses import dataclass

from codegen.ir.nodes import Function, StructDef


@dataclass(frozen=True)
class Unit:
    """Functions and structs that are emitted together."""

    functions: tuple[Function, ...]
    structs: tuple[StructDef, ...]
