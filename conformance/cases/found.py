"""The worst inputs that searches have found, one table per section: the family "worst" of every function.

A row holds function, target, driver, the bound it was found for (measure, domain), the error there, and the
inputs: `l=3f800000 00000000 00000000;exponent=42c80000`, 32-bit words in hex. They are found by
`python -m conformance.search` on one driver and checked on all.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from conformance.cases import domains
from conformance.cases.parameters import FRAME_FIELDS, Leaf, leaves, nested, value_of

FOLDER = Path(__file__).parent / "worst"
COLUMNS = ("function", "target", "driver", "measure", "domain", "error", "inputs")
COMMENT = "# Worst inputs found so far: lower bounds of the error; written by python -m conformance.search\n"
DTYPES = {"f32": np.float32, "i32": np.int32, "u32": np.uint32, "bool": np.uint32}
_WORD = re.compile(r"[0-9a-fA-F]{8}")

Row = dict[str, str]


def rows(section: str, folder: Path = FOLDER) -> list[Row]:
    """The table of a section; empty where nothing was searched."""
    path = folder / f"{section}.csv"
    if not path.exists():
        return []
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


@cache
def _stored(section: str) -> list[Row]:
    return rows(section)


def words(function: Any, inputs: Mapping[str, Any], lane: int = 0) -> str:
    """One lane of inputs as text, words in hex."""
    parts = []
    for leaf in leaves(function.parameters):
        lane_values = np.atleast_1d(np.asarray(value_of(leaf, inputs))[lane])
        if lane_values.dtype == np.bool_:
            lane_values = lane_values.astype(np.uint32)
        bits = np.ascontiguousarray(lane_values).view(np.uint32)
        parts.append(f"{'.'.join(leaf.path)}={' '.join(f'{bit:08x}' for bit in bits)}")
    return ";".join(parts)


def inputs_of(function: Any, texts: Iterable[str]) -> dict[str, Any]:
    """Inputs from texts of `words`, one lane each; ValueError for words of other parameters."""
    found = leaves(function.parameters)
    columns: dict[tuple[str, ...], list[list[int]]] = {leaf.path: [] for leaf in found}
    for text in texts:
        given = dict(part.split("=", 1) for part in text.split(";"))
        if set(given) != {".".join(leaf.path) for leaf in found}:
            raise ValueError(f"{function.name} has other parameters than {text}")
        for leaf in found:
            where = f"{function.name}: {'.'.join(leaf.path)}"
            bits = [_word(where, word) for word in given[".".join(leaf.path)].split()]
            if len(bits) != size_of(leaf):
                raise ValueError(f"{where} has not {len(bits)} components")
            columns[leaf.path].append(bits)
    values = {leaf.path: _column(leaf, np.array(columns[leaf.path], np.uint32)) for leaf in found}
    return nested(values)


def _word(where: str, text: str) -> int:
    if not _WORD.fullmatch(text):
        raise ValueError(f"{where}: {text} is no word of 8 hexadecimal digits")
    return int(text, 16)


def size_of(leaf: Leaf) -> int:
    """Number of words of a leaf."""
    if leaf.type == "Frame":
        return 9
    return int(leaf.type[-1]) if "vec" in leaf.type else 1


def _column(leaf: Leaf, bits: npt.NDArray[np.uint32]) -> Any:
    if leaf.type == "Frame":
        floats = bits.view(np.float32)
        return {name: floats[:, 3 * k : 3 * k + 3] for k, name in enumerate(FRAME_FIELDS)}
    element = leaf.type if leaf.type in DTYPES else "u32" if leaf.type.startswith("u") else "f32"
    typed = bits.view(DTYPES[element])
    typed = typed if "vec" in leaf.type else typed[:, 0]
    return typed != 0 if leaf.type == "bool" else typed


def has_worst(function: Any) -> bool:
    """Whether a search has left inputs of this function."""
    return any(row["function"] == function.name for row in _stored(str(function.module)))


def worst(function: Any) -> dict[str, Any]:
    """All stored inputs of the function that lie in its domain; KeyError where there are none."""
    texts = dict.fromkeys(
        row["inputs"] for row in _stored(str(function.module)) if row["function"] == function.name
    )
    if not texts:
        raise KeyError(f"{function.name}: no search has left inputs")
    inputs = inputs_of(function, texts)
    inside = inside_domains(function, inputs)
    return cut(inputs, np.flatnonzero(inside))


def inside_domains(function: Any, inputs: Mapping[str, Any]) -> npt.NDArray[np.bool_]:
    """Which lanes lie in the domains of all parameters."""
    free = [leaf for leaf in leaves(function.parameters) if leaf.type != "Frame"]
    masks = [domains.contains(leaf.domain, value_of(leaf, inputs)) for leaf in free]
    lanes = len(next(iter(_arrays(inputs))))
    return np.asarray(np.logical_and.reduce(masks) if masks else np.ones(lanes), np.bool_)


def cut(inputs: Mapping[str, Any], lanes: Any) -> dict[str, Any]:
    """Those lanes of the inputs."""
    return {name: cut(v, lanes) if isinstance(v, Mapping) else v[lanes] for name, v in inputs.items()}


def _arrays(inputs: Mapping[str, Any]) -> Iterable[npt.NDArray[Any]]:
    for value in inputs.values():
        if isinstance(value, Mapping):
            yield from _arrays(value)
        else:
            yield value


def write(section: str, table: Iterable[Mapping[str, str]], folder: Path = FOLDER) -> None:
    """Write a section's table, sorted, with the same bytes for the same rows."""

    out = io.StringIO()
    writer = csv.DictWriter(out, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(sorted(table, key=lambda row: tuple(row[name] for name in COLUMNS)))
    folder.mkdir(exist_ok=True)
    (folder / f"{section}.csv").write_text(COMMENT + out.getvalue(), encoding="utf-8", newline="\n")
