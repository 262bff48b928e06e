"""What `vair scene` wrote about a scene, as a table of figures before and after."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from codegen.documents import read_json
from codegen.errors import UserError
from codegen.library import default_root
from conformance.bench.record import short_name
from conformance.bench.run import ONE_THREAD
from targets import Device

SCHEMA = 1
COLUMNS = (
    "Target",
    "Driver",
    "Operations",
    "Lines",
    "SPIR-V instructions",
    "ns per evaluation",
    "Time",
    "Error in half steps",
    "Predicted",
)
DAMAGED = (ArithmeticError, AttributeError, IndexError, KeyError, TypeError, ValueError)
"""What a report raises whose values are others than vair scene writes."""
DASH = "\u2013"


def figures_of(path: Path, folder: Path) -> dict[str, Any]:
    """The figures of a scene: of what vair scene wrote before, or writes now for a scene file.

    path    a scene file (.toml), a folder that vair scene wrote, or its report.json
    folder  where a scene file's result goes, below scenes/
    """
    if path.suffix != ".toml":
        return read_scene_report(path)
    written = folder / "scenes" / path.stem
    written.mkdir(parents=True, exist_ok=True)
    done = subprocess.run(
        [sys.executable, "-m", "codegen.cli", "scene", str(path.resolve()), "-o", str(written.resolve())],
        cwd=default_root().parent,
        env={**os.environ, **ONE_THREAD},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["it said nothing"])[-1]
        raise UserError(f"vair scene {path}: {last.removeprefix('vair: ')}")
    return read_scene_report(written)


def read_scene_report(path: Path) -> dict[str, Any]:
    """The figures of one scene; raises UserError for a path without a report of vair scene.

    path  a folder that vair scene wrote, or its report.json
    """
    file = path / "report.json" if path.is_dir() else path
    try:
        data = read_json(file)
    except UserError as e:
        raise UserError(f"{e}; vair scene writes a report.json into its folder") from None
    if not isinstance(data, dict) or data.get("schema") != SCHEMA or "scene" not in data:
        raise UserError(f'"{file}" is no report of vair scene of schema {SCHEMA}')
    try:
        return _figures(data)
    except DAMAGED as e:
        raise UserError(f'"{file}" is damaged: it lacks or misspells {e}') from None


def _figures(data: Mapping[str, Any]) -> dict[str, Any]:
    scene, parameters = data["scene"], data["parameters"]
    return {
        "name": scene["name"],
        "note": f"{scene['model']}, budget {scene['budget_stated']}: "
        f"{len(parameters['before'])} parameters before, {len(parameters['left'])} after.",
        "columns": list(COLUMNS),
        "rows": [_row(target) for target in data["targets"]],
    }


def _row(target: Mapping[str, Any]) -> list[str]:
    """One target: figures of the general function, an arrow, those of the specialised one."""
    speed = target.get("speed") or {}
    times = {name: s["ns"] for name, s in speed.items() if isinstance(s, Mapping)}
    operations = {name: counts["all"] for name, counts in (target.get("operations") or {}).items()}
    return [
        target["target"],
        _driver(target),
        _change(operations),
        _change(target.get("lines")),
        _change(target.get("spirv_instructions")),
        _change(times),
        _short(speed.get("ratio")),
        _short((target.get("proof") or {}).get("error", {}).get("half_steps_8bit")),
        _short((target.get("predicted") or {}).get("half_steps_8bit")),
    ]


def _driver(target: Mapping[str, Any]) -> str:
    """The driver as people call it; vair scene writes device, driver and interface."""
    if not target.get("executed"):
        return "not executed"
    device, driver, api = [*str(target.get("driver") or DASH).split("; ", 2), "", ""][:3]
    return short_name(Device(target["target"], api, driver, device))


def _change(values: Mapping[str, float] | None) -> str:
    """First and last of the stages, such as 228 \u2192 96."""
    told = [v for v in (values or {}).values() if v is not None]
    return f"{_short(told[0])} \u2192 {_short(told[-1])}" if len(told) > 1 else DASH


def _short(value: float | None) -> str:
    if value is None:
        return DASH
    return f"{value:.0f}" if isinstance(value, int) or abs(value) >= 100.0 else f"{value:.2g}"
