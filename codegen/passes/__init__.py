"""Passes over the IR, in order. Each takes well-formed IR and returns well-formed IR."""

from codegen.ir.unit import Unit
from codegen.library import Selection
from codegen.passes.printing.decided import drop_decided
from codegen.passes.printing.precise import name_results
from codegen.passes.printing.rename import add_prefix


def run_passes(selection: Selection | Unit, prefix: str, *, named_results: bool = False) -> Unit:
    """The functions and structs made ready to print.

    named_results  whether every returned value gets a local, for dialects that qualify locals
    """
    unit = drop_decided(Unit(selection.functions, selection.structs))
    if named_results:
        unit = name_results(unit)
    return add_prefix(unit, prefix)
