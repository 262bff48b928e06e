"""The catalogue of drivers, and opening one of them in a process that was started for it."""

import json
import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cache
from glob import glob
from pathlib import Path
from typing import Any

from targets import TARGETS, Device, TargetUnavailable, TimedRuntime, open_runtime
from targets.packages import fits

CATALOGUE = Path(__file__).with_name("drivers.toml")
PROBE_SECONDS = 120.0
"""A driver that takes longer than this to open hangs."""

PROBES_AT_ONCE = 4

MATCHED = ("api", "driver", "device")


@dataclass(frozen=True)
class Driver:
    """One entry of drivers.toml; see there for the fields."""

    name: str
    title: str
    target: str
    install: str
    environment: Mapping[str, str] = field(default_factory=dict)
    files: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    settings: Mapping[str, Any] = field(default_factory=dict)
    kernel: Mapping[str, str] = field(default_factory=dict)
    match: Mapping[str, str] = field(default_factory=dict)
    version: str = ""
    system: bool = False
    note: str = ""

    def version_of(self, device: Device) -> str:
        """The driver's version as the device tells it; empty where it tells none."""
        found = re.search(self.version, "; ".join(strings(device))) if self.version else None
        return found.group(1) if found else ""

    def slug(self, device: Device) -> str:
        """A file name for results: the driver's name and version, or the device's own name."""
        stem = f"{self.target} {device.device} {device.driver}" if self.system else self.name
        version = "" if self.system else self.version_of(device)
        return re.sub(r"[^a-z0-9.+]+", "-", f"{stem} {version}".lower()).strip("-")


def strings(device: Device) -> tuple[str, str, str]:
    """What a device says of itself: api, driver, device."""
    return device.api, device.driver, device.device


@cache
def catalogue() -> dict[str, Driver]:
    """Every driver by name."""
    return parse(tomllib.loads(CATALOGUE.read_text(encoding="utf-8")), CATALOGUE.name)


def parse(table: Mapping[str, Any], shown: str) -> dict[str, Driver]:
    """The drivers of a table; raises ValueError with one sentence that names the entry."""
    drivers = {}
    known = set(Driver.__dataclass_fields__) - {"name"}
    for name, entry in table.items():
        if missing := sorted({"title", "target", "install"} - set(entry)):
            raise ValueError(f"{shown}: driver {name} lacks {', '.join(missing)}")
        if foreign := sorted(set(entry) - known):
            raise ValueError(f"{shown}: driver {name} has the unknown key {foreign[0]}")
        if entry["target"] not in TARGETS:
            raise ValueError(f"{shown}: driver {name} is of an unknown target {entry['target']}")
        if set(entry.get("match", {})) - set(MATCHED) or not (entry.get("match") or entry.get("system")):
            raise ValueError(f"{shown}: driver {name} must match some of {', '.join(MATCHED)}")
        files = {variable: tuple(places) for variable, places in entry.get("files", {}).items()}
        drivers[name] = Driver(name=name, **{**entry, "files": files})
    return drivers


def driver(name: str) -> Driver:
    """A driver by name; raises ValueError with the nearest name."""
    drivers = catalogue()
    if name not in drivers:
        close = get_close_matches(name, drivers, 1)
        hint = f'; did you mean "{close[0]}"?' if close else f"; valid names: {', '.join(drivers)}"
        raise ValueError(f'unknown driver "{name}"{hint}')
    return drivers[name]


def environment_of(chosen: Driver) -> dict[str, str]:
    """All variables of a process that is to load the driver; raises TargetUnavailable for a missing file."""
    environment = {**os.environ, **chosen.environment}
    for variable, places in chosen.files.items():
        found = [path for place in places for path in sorted(glob(place))]
        if not found:
            raise TargetUnavailable(f"none of {', '.join(places)} is here: {chosen.install}")
        environment[variable] = found[0]
    return environment


def open_driver(chosen: Driver, **settings: object) -> TimedRuntime:
    """The runtime of a driver, in a process that has its environment.

    settings  beyond the driver's own, for the target's open_runtime
    errors    TargetUnavailable, also where something else than the driver answered
    """
    try:
        runtime = open_runtime(chosen.target, **{**chosen.settings, **settings})
    except TargetUnavailable as reason:
        raise TargetUnavailable(f"{reason} ({chosen.install})") from reason
    check_match(chosen, runtime.device)
    return runtime


def check_match(chosen: Driver, device: Device) -> None:
    """Raise TargetUnavailable unless the device says of itself what the catalogue expects."""
    said = dict(zip(MATCHED, strings(device), strict=True))
    wrong = [f"{key} {said[key]}" for key, wanted in chosen.match.items() if not fits(wanted, said[key])]
    if wrong:
        raise TargetUnavailable(
            f"{chosen.name} did not answer, but one with {', '.join(wrong)}: {chosen.install}"
        )


def probe_driver(chosen: Driver) -> Device | TargetUnavailable:
    """The device that a driver opens in a process of its own, or why there is none (returned, not raised)."""
    try:
        done = subprocess.run(
            [sys.executable, "-m", "targets.identify", chosen.name],
            env=environment_of(chosen),
            cwd=Path(__file__).parents[1],
            capture_output=True,
            text=True,
            errors="replace",
            timeout=PROBE_SECONDS,
            check=False,
        )
    except TargetUnavailable as reason:
        return reason
    except subprocess.TimeoutExpired:
        return TargetUnavailable(f"{chosen.name} did not open within {PROBE_SECONDS:.0f} s")
    lines = done.stdout.splitlines()
    if done.returncode or not lines:
        last = (done.stderr.strip().splitlines() or ["it said nothing"])[-1]
        return TargetUnavailable(f"{chosen.name} ended with status {done.returncode}: {last}")
    answer = json.loads(lines[-1])
    return Device(**answer["device"]) if "device" in answer else TargetUnavailable(answer["unavailable"])


def present(names: Iterable[str] = ()) -> dict[str, Device | TargetUnavailable]:
    """The device of each driver, or why there is none. Without names: of every driver of the catalogue.

    Without names a system driver is left out where a driver with a name of its own opened the same device.
    """
    wanted = [driver(name) for name in names]
    chosen = wanted or list(catalogue().values())
    with ThreadPoolExecutor(max_workers=PROBES_AT_ONCE) as threads:
        found = dict(zip((d.name for d in chosen), threads.map(probe_driver, chosen), strict=True))
    if wanted:
        return found
    named = [found[d.name] for d in catalogue().values() if not d.system]
    return {name: answer for name, answer in found.items() if not (driver(name).system and answer in named)}
