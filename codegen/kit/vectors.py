"""Test vectors of one function, and the two files that hold them: JSON for every language, npz for numpy."""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound
from codegen.describe import signature
from codegen.ir.nodes import Function
from codegen.kit.rows import Row, Words, hexadecimal, input_rows, result_rows

FORMAT = 1
"""Of the kit's files and of results; a reader refuses any other."""

Mask = npt.NDArray[np.bool_]
Rows = tuple[npt.NDArray[Any], ...]


@dataclass(frozen=True)
class Interval:
    """What one accuracy table permits: ends per row, and the lanes in which it permits not everything."""

    low: Rows
    high: Rows
    bounded: Mask


@dataclass(frozen=True)
class Vectors:
    """Inputs of a function, and what is known of the right results.

    source     hash of the sources of the function and of what it needs
    inputs     (rows, lanes) words
    families   where the lanes come from, in order: name and number of lanes
    expected   the reference in float64, per row; whole numbers and truth values as integers
    ambiguous  lanes in which rounding decides between two documented values: only finiteness is asked
    intervals  accuracy table -> permitted results
    bounds     the declared bounds, each with the lanes in its domain
    """

    function: Function
    source: str
    inputs: Words
    families: tuple[tuple[str, int], ...]
    expected: Rows
    ambiguous: Mask
    intervals: Mapping[str, Interval]
    bounds: tuple[tuple[Bound, Mask], ...]

    @property
    def lanes(self) -> int:
        return int(self.inputs.shape[1])

    @property
    def identity(self) -> str:
        """16 digits that change with the function's text and with any input."""
        return identity(self.function, self.source, self.inputs)


def identity(function: Function, source: str, inputs: Words) -> str:
    """The identity of vectors. Results carry it, so that none is judged by inputs it was not made from."""
    digest = hashlib.sha256(f"{function.name} {source} {inputs.shape}".encode())
    digest.update(np.ascontiguousarray(inputs, dtype="<u4").tobytes())
    return digest.hexdigest()[:16]


def as_data(v: Vectors) -> dict[str, Any]:
    """What the JSON file holds; README.md of the kit says what each key means."""
    return {
        "format": FORMAT,
        "function": v.function.name,
        "signature": signature(v.function),
        "vectors": v.identity,
        "source": v.source,
        "lanes": v.lanes,
        "families": [{"name": name, "lanes": count} for name, count in v.families],
        "inputs": [
            {**_row(row), "words": hexadecimal(words)}
            for row, words in zip(input_rows(v.function), v.inputs, strict=True)
        ],
        "expected": [
            {**_row(row), "values": _numbers(values)}
            for row, values in zip(result_rows(v.function), v.expected, strict=True)
        ],
        "ambiguous": _lanes(v.ambiguous),
        "intervals": _intervals(v),
        "bounds": [{**_bound(bound), "lanes": _which(mask)} for bound, mask in v.bounds],
    }


def as_json(v: Vectors) -> bytes:
    """The JSON file; a row to a line, so that a difference between two kits can be read."""
    return (_lines(as_data(v)) + "\n").encode()


def as_npz(v: Vectors) -> bytes:
    """The npz file: the same as arrays, with `about` as JSON for what is no array."""
    data = as_data(v)
    about = {
        **{key: data[key] for key in ("format", "function", "signature", "vectors", "source", "families")},
        "inputs": [_row(row) for row in input_rows(v.function)],
        "expected": [_row(row) for row in result_rows(v.function)],
        "bounds": [_bound(bound) for bound, _ in v.bounds],
    }
    arrays: dict[str, npt.NDArray[Any]] = {
        "about": np.array(json.dumps(about)),
        "inputs": v.inputs,
        "expected": np.stack([row.astype(np.float64) for row in v.expected]),
        "ambiguous": v.ambiguous,
        "bounds": np.stack([mask for _, mask in v.bounds]) if v.bounds else np.empty((0, v.lanes), np.bool_),
    }
    for table, found in v.intervals.items():
        arrays[f"{table}_low"] = np.stack([_open(row, found.bounded, -np.inf) for row in found.low])
        arrays[f"{table}_high"] = np.stack([_open(row, found.bounded, np.inf) for row in found.high])
    out = io.BytesIO()
    np.savez_compressed(out, allow_pickle=False, **arrays)
    return out.getvalue()


def _row(row: Row) -> dict[str, str]:
    return {"path": row.path, "type": row.type}


def _bound(bound: Bound) -> dict[str, Any]:
    return {
        "text": bound.describe(),
        "measure": bound.measure,
        "bound": bound.bound,
        "floor": bound.floor,
        "field": bound.field,
        "targets": list(bound.targets),
        "domain": bound.domain,
        "origin": bound.origin,
    }


def _intervals(v: Vectors) -> dict[str, Any]:
    """Table -> ends; a table that permits the same as an earlier one has its name instead."""
    told: dict[str, Any] = {}
    for table, found in v.intervals.items():
        ends = _interval(v.function, found)
        told[table] = next((name for name, earlier in told.items() if earlier == ends), ends)
    return told


def _interval(function: Function, found: Interval) -> dict[str, Any]:
    """The ends of all rows; null in lanes in which the table permits everything."""

    def ends(rows: Rows) -> list[dict[str, Any]]:
        return [
            {
                "path": row.path,
                "values": [
                    x if sure else None for x, sure in zip(_numbers(values), found.bounded, strict=True)
                ],
            }
            for row, values in zip(result_rows(function), rows, strict=True)
        ]

    return {"low": ends(found.low), "high": ends(found.high)}


def _open(row: npt.NDArray[Any], bounded: Mask, end: float) -> npt.NDArray[np.float64]:
    return np.where(bounded, row.astype(np.float64), end)


def _numbers(values: npt.NDArray[Any]) -> list[float | int | None]:
    """Values that JSON can hold: null for what is not finite."""
    if values.dtype.kind == "f":
        return [float(x) if np.isfinite(x) else None for x in values]
    return [int(x) for x in values]


def _lanes(mask: Mask) -> list[int]:
    return [int(lane) for lane in np.flatnonzero(mask)]


def _which(mask: Mask) -> list[int] | str:
    """Numbers of lanes, or "all"."""
    return "all" if mask.all() else _lanes(mask)


def _lines(value: Any, indent: str = "") -> str:
    """JSON with one line for each list of plain values."""
    inner = indent + " "
    if isinstance(value, dict) and value:
        parts = [f"{inner}{json.dumps(key)}: {_lines(v, inner)}" for key, v in value.items()]
        return "{\n" + ",\n".join(parts) + f"\n{indent}}}"
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return "[\n" + ",\n".join(inner + _lines(v, inner) for v in value) + f"\n{indent}]"
    return json.dumps(value, allow_nan=False)
