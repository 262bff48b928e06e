"""Results that were computed elsewhere: a JSON or npz file as a kit's README.md describes it."""

from __future__ import annotations

import io
import json
import re
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError, unknown
from codegen.ir.nodes import Function
from codegen.kit.rows import Words, result_rows
from codegen.kit.vectors import FORMAT
from codegen.library import Library
from codegen.version import VERSION

ABOUT = "about"
"""The entry of an npz file that holds all but the numbers, as JSON."""
MOST_LANES = 10_000_000
"""Of one family; more than that is a damaged file."""
DAMAGED = (ValueError, OSError, EOFError, KeyError, NotImplementedError, MemoryError, zipfile.BadZipFile)
HEXADECIMAL = re.compile(r"[0-9a-fA-F]{8}")
NOT_FINITE = {"nan": np.nan, "inf": np.inf, "-inf": -np.inf}


@dataclass(frozen=True)
class Computed:
    """Results of one function: words (rows, lanes), or a sentence that says why there are none."""

    vectors: str
    words: Words | None
    failed: str = ""


@dataclass(frozen=True)
class Results:
    """A file of results.

    lanes, family  the kit's random points, and most points of a family of hard cases
    wanted         the functions of the kit
    target, table  how to judge; table is empty where the target's own is meant
    driver         what computed them, in the words of whoever did
    """

    path: Path
    lanes: int
    family: int
    wanted: tuple[str, ...]
    target: str
    table: str
    driver: str
    functions: Mapping[str, Computed]


def read_results(library: Library, path: Path) -> Results:
    """The results in a file; raises UserError, one sentence, for anything that cannot be judged."""
    about, arrays = _read(path)
    kit = _kit(path, about.get("kit"))
    computed: dict[str, Computed] = {}
    functions = about.get("functions")
    if not isinstance(functions, dict) or not functions:
        raise UserError(f'{path}: "functions" holds no results')
    for name in (*functions, *kit["functions"]):
        if name not in library.public:
            raise UserError(f"{path}: {unknown('function', name, library.public)}")
    for name, entry in functions.items():
        if name not in kit["functions"]:
            raise UserError(f"{path}: {name} is none of its kit's functions")
        if not isinstance(entry, dict) or not isinstance(entry.get("vectors"), str):
            raise UserError(f'{path}: {name} lacks "vectors", which its vectors state')
        words = None
        failed = entry.get("failed", "")
        if not isinstance(failed, str):
            raise UserError(f'{path}: {name}: "failed" is a sentence')
        if not failed:
            rows = arrays.get(name) if arrays is not None else entry.get("rows")
            words = _words(path, library.function(name), rows)
        computed[name] = Computed(entry["vectors"], words, failed)
    return Results(
        path,
        lanes=kit["lanes"],
        family=kit["family"],
        wanted=tuple(dict.fromkeys(kit["functions"])),
        target=_text(path, about, "target"),
        table=_text(path, about, "table", needed=False),
        driver=_text(path, about, "driver"),
        functions=computed,
    )


def _read(path: Path) -> tuple[dict[str, Any], Mapping[str, Any] | None]:
    """All but the numbers, and the arrays of an npz file; None for JSON, where the numbers are among it."""
    try:
        data = path.read_bytes()
    except OSError as e:
        raise UserError(f"{path}: {e.strerror}") from None
    arrays: dict[str, Any] | None = None
    try:
        if zipfile.is_zipfile(io.BytesIO(data)):
            with np.load(io.BytesIO(data), allow_pickle=False) as file:
                arrays = {name: file[name] for name in file.files}
            about = json.loads(str(arrays[ABOUT][()]))
        else:
            about = json.loads(data)
    except (*DAMAGED, zlib.error, RecursionError):
        raise UserError(
            f"{path} is neither JSON nor an npz file of results; see the kit's README.md"
        ) from None
    if not isinstance(about, dict) or "kit" not in about:
        raise UserError(f'{path} holds no results: "kit" of kit.json is missing')
    return about, arrays


