"""README.md of this folder: page.md with the recorded results in it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from string import Template
from typing import Any

FOLDER = Path(__file__).parent
RESULTS = FOLDER / "results"
FITS = "fits.json"
PAGE = FOLDER / "README.md"
TEXT = FOLDER / "page.md"
ERRORS = ("rms", "seen", "rms_above", "seen_above", "median", "p95")
MODES = ("throughput", "latency")
NOTHING_TIMED = "the pairs of the fits"


def read_fits() -> dict[str, Any]:
    """The recorded fits; empty where nothing is recorded."""
    path = RESULTS / FITS
    found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    return found


def recorded() -> str:
    """The page of what is kept in results/."""
    kept = [path for path in sorted(RESULTS.glob("*.json")) if path.name != FITS]
    return written(read_fits(), [json.loads(path.read_text(encoding="utf-8")) for path in kept])


def written(fits: Mapping[str, Any], drivers: Sequence[Mapping[str, Any]]) -> str:
    """The page of these fits and these drivers."""
    return Template(TEXT.read_text(encoding="utf-8")).substitute(
        fits=_fits(fits["fits"]),
        materials=_materials(fits["materials"]),
        speed="".join(map(_driver, drivers)),
        judged=drivers[0]["judged"] if drivers else NOTHING_TIMED,
        **{key: fits[key] for key in ("samples", "fresh", "above")},
    )


def _fits(rows: Sequence[Mapping[str, Any]]) -> str:
    lines = [
        "| reflectance | p, q, r | r | emphasis | value | seen | value, not grazing | seen | median | 95 % |",
        "|---|---|---|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for row in rows:
        name = row["name"] + (f" over {row['diffuse']:g}" if row["diffuse"] else "")
        sizes = f"{row['p']}, {row['q']}" + (f", {row['r']}" if row["r"] else "")
        third = row["angles"] if row["r"] else ""
        errors = " | ".join(percent(row[k]) for k in ERRORS)
        lines.append(f"| {name} | {sizes} | {third} | {row['emphasis']:g} | {errors} |")
    return "\n".join(lines) + "\n"


def _materials(rows: Sequence[Mapping[str, Any]]) -> str:
    lines = [
        "| material | p, q | scale | texels at 0 | asymmetry | along | across |",
        "|---|---|---|---:|---:|---|---|",
    ]
    for row in rows:
        scale, along, across = (_channels(row[k]) for k in ("scale", "along", "across"))
        sizes, zeros = f"{row['p']}, {row['q']}", row["zeros"]
        lines.append(
            f"| {row['name']} | {sizes} | {scale} | {zeros} | {row['asymmetry']:.0e} | {along} | {across} |"
        )
    return "\n".join(lines) + "\n"


def _channels(values: Sequence[float]) -> str:
    return f"{values[0]:.3g}" if len(set(values)) == 1 else ", ".join(f"{x:.3g}" for x in values)


def _driver(data: Mapping[str, Any]) -> str:
    device, method = data["device"], data["method"]
    rounds, load = method["rounds"][0], data["load_average"]["before"][0]
    lines = [
        "",
        f"**{device['short']}**: {device['api']}; {device['driver']}; {device['device']}; {data['date']}; "
        f"{method['clock']}; {rounds} rounds or more; load {load:.1f}; "
        f"factors fitted to {data['samples']} samples.",
        "",
        "| group | function | maps | throughput, ns | relative | latency, ns | relative | error | largest |",
        "|---|---|---|---:|---:|---:|---:|---:|---:|",
    ]
    for group in data["rivals"]:
        for k, row in enumerate(group["members"]):
            speeds = " | ".join(_speed(row["speed"][mode]) for mode in MODES)
            error = f"{percent(row['error']['rms'])} | {row['error']['largest']:.1e}"
            name = group["name"] if k == 0 else ""
            lines.append(f"| {name} | `{row['function']}` | {row['maps']} | {speeds} | {error} |")
    return "\n".join(lines) + "\n"


def _speed(told: Mapping[str, Any]) -> str:
    low, high = told["net_ns_quartiles"]
    ratio = "" if told["ratio"] is None else f"{told['ratio']:.2f}"
    return f"{told['net_ns']:.1f} [{low:.1f}-{high:.1f}] | {ratio}"


def percent(share: float) -> str:
    """A share in percent, two significant digits."""
    return f"{100.0 * share:.2g} %"
