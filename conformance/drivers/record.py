"""Recorded results: one JSON file per driver and version under conformance/results, one line per function."""

from __future__ import annotations

import functools
import hashlib
import json
import math
import re
import time
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from datetime import date
from pathlib import Path
from typing import Any

from codegen.files import write_text
from codegen.intervals import DEFAULT_TABLES, load_table
from codegen.kernels import kernel
from codegen.library import Library
from conformance.check.accuracy import Accuracy
from conformance.check.failure import FINITE, PERMITTED, WITHIN
from conformance.check.interval import OUTSIDE
from conformance.check.operations import promises
from conformance.check.result import FunctionResult
from conformance.drivers.known import excess
from conformance.drivers.matrix import FORMAT
from conformance.drivers.modes import Mode, mode
from conformance.sweep.source import code_of
from targets import Device
from targets.drivers import Driver

FOLDER = Path(__file__).parents[1] / "results"
WRITE_SECONDS = 20.0
"""A run that is interrupted loses at most what it found in this time."""
_TOKENS = re.compile(r"(?P<name>\w+)(?: = |: )|\[(?P<words>[0-9a-f ]+)\]|(?P<brace>[{}])")


class Recorder:
    """Keeps the results of one driver in one mode as they come, so that an interrupted run loses little.

    What is recorded of other modes and of functions that are not run stays as it is.
    """

    def __init__(
        self, library: Library, driver: Driver, device: Device, mode: Mode, today: date, folder: Path = FOLDER
    ) -> None:
        self.library, self.driver, self.device, self.mode, self.today = library, driver, device, mode, today
        self.path = folder / f"{driver.slug(device)}.json"
        self.results: list[FunctionResult] = []
        self._written = time.monotonic()

    def current(self, names: Iterable[str]) -> list[str]:
        """Of these functions, the ones whose accepted record is of the present sources, bounds and tables."""
        functions = self._data()["modes"].get(self.mode.name, {}).get("functions", {})
        return [
            name
            for name in names
            if (f := functions.get(name)) is not None
            and f.get("judged") == fingerprint(self.library, name, self.driver.target, self.mode)
            and accepted(f)
        ]

    def add(self, result: FunctionResult) -> None:
        """Take a result in; write it now and then."""
        self.results.append(result)
        if time.monotonic() - self._written > WRITE_SECONDS:
            self.write()

    def write(self) -> Path:
        """Put everything so far into the driver's file."""
        data = self._data()
        new = mode_data(self.library, self.mode, self.results, self.today)
        data["modes"][self.mode.name] = merged(data["modes"].get(self.mode.name), new, self.library.public)
        whole = {
            "format": FORMAT,
            "driver": self.driver.name,
            "title": self.driver.title,
            "version": self.driver.version_of(self.device),
            "device": asdict(self.device),
            "modes": dict(sorted(data["modes"].items())),
        }
        write_text(self.path, as_text(whole))
        self._written = time.monotonic()
        return self.path

    def _data(self) -> dict[str, Any]:
        data: dict[str, Any] = {"modes": {}}
        if self.path.exists():
            found = json.loads(self.path.read_text(encoding="utf-8"))
            data = found if found["format"] == FORMAT else data
        return data


def accepted(f: Mapping[str, Any]) -> bool:
    """Whether a recorded function passed, or failed as expected."""
    bad = {FINITE: f["non_finite"] > 0, PERMITTED: f["permitted"] == OUTSIDE, WITHIN: not f["within"]}
    return all(name in f.get("known", {}) for name, is_bad in bad.items() if is_bad)


@functools.cache
def fingerprint(library: Library, name: str, target: str, mode: Mode) -> str:
    """Hash of what a verdict depends on: emitted code, bounds, what the table promises, number of inputs."""
    table = load_table(mode.table or DEFAULT_TABLES[target])
    bounds = library.bounds.get(name, ())
    parts = [
        repr(library.function(name).parameters),
        *code_of(kernel(library, name, target)),
        *(
            repr((b.measure, b.bound, b.floor, b.field, sorted(b.where.items()), sorted(b.targets)))
            for b in bounds
        ),
        *promises(library, name, table),
        repr(mode),
        str(FORMAT),
    ]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:16]


def merged(before: dict[str, Any] | None, new: dict[str, Any], public: Iterable[str]) -> dict[str, Any]:
    """A mode's data renewed: functions that were not run keep what was recorded, unless they are gone."""
    functions = {**(before["functions"] if before is not None else {}), **new["functions"]}
    return {**new, "functions": {name: functions[name] for name in public if name in functions}}


