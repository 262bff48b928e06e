"""Reading and writing families: one point a line, one column a component, words in hex."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt

from conformance.cases.family import Family, Points

DATA = Path(__file__).parent / "data"
COMPONENTS = "xyzw"


def columns(points: Points) -> dict[str, npt.NDArray[np.uint32]]:
    """Column name -> words: `exponent` for a scalar, `t.x`, `t.y`, `t.z` for a vector."""
    found: dict[str, npt.NDArray[np.uint32]] = {}
    for role, values in points.items():
        words = np.ascontiguousarray(values).view(np.uint32)
        if words.ndim == 1:
            found[role] = words
        else:
            found.update({f"{role}.{COMPONENTS[k]}": words[:, k] for k in range(words.shape[1])})
    return found


def text(family: Family, points: Points) -> str:
    """The family as CSV: comments that say what and why, a header row, then the words."""
    table = columns(points)
    lines = [
        f"# {family.name}: {family.what}",
        f"# why: {family.why}",
        "# 32-bit words in hex (float32 unless the column is u32); written by python -m conformance.cases",
        ",".join(table),
    ]
    lines += [",".join(f"{word:08x}" for word in row) for row in zip(*table.values(), strict=True)]
    return "\n".join(lines) + "\n"


@cache
def header_and_words(name: str) -> tuple[tuple[str, ...], npt.NDArray[np.uint32]]:
    """Column names and words (points, columns) of a stored family; FileNotFoundError if it is not there."""
    lines = (DATA / f"{name}.csv").read_text(encoding="ascii").splitlines()
    rows = [line.split(",") for line in lines if line and not line.startswith("#")]
    words = np.array([[int(word, 16) for word in row] for row in rows[1:]], dtype=np.uint32)
    return tuple(rows[0]), words


def read(family: Family) -> Points:
    """The stored points of a family, as float32 or uint32 by the types of its roles."""
    header, words = header_and_words(family.name)
    points: Points = {}
    for role in family.roles:
        chosen = [k for k, name in enumerate(header) if name.split(".")[0] == role.name]
        block = np.ascontiguousarray(words[:, chosen])
        typed = block if role.type == "u32" else block.view(np.float32)
        points[role.name] = typed[:, 0] if role.type in ("f32", "u32") else typed
    return points