def _kit(path: Path, kit: Any) -> dict[str, Any]:
    """The kit that results come from, as its kit.json says it; raises UserError for another version's."""
    if not isinstance(kit, dict):
        raise UserError(f'{path}: "kit" is not that of kit.json')
    if kit.get("format") != FORMAT or kit.get("version") != VERSION:
        raise UserError(
            f"{path}: made with a kit of vair {kit.get('version')}, format {kit.get('format')}; this is vair "
            f"{VERSION}, format {FORMAT}: write a kit with this version and run it again"
        )
    for key in ("lanes", "family"):
        if type(kit.get(key)) is not int or not 1 <= kit[key] <= MOST_LANES:
            raise UserError(f'{path}: "kit": "{key}" is a number from 1 on')
    names = kit.get("functions")
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise UserError(f'{path}: "kit": "functions" is a list of names')
    return kit


def _text(path: Path, about: Mapping[str, Any], key: str, *, needed: bool = True) -> str:
    value = about.get(key, "")
    if not isinstance(value, str) or (needed and not value):
        raise UserError(f'{path}: "{key}" is missing or no text')
    return value


def _words(path: Path, function: Function, rows: Any) -> Words:
    """The words of a function's results, (rows, lanes)."""
    wanted = result_rows(function)
    if rows is None:
        raise UserError(f"{path}: {function.name} has neither results nor a sentence why it failed")
    if isinstance(rows, np.ndarray) and rows.ndim < 2:
        rows = np.atleast_1d(rows)[None]
    if not isinstance(rows, list | np.ndarray) or len(rows) != len(wanted):
        raise UserError(
            f"{path}: {function.name} has {len(wanted)} rows: {', '.join(r.path for r in wanted)}"
        )
    found = []
    for row, values in zip(wanted, rows, strict=True):
        where = f"{path}: {function.name}: row {row.path}"
        if isinstance(values, np.ndarray):
            found.append(_from_array(where, row.type, values))
        elif isinstance(values, list):
            found.append(np.array([_word(where, row.type, value) for value in values], np.uint32))
        else:
            raise UserError(f"{where} is no list")
    if len({len(words) for words in found}) != 1:
        raise UserError(f"{path}: the rows of {function.name} differ in length")
    return np.stack(found)


def _from_array(where: str, type_: str, values: npt.NDArray[Any]) -> Words:
    """Words as they are, floats as float32, whole numbers and truth values as the row's type."""
    if values.ndim != 1:
        raise UserError(f"{where} has {values.ndim} dimensions instead of one: the lanes")
    if values.dtype == np.uint32:
        return values
    if type_ == "f32" and values.dtype.kind == "f":
        with np.errstate(over="ignore"):  # beyond the largest float32: infinite, as a device has it
            return values.astype(np.float32).view(np.uint32)
    if type_ != "f32" and values.dtype.kind in "iub":
        return values.astype(np.int64).astype(np.uint32)
    raise UserError(f"{where} holds {values.dtype.name}; {type_} is needed, or its words as uint32")


def _word(where: str, type_: str, value: Any) -> int:
    """One value of a JSON file: eight hexadecimal digits, or a number."""
    try:
        if isinstance(value, str) and HEXADECIMAL.fullmatch(value):
            return int(value, 16)
        if type_ == "f32" and value in NOT_FINITE:
            value = NOT_FINITE[value]
        if isinstance(value, int | float) and type_ == "f32":
            with np.errstate(over="ignore"):
                return int(np.float32(value).view(np.uint32))
        if isinstance(value, int) and -(2**31) <= value < 2**32:
            return value & 0xFFFFFFFF
    except (ValueError, TypeError, OverflowError):
        pass
    shown = json.dumps(value)[:40]
    raise UserError(f"{where} holds {shown}; {type_} is eight hexadecimal digits or a number")
