"""Scene files as data: what is shaded, what is known of its parameters, directions and lights.

The tables [scene], [shade], [parameters], [view] and [lights] are read here; [render] and [fur], which only a
picture needs, are left to whoever draws one. examples/scenes/README.md lists every key.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from codegen import names
from codegen.backends import TARGETS, dialect
from codegen.errors import Place, SourceError, UserError, nearest
from codegen.library import Library
from codegen.scene.description.lights import Lights, read_lights
from codegen.scene.description.model import Model, find_model
from codegen.scene.description.settings import Setting, read_settings
from codegen.scene.description.tables import Table, read_tables, show
from codegen.scene.description.view import Facts, read_facts

TABLES = ("scene", "shade", "parameters", "view", "lights", "render", "fur", "strands")
HALF_STEP = 1.0 / 510.0
BUDGETS = {"exact": 0.0, "quarter-step-8bit": 0.5 * HALF_STEP, "half-step-8bit": HALF_STEP}
"""Named budgets: the largest absolute error of the shaded value. An 8-bit step is 1/255; rounding to the
nearest step hides half of one."""


@dataclass(frozen=True)
class Scene:
    """A scene file that has been read and checked against the library.

    name         of the scene, for people
    function     of the result
    dialects     dialect by target, in the order in which files are written
    budget       largest absolute error; 0: exact passes only
    budget_text  as the file states it
    model        the shading function and its parameters
    settings     what is known of parameters, by path
    facts        what is known of directions: ranges of cosines by pairs of names
    """

    path: Path
    name: str
    function: str
    dialects: dict[str, str]
    budget: float
    budget_text: str
    model: Model
    settings: dict[str, Setting]
    facts: Facts
    lights: Lights = field(default_factory=Lights)


def read_scene(path: Path, library: Library) -> Scene:
    """Read a scene file; paths in it are relative to its folder. Raises UserError with one sentence."""
    tables = read_tables(path, TABLES)
    scene, shade = tables["scene"], tables["shade"]
    name = scene.text("name", path.stem)
    stated = scene.number_or_name("budget", BUDGETS, 0.0, 1e6, "exact")
    budget, budget_text = (BUDGETS[stated], stated) if isinstance(stated, str) else (stated, show(stated))
    dialects = _dialects(scene)
    model = find_model(library, shade)
    function = _function_name(shade, name, library)
    scene.close()
    shade.close()
    lights = read_lights(tables["lights"], model)
    settings = read_settings(tables["parameters"], model, lights)
    facts = read_facts(tables["view"], model, settings)
    return Scene(path, name, function, dialects, budget, budget_text, model, settings, facts, lights)


def _dialects(table: Table) -> dict[str, str]:
    targets = table.choices("targets", "target", TARGETS)
    wanted = table.table("dialects")
    for target in wanted.content:
        if target not in targets:
            raise wanted.error(target, f"is no target of this scene{nearest(target, targets)}")
    chosen = {}
    for target in targets:
        try:
            chosen[target] = dialect(target, wanted.content.get(target)).name
        except UserError as e:
            raise wanted.error(target, str(e)) from None
    return chosen


def _function_name(shade: Table, name: str, library: Library) -> str:
    """The name of the result: stated, or made of the scene's name."""
    given = "function" in shade
    slug = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_") or "scene"
    function = shade.text("function", f"{slug if slug[0].isalpha() else 'scene_' + slug}_shade")
    if not re.fullmatch(r"[a-z][a-z0-9_]*", function) or function in library.resolver.names:
        why = "is a name of the library" if function in library.resolver.names else "must be snake_case"
        key = "function" if given else "function (made of the scene's name)"
        raise shade.error(key, f'"{function}" {why}')
    try:
        names.check(function, "function", Place(str(shade.path), 1))
    except SourceError as e:
        raise shade.error("function", e.sentence) from None
    return function
