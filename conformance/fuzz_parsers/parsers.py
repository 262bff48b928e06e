"""What is fuzzed: readers of files that a person or another program hands over, by name."""

from __future__ import annotations

from collections.abc import Callable

from conformance.fuzz_parsers import descriptions, measured, messages, outcomes, shapes
from conformance.fuzz_parsers.parser import Parser

PARSERS: dict[str, Callable[[], Parser]] = {
    maker.__name__: maker
    for maker in (
        descriptions.scene,
        descriptions.picture,
        descriptions.lock,
        outcomes.results,
        outcomes.kit,
        outcomes.kit_npz,
        outcomes.report,
        outcomes.scene_report,
        measured.waterloo,
        measured.samples,
        measured.samples_npz,
        measured.factors,
        measured.table,
        measured.image,
        shapes.mesh,
        shapes.mesh_ply,
        shapes.mesh_gltf,
        shapes.mesh_glb,
        shapes.mesh_stl,
        shapes.mesh_off,
        shapes.strands,
        messages.line_map,
        messages.compiler_log,
    )
}
"""Made when asked for: some need the library."""
