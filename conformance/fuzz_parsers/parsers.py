"""What is fuzzed: readers of files that a person or another program hands over, and files to start from."""

from __future__ import annotations

import functools
import json
import os
import shutil
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from codegen.errors import UserError
from codegen.factors.samples import read_samples
from codegen.factors.waterloo import read_waterloo
from codegen.fur.surface import load_mesh
from codegen.kit.results import read_results
from codegen.kit.vectors import FORMAT
from codegen.library import load_library
from codegen.maps.image import png
from codegen.scene.description.document import read_scene
from codegen.vendor.install import install
from codegen.vendor.lock import NAME, read_lock
from codegen.vendor.options import Options
from codegen.vendor.plan import Plan, plan_functions
from codegen.vendor.state import UNFINISHED, states
from codegen.version import VERSION
from conformance.check.merge import merge
from conformance.check.replay import from_record, records
from conformance.fuzz_parsers.documents import as_json, as_toml
from conformance.picture import scene as picture_scene

ROOT = Path(__file__).parents[2]
SCENES = ROOT / "examples" / "scenes"
SEEDS = Path(__file__).parent / "seeds"


@dataclass(frozen=True)
class Parser:
    """A reader under test.

    file   the name that its files have
    read   what is called with the path; UserError is its only way out
    seeds  files to start from
    trees  the same parsed, where they are TOML or JSON
    write  a tree as text; None where there are none
    """

    file: str
    read: Callable[[Path], object]
    seeds: tuple[bytes, ...]
    trees: tuple[Any, ...] = ()
    write: Callable[[Any], str] | None = field(default=None)


def toml_parser(file: str, read: Callable[[Path], object], texts: list[str]) -> Parser:
    """A parser of TOML."""
    return Parser(file, read, tuple(t.encode() for t in texts), tuple(map(tomllib.loads, texts)), as_toml)


def json_parser(file: str, read: Callable[[Path], object], trees: list[Any]) -> Parser:
    """A parser of JSON."""
    return Parser(file, read, tuple(as_json(t).encode() for t in trees), tuple(trees), as_json)


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

    def read(path: Path) -> object:
        found = read_lock(path)
        folder = path.parent / "vendored"
        shutil.rmtree(folder, ignore_errors=True)
        install(folder, plan)
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


def results() -> Parser:
    """What `vair check --json` wrote, as --merge and --replay read it."""
    library = load_library()
    whole = json.loads((SEEDS / "results.json").read_text(encoding="utf-8"))

    def read(path: Path) -> object:
        refused = None
        try:
            merge([path])
        except UserError as e:
            refused = e
        for record in records(path):
            from_record(library, path, record)
        if refused is not None:
            raise refused
        return None

    return json_parser("results.json", read, [whole, whole["results"][0]["failures"]])


def kit() -> Parser:
    """Results of somebody else's backend, as `vair check --results` reads them."""
    library = load_library()
    words = ["3f800000", 1.0, 0, "nan"]
    about = {
        "kit": {
            "format": FORMAT,
            "version": VERSION,
            "lanes": 4,
            "family": 4,
            "functions": ["sin_angle", "frame_from_normal"],
        },
        "target": "glsl",
        "driver": "own",
        "functions": {
            "sin_angle": {"vectors": "x", "rows": [words]},
            "frame_from_normal": {"vectors": "y", "failed": "no"},
        },
    }
    return json_parser("results.json", lambda path: read_results(library, path), [about])


def waterloo() -> Parser:
    """A factored material: NAME.txt beside its images, which are there, and as the older `alpha`."""
    image = png(np.full((4, 4, 3), 0.5))

    def read(path: Path) -> object:
        for k in (0, 1):
            picture = path.with_name(f"{path.stem}_{k}.png")
            if not picture.exists():
                picture.write_bytes(image)
        return read_waterloo(path)

    seeds = (b"velvet\n0\n0.5 0.4 0.3\n1.5\n", b"satin\n0\n1 1 1\n", b"\xff\xfe\n0\n1e400 nan -1\n")
    return Parser("velvet.txt", read, seeds)


def samples() -> Parser:
    """Samples of a reflectance as .csv."""
    rows = ["0,0,1,0,0,1,0.5", "0.6,0,0.8,0,0.6,0.8,0.25", "0,0,1,0.6,0,0.8,"] * 60
    single = "l.x,l.y,l.z,v.x,v.y,v.z,value\n" + "\n".join(rows)
    colours = "l.x,l.y,l.z,v.x,v.y,v.z,r,g,b\n" + "\n".join(f"{row},1,1" for row in rows)
    return Parser("own.csv", read_samples, (single.encode(), colours.encode(), b"l.x,v.x\n"))


def mesh() -> Parser:
    """A mesh as .obj."""
    box = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\n"
    seeds = (
        box + "f 1 2 3\nf 1 3 4\nf 1/1/1 2/1/1 4/1/1\nf 2 3 4\n",
        box + "g one\nusemtl a\nf 1 2 3 4\ns off\no two\nf -1 -2 -3\n",
        "# nothing\nmtllib x.mtl\nv 0 0\nf 1 2\n",
    )
    return Parser("own.obj", load_mesh, tuple(seed.encode() for seed in seeds))


PARSERS: dict[str, Callable[[], Parser]] = {
    f.__name__: f for f in (scene, picture, lock, results, kit, waterloo, samples, mesh)
}
"""Made when asked for: some need the library."""
