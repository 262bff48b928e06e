"""Files that a person writes or keeps: scenes, and the lock of a vendored folder."""

from __future__ import annotations

import functools
import os
import shutil
from pathlib import Path

from codegen.library import load_library
from codegen.scene.description.document import read_scene
from codegen.vendor.install import install
from codegen.vendor.lock import NAME, read_lock
from codegen.vendor.options import Options
from codegen.vendor.plan import Plan, plan_functions
from codegen.vendor.state import UNFINISHED, states
from conformance.fuzz_parsers.parser import Parser, toml_parser
from conformance.picture import scene as picture_scene

SCENES = Path(__file__).parents[2] / "examples" / "scenes"


def scene() -> Parser:
    """[scene] [shade] [parameters] [view] [lights], as `vair scene` reads them."""
    library = load_library()
    return toml_parser("own.toml", lambda path: read_scene(path, library), _scenes())


def picture() -> Parser:
    """The same with [render], [fur] and [strands], as `vair render` and `vair fur` read them."""
    return toml_parser("own.toml", picture_scene.read_scene, _scenes())


def _scenes() -> list[str]:
    return [path.read_text(encoding="utf-8") for path in sorted(SCENES.glob("*.toml"))]


@functools.cache
def _plan() -> Plan:
    return plan_functions(load_library(), Options(("wgsl/wgsl",), ("sin_angle",), per_function=True))


def lock() -> Parser:
    """vair.lock: read, held against its folder, then replaced; and that of an interrupted set."""
    plan = _plan()
    other = plan_functions(load_library(), Options(("glsl/430",), ("sin_angle",)))
    parts = sorted({Path(name).parent for name in plan.files})

    def laid_out(folder: Path) -> None:
        """What installing the plan into a new folder gives."""
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        for part in parts:
            (folder / part).mkdir(exist_ok=True)
        for name, text in plan.files.items():
            (folder / name).write_text(text)

    def read(path: Path) -> object:
        found = read_lock(path)
        folder = path.parent / "vendored"
        laid_out(folder)
        os.symlink(path.parent.parent, folder / "elsewhere")
        (folder / UNFINISHED).mkdir()
        for name, text in other.files.items():
            (folder / UNFINISHED / name).write_text(text)
        for place in (folder, folder / UNFINISHED):
            shutil.copyfile(path, place / NAME)
        states(folder, found, plan.files)
        install(folder, plan, force=True)
        return found

    return toml_parser("given.lock", read, [plan.lock_text, other.lock_text])
