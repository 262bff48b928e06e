"""The files of the page: those of examples/web, a kit per variant on one mesh, and web.json."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from codegen.errors import UserError
from codegen.fur.kit import BUFFERS
from codegen.fur.shading import fur_shading, member_name
from codegen.library import Library, default_root
from codegen.version import VERSION
from conformance.picture.fur.studio import FurStudio, set_up_fur
from conformance.web.choices import Choices, choices
from conformance.web.figures import figures, misprint, records

EXAMPLES = default_root().parent / "examples"
SCENE = EXAMPLES / "scenes" / "furry-bunny.toml"
PAGE = EXAMPLES / "web"
SERVED = (".html", ".css", ".js", ".vert", ".frag", ".wgsl")
"""Endings of the files of examples/web that belong to the page."""
FORMAT = 1
"""Counts incompatible changes of web.json."""
DIALECTS = {"glsl": ("es300",), "wgsl": ("wgsl",)}
"""What a browser accepts."""


def page_files(
    library: Library, scene: Path | None = None, offered: Choices | None = None
) -> dict[str, bytes]:
    """The files by name, with / between a folder and what lies in it.

    scene    a scene with fur, shaded by a variant of the base; the furry bunny if None
    offered  what can be chosen; all of choices.toml if None
    errors   UserError for a scene without fur, with another shading or with cast shadows, and where
             the page is not installed
    """
    offered = offered or choices()
    files = static_files()
    studio = set_up_fur(library, scene or SCENE, pictured=False)
    check_scene(studio, scene or SCENE, offered)
    for shading in offered.shadings:
        kit = shading_kit(studio, shading.name)
        files[BUFFERS] = kit.pop(BUFFERS)
        files |= {f"shadings/{shading.name}/{name}": data for name, data in kit.items()}
    files["web.json"] = _json(plan(library, offered))
    return files


def check_scene(studio: FurStudio, scene: Path, offered: Choices) -> None:
    """Raises UserError for a scene that the page would show wrongly."""
    needed = {slot.path for slot in fur_shading(studio.library, offered.base).material}
    if {slot.path for slot in studio.shading.material} != needed:
        shaded = studio.shading.function.name
        raise UserError(f"{scene}: is shaded by {shaded}; the page has controls for {offered.base}")
    if studio.picture.shadows:
        raise UserError(
            f"{scene}: the page turns the body under its lights, so [render] shadows must be false"
        )
    values = studio.values("wgsl")
    for parameter in offered.parameters:
        for path in parameter.sets:
            value = np.asarray(values.get(path, values.get(member_name(path))))
            if not np.all((parameter.least <= value) & (value <= parameter.most)):
                span = f"{parameter.least:g} to {parameter.most:g}"
                raise UserError(f"{scene}: {path} is {value.flat[0]:g}; the page has a control for {span}")


def shaded_by(studio: FurStudio, name: str) -> FurStudio:
    """The same scene, shaded by another variant."""
    other = fur_shading(studio.library, name)
    return replace(studio, shading=replace(studio.shading, function=other.function, material=other.material))


def static_files() -> dict[str, bytes]:
    """What is the same for every scene."""
    if not (PAGE / "index.html").is_file():
        raise UserError(f"the page is not here: {PAGE} comes with the repository, not with the package")
    return {path.name: path.read_bytes() for path in sorted(PAGE.iterdir()) if path.suffix in SERVED}


def shading_kit(studio: FurStudio, name: str) -> dict[str, bytes]:
    """The kit of one variant as `vair fur` writes it, in a browser's dialects, with one mesh for all kits."""
    kit = shaded_by(studio, name).kit(DIALECTS)
    about = json.loads(kit["fur.json"])
    about["buffers"]["file"] = f"../../{BUFFERS}"
    return kit | {"fur.json": _json(about)}


def plan(library: Library, offered: Choices) -> dict[str, Any]:
    """web.json: what can be chosen, and what was measured of it."""
    shadings = []
    for shading in offered.shadings:
        described = asdict(shading) | {
            "kit": f"shadings/{shading.name}/fur.json",
            "recorded": figures(library, shading),
        }
        if shading.formulas == "printed":
            described["misprint"] = misprint(offered)
        shadings.append(described)
    return {
        "format": FORMAT,
        "generator": f"Vair {VERSION}",
        "base": offered.base,
        "shadings": shadings,
        "parameters": [asdict(parameter) for parameter in offered.parameters],
        "records": records(),
    }


def _json(content: Any) -> bytes:
    return (json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n").encode("utf-8")
