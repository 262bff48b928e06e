"""Targets by name: dialects, harnesses, runtimes. Outside the command line only this file loads them."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from codegen.emit.dialect import Dialect
from codegen.errors import UserError, unknown

TARGETS = ("glsl", "wgsl", "opencl")


def dialect(target: str, name: str | None = None) -> Dialect:
    """A dialect by target and name (the target's default if none); raises UserError for unknown names."""
    if target not in TARGETS:
        raise unknown("target", target, TARGETS)
    module: Any = importlib.import_module(f"targets.{target}.dialect")
    dialects: dict[str, Dialect] = module.DIALECTS
    chosen = name or module.DEFAULT
    if chosen not in dialects:
        raise unknown(f"{target} dialect", chosen, dialects)
    return dialects[chosen]


def dialects_of(target: str) -> dict[str, Dialect]:
    """All dialects of a target by name."""
    dialect(target)
    found: dict[str, Dialect] = importlib.import_module(f"targets.{target}.dialect").DIALECTS
    return found


def complete_program(
    target: str,
    library: str,
    body: str,
    version: str | None = None,
    form: str = "plain",
    textures: Sequence[str] = (),
) -> str:
    """A library text and the statements of an entry point as one program; see targets.harness."""
    harness: Any = importlib.import_module("targets.harness")
    options = {} if version is None else {"version": version}
    text: str = harness.complete_program(target, library, body, form=form, textures=textures, **options)
    return text


def texture_data(levels: tuple[Any, ...], repeat_u: bool, repeat_v: bool) -> Any:
    """A map as runtimes take it: targets.textures.TextureData."""
    textures: Any = importlib.import_module("targets.textures")
    return textures.TextureData(levels, repeat_u, repeat_v)


def stage_sources(target: str, what: str) -> dict[str, str]:
    """The texts that stages of fur or strands are made from, by file name.

    errors  UserError for a target without any, which draws none
    """
    package: Any = importlib.import_module(f"targets.{target}")
    folder = Path(package.__file__).parent / what
    if not folder.is_dir():
        raise UserError(f"target {target} draws no {what}; glsl and wgsl do")
    return {
        file.name: file.read_text(encoding="utf-8") for file in sorted(folder.iterdir()) if file.is_file()
    }


def open_runtime(target: str) -> Any:
    """The runtime of a target (targets.protocol.Runtime); raises UserError where it is not available."""
    if target not in TARGETS:
        raise unknown("target", target, TARGETS)
    targets: Any = importlib.import_module("targets")
    try:
        return targets.open_runtime(target)
    except targets.TargetUnavailable as e:
        raise UserError(f"target {target} is not available: {e}") from None
