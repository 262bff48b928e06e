"""Passes over the IR, in order. Each takes well-formed IR and returns well-formed IR."""

from codegen.ir.unit import Unit
from codegen.library import Selection
from codegen.passes.rename import add_prefix


def run_passes(selection: Selection, prefix: str) -> Unit:
    """The selection made ready to print."""
    unit = Unit(selection.functions, selection.structs)
    return add_prefix(unit, prefix)
