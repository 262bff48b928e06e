"""A scene to the files that would be written now, with their lock."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from codegen.backends import dialect
from codegen.emit.definition import Definition
from codegen.emit.dialect import Dialect, file_name
from codegen.emit.frame import file_text
from codegen.errors import UserError
from codegen.library import Library
from codegen.scene.build import Builder, Outcome
from codegen.scene.description.document import Scene, read_scene
from codegen.scene.report.text import documented, included
from codegen.vendor.lock import Promise
from codegen.vendor.options import Options, key
from codegen.vendor.plan import Plan, locked


@dataclass(frozen=True)
class ScenePlan(Plan):
    """The plan of a scene, and what its points are drawn from."""

    outcome: Outcome


def plan_scene(
    library: Library,
    options: Options,
    folder: Path,
    open_runtime: Callable[[str], Any],
    say: Callable[[str], None] = lambda sentence: None,
) -> ScenePlan:
    """The files for a scene.

    folder        what options.scene is relative to
    open_runtime  target -> its runtime, or the reason why there is none

    raises  UserError where the scene is wrong, or its function cannot be proven
    """
    # The folder may not be there yet, and be reached by a link: ".." is followed from where it really is.
    path = Path(os.path.relpath(os.path.normpath(folder.resolve() / options.scene)))
    scene = read_scene(path, library)
    chosen = options.found_dialects()
    scene = replace(scene, dialects={d.target: d.name for d in reversed(chosen)})
    runtimes = {target: open_runtime(target) for target in scene.dialects}
    outcome = Builder(library, scene, runtimes, timed=False, say=say).build()
    files: dict[str, str] = {}
    parts: dict[str, tuple[Dialect, Sequence[Definition]]] = {}
    for result in outcome.targets:
        final = documented(scene, outcome.general, result.reduced)
        extended = library.with_functions([final])
        for d in (d for d in chosen if d.target == result.target):
            one = replace(scene, dialects={d.target: d.name})
            emitted, head, defined = included(library, one, outcome.general, result.reduced, options.prefix)
            name = file_name(d, scene.function)
            files[name], parts[name] = file_text(emitted, head, defined), (emitted, defined)
    lock = locked(extended, options, extended.select([scene.function]), files)
    told = lock.functions[scene.function]
    errors = (final.doc.entries["error"],)
    promised = {scene.function: Promise(told.signature, errors, told.source)}
    return ScenePlan(replace(lock, functions=promised), files, extended, parts, outcome)


def scene_dialects(path: Path, library: Library, chosen: Sequence[str]) -> tuple[str, ...]:
    """The dialects that a scene asks for, or the chosen ones, whose targets must be its own."""
    scene: Scene = read_scene(path, library)
    if not chosen:
        return tuple(key(dialect(target, name)) for target, name in scene.dialects.items())
    own: Mapping[str, str] = scene.dialects
    for name in chosen:
        if name.partition("/")[0] not in own:
            raise UserError(
                f"{path}: {name.partition('/')[0]} is no target of this scene; it has {', '.join(own)}"
            )
    return tuple(chosen)
