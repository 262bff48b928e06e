"""The [strands] table of a scene: which strands, how wide they are drawn, how light reaches into them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from codegen.scene.description.tables import Table

MOST_COPIES = 64


@dataclass(frozen=True)
class Hair:
    """Strands; lengths in units of the file. examples/README.md says what the keys mean."""

    file: Path
    width: float
    tip: float
    s_min: float
    copies: int
    spread: float
    seed: int


def read_hair(table: Table) -> Hair | None:
    """The strands of a scene; None where it has no [strands] table."""
    if not table.content:
        return None
    hair = Hair(
        file=table.path.parent / table.text("file"),
        width=table.number("width", 1e-6, 1e2),
        tip=table.number("tip", 0.0, 1.0, 1.0),
        s_min=table.number("s_min", 0.0, 1.0, 1.0),
        copies=table.integer("copies", 1, MOST_COPIES, 1),
        spread=table.number("spread", 0.0, 1e2, 0.0),
        seed=table.integer("seed", 0, 2**32 - 1, 1),
    )
    table.close()
    return hair
