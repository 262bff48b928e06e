"""`vair verify`: vendored files against their lock and against this version."""

from __future__ import annotations

import importlib
import json
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import click
import numpy as np

from codegen.commands.progress import progress
from codegen.commands.vendor import NO_DRIVERS, planned, runtime
from codegen.errors import UserError
from codegen.files import write_text
from codegen.half import half_forms, has_half
from codegen.library import Library, load_library
from codegen.scene.proof.points import SEED, draw
from codegen.vendor.changes import changes
from codegen.vendor.exclusive import exclusive
from codegen.vendor.execution import Execution, Inputs
from codegen.vendor.lock import NAME, Lock, read_lock
from codegen.vendor.plan import Plan, dialect_of
from codegen.vendor.report import Finding, as_data, lines
from codegen.vendor.scene_plan import ScenePlan
from codegen.vendor.state import held, states
from codegen.version import VERSION

UNIFORM_POINTS = 4096
HARD_POINTS = 1024
"""Of each family of hard cases that fits a function."""


@click.command("verify")
@click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@click.option("--json", "json_file", type=click.Path(path_type=Path), help="Write what was found as JSON.")
@click.option("--no-drivers", is_flag=True, help="Execute nothing; say only which functions changed.")
def command(folder: Path, json_file: Path | None, no_drivers: bool) -> int:
    """Say whether vendored files were edited or are stale, and what changes in value with an update.

    Functions whose code differs are executed, old and new, on this machine's drivers over the points that
    conformance draws for them. Exit status 1 where anything differs.
    """
    if not folder.is_dir():
        raise UserError(f'"{folder}": there is no such folder')
    library = load_library()
    with exclusive(folder):
        lock = read_lock(folder / NAME)
        vendored = {name: data for name in lock.files if (data := held(folder, name)) is not None}
    plan = planned(library, _known(lock, library).options, folder, drivers=False)
    old, new = (
        _by_dialect(lock, vendored),
        _by_dialect(plan.lock, {n: t.encode() for n, t in plan.files.items()}),
    )
    with progress("comparing") as say:
        found = changes(lock, plan.lock, old, new, _execution(plan, not no_drivers, say).compare)
    finding = Finding(str(folder), lock.version, VERSION, states(folder, lock, plan.files), found)
    if json_file is not None:
        write_text(json_file, json.dumps(as_data(finding), indent=1, allow_nan=False) + "\n")
    for line in lines(finding):
        click.echo(line)
    return 0 if finding.clean else 1


def _known(lock: Lock, library: Library) -> Lock:
    """The lock without functions that this version has no more: these are reported as removed."""
    half = lock.options.half
    known = tuple(
        name
        for name in lock.options.functions
        if library.resolver.defines(name) and (not half or has_half(library, name))
    )
    if lock.options.functions and not known:
        raise UserError("none of the vendored functions is one of this version")
    return replace(lock, options=replace(lock.options, functions=known))


def _by_dialect(lock: Lock, files: dict[str, bytes]) -> dict[str, list[str]]:
    """Texts by dialect, without what is missing."""
    found: dict[str, list[str]] = {name: [] for name in lock.options.dialects}
    for name in sorted(lock.files):
        texts = found[dialect_of(lock.options, name)]
        if name in files:
            texts.append(files[name].decode("utf-8", "replace"))
    return found


def _execution(plan: Plan, drivers: bool, say: Callable[[str], None]) -> Execution:
    cases: Any = importlib.import_module("conformance.cases")
    targets: Any = importlib.import_module("targets")
    function = plan.library.function

    @cache
    def points(name: str) -> Inputs | str:
        if isinstance(plan, ScenePlan):
            outcome = plan.outcome
            drawn = draw(outcome.scene, outcome.general, UNIFORM_POINTS, SEED + 2)
            return {p.name: drawn.inputs[p.name] for p in function(name).parameters}
        if function(name).reads_textures:
            return "reads maps, for which no inputs are drawn; its code changed"
        if plan.lock.options.half:
            form = half_forms(plan.library)[name]
            survey: Any = importlib.import_module("conformance.half.survey")
            sample = survey.half_sample(plan.library, function(name), form.single, form.where)
            return {key: _first(value) for key, value in sample.inputs.items()}
        families = {family: HARD_POINTS for family in cases.families_for(function(name).parameters)}
        parts = [
            cases.draw(function(name), f, n) for f, n in {cases.UNIFORM: UNIFORM_POINTS, **families}.items()
        ]
        return {key: _joined([part[key] for part in parts]) for key in parts[0]}

    def told(name: str, inputs: Inputs, lane: int) -> str:
        text: str = cases.words(function(name), inputs, lane)
        return text

    return Execution(
        library=plan.library,
        prefix=plan.lock.options.prefix,
        precision="half" if plan.lock.options.half else "single",
        runtimes=cache(runtime if drivers else lambda target: NO_DRIVERS),
        draw=points,
        told=told,
        refusal=targets.BuildFailed,
        say=say,
    )


def _first(value: Any) -> Any:
    """As many points as are drawn at random otherwise."""
    if isinstance(value, dict):
        return {key: _first(part) for key, part in value.items()}
    return value[:UNIFORM_POINTS]


def _joined(parts: list[Any]) -> Any:
    if isinstance(parts[0], dict):
        return {key: _joined([part[key] for part in parts]) for key in parts[0]}
    return np.concatenate(parts)
