"""A finding in full: the program, its reduction, the emitted text and the inputs."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

from codegen.backends import dialect
from codegen.emit.module import emit
from conformance.check.show import lane_inputs
from conformance.fuzz.case import draw_inputs
from conformance.fuzz.engine import LANES, Finding
from conformance.fuzz.reduce import Fails, reduce, refused_text, wrong_value
from conformance.fuzz.source import write
from conformance.fuzz.unparse import functions_text
from targets import Runtime


def explain(finding: Finding, runtimes: Sequence[Runtime]) -> str:
    """The finding with everything that a person needs; values and refused texts are reduced."""
    case = finding.case
    with tempfile.TemporaryDirectory() as folder:
        library = write(Path(folder), [case])
        lines = [str(finding), "", case.text]
        runtime = next((r for r in runtimes if r.device.target == finding.backend), None)
        fails: Fails | None = None
        if finding.kind == "value" and finding.backend != "python":
            inputs = draw_inputs(case, library.function(case.entry).parameters, LANES)
            lines.append(f"inputs: {lane_inputs(inputs, finding.lane)}")
            fails = wrong_value(inputs, finding.lane, runtime)
        elif finding.kind == "build" and runtime is not None:
            fails = refused_text(runtime)
        if fails is not None:
            reduced = reduce(library, case.entry, fails)
            selection = reduced.library.select([case.entry])
            lines.append(f"reduced to {reduced.nodes} IR nodes in {reduced.tries} tries:")
            lines.append(functions_text(selection.functions, selection.structs))
            if runtime is not None:
                lines.append(emit(reduced.library, dialect(finding.backend), [case.entry]))
        return "\n".join(lines)
