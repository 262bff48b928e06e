"""All misprints, in the lecture's order."""

from __future__ import annotations

from conformance.printed import fur, grids, shells, strands
from conformance.printed.misprint import Misprint

MISPRINTS: tuple[Misprint, ...] = (
    *strands.MISPRINTS,
    *fur.MISPRINTS,
    *grids.MISPRINTS,
    *shells.MISPRINTS,
)