def mode_data(library: Library, mode: Mode, results: Iterable[FunctionResult], today: date) -> dict[str, Any]:
    """The results of one mode as plain data."""
    return {
        "date": today.isoformat(),
        "sources": library.select().source_hash,
        "functions": {r.function: function_data(library, r, mode) for r in results},
    }


def function_data(library: Library, r: FunctionResult, mode: Mode) -> dict[str, Any]:
    """One function: how far it came, its verdicts, and its largest errors with the inputs in hex."""
    data: dict[str, Any] = {
        "sources": library.select([r.function]).source_hash,
        "judged": fingerprint(library, r.function, r.target, mode),
        "stage": r.stage,
        "inputs": r.lanes,
        "within": r.within,
        "permitted": r.interval_verdict,
        "non_finite": r.non_finite,
    }
    if r.permitted is not None:
        data["table"] = r.permitted.table
        if r.permitted.unguaranteed:
            data["unguaranteed"] = r.permitted.unguaranteed
        if r.permitted.rearranged:
            data["rearranged"] = r.permitted.rearranged
        if r.permitted.outside:
            data["outside"] = {
                "results": r.permitted.outside,
                "excess": short(r.permitted.excess),
                "worst": hex_words(r.permitted.worst),
            }
    data["errors"] = [
        {"bound": b.limit, "measured": short(b.measured), "worst": hex_words(b.worst)} for b in r.bounds
    ]
    data["accuracy"] = [accuracy_data(a) for a in r.accuracy]
    if r.broken:
        data["broken"] = r.broken.splitlines()[0][:200]
    if not r.within or r.non_finite:
        data["excess"] = short(excess(r))
    if r.known:
        data["known"] = r.known
    return data


def accuracy_data(a: Accuracy) -> dict[str, Any]:
    """A distribution of errors with its worst input."""
    floor = {"floor": a.floor} if a.floor else {}
    figures = {"maximum": short(a.maximum), "p999": short(a.p999), "median": short(a.median)}
    return {"measure": a.measure, **floor, **figures, "worst": hex_words(a.worst)}


def short(number: float) -> float | str:
    """Four digits; infinite numbers as text, for JSON has none."""
    return float(f"{number:.4g}") if math.isfinite(number) else str(number)


def hex_words(inputs: str) -> str:
    """The words of shown inputs with their names: `a 3f800000 0 0, b.x 3f000000`."""
    parts: list[str] = []
    outer: list[str] = []
    name = ""
    for token in _TOKENS.finditer(inputs):
        if token["words"]:
            parts.append(f"{'.'.join([*outer, name])} {token['words']}")
        elif token["brace"] == "{":
            outer.append(name)
        elif token["brace"]:
            outer.pop()
        else:
            name = token["name"]
    return ", ".join(parts)


def as_text(data: dict[str, Any]) -> str:
    """JSON with one line per function, so that a changed result is a changed line."""
    modes = []
    for name, found in data["modes"].items():
        head = {key: value for key, value in found.items() if key != "functions"}
        rows = [f"   {json.dumps(f)}: {json.dumps(v)}" for f, v in found["functions"].items()]
        opening = json.dumps(head)[:-1]
        modes.append(f'  {json.dumps(name)}: {opening}, "functions": {{\n' + ",\n".join(rows) + "\n  }}")
    head = {key: value for key, value in data.items() if key != "modes"}
    return json.dumps(head, indent=1)[:-2] + ',\n "modes": {\n' + ",\n".join(modes) + "\n }\n}\n"


def read_all(folder: Path = FOLDER) -> dict[str, dict[str, Any]]:
    """Every recorded file by its name without the ending."""
    return {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in sorted(folder.glob("*.json"))}


def stale(library: Library, recorded: dict[str, dict[str, Any]]) -> Iterable[tuple[str, str, list[str]]]:
    """File, mode and functions whose verdicts are of something else than what is there now, or missing."""
    for stem, data in recorded.items():
        target = data["device"]["target"]
        for name, results in data["modes"].items():
            how, then = mode(name), results["functions"]
            old = [
                f
                for f in library.public
                if then.get(f, {}).get("judged") != fingerprint(library, f, target, how)
            ]
            if old:
                yield stem, name, old
