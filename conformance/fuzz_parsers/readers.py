"""The modules whose code reads what each reader is given: followed by coverage, and told apart by a hash.

Their imports are not followed: what they share with the rest of the program reads no files of users. Nothing
here imports them, so that they are instrumented before anything else does.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

ROOT = Path(__file__).parents[2]

PACKAGES = ("codegen", "conformance")
SHARED = ("codegen.documents", "codegen.errors")
SCENE = ("codegen.scene.description",)
CHECK = ("merge", "replay", "result", "failure", "interval", "accuracy", "identity", "shard")
MESH = ("codegen.fur.surface", "codegen.fur.meshfile")
VENDOR = ("lock", "options", "install", "state", "exchange", "exclusive")

MODULES: dict[str, tuple[str, ...]] = {
    "scene": (*SCENE, *SHARED),
    "picture": (
        "conformance.picture.scene",
        "conformance.picture.brush",
        "conformance.picture.fur.settings",
        "conformance.picture.strands.settings",
        *SCENE,
        *SHARED,
    ),
    "lock": (*(f"codegen.vendor.{name}" for name in VENDOR), *SHARED),
    "results": (*(f"conformance.check.{name}" for name in CHECK), "conformance.cases.found", *SHARED),
    "kit": ("codegen.kit.results", "codegen.kit.rows", *SHARED),
    "kit_npz": ("codegen.kit.results", "codegen.kit.rows", *SHARED),
    "report": ("conformance.report.model", "conformance.report.agreement", *SHARED),
    "scene_report": ("conformance.report.scenes", *SHARED),
    "waterloo": ("codegen.factors.waterloo", "codegen.maps.image", *SHARED),
    "samples": ("codegen.factors.samples", *SHARED),
    "samples_npz": ("codegen.factors.samples", *SHARED),
    "factors": ("codegen.factors.maps", "codegen.maps.image", *SHARED),
    "table": ("codegen.tables.stored", "codegen.maps.image", *SHARED),
    "image": ("codegen.maps.image", *SHARED),
    "mesh": (*MESH, *SHARED),
    "mesh_ply": (*MESH, *SHARED),
    "mesh_gltf": (*MESH, *SHARED),
    "mesh_glb": (*MESH, *SHARED),
    "mesh_stl": (*MESH, *SHARED),
    "mesh_off": (*MESH, *SHARED),
    "strands": ("codegen.strands.tfx", *SHARED),
    "line_map": ("codegen.lines.linemap", "codegen.lines.where", *SHARED),
    "compiler_log": ("codegen.lines.linemap", "codegen.lines.where", *SHARED),
}
"""Reader -> modules, or packages with all that is in them."""


def sources(name: str) -> list[Path]:
    """The files of a reader's modules, in order."""
    found = []
    for module in MODULES[name]:
        place = ROOT / Path(*module.split("."))
        found += sorted(place.rglob("*.py")) if place.is_dir() else [place.with_suffix(".py")]
    return found


def others(name: str) -> list[str]:
    """All other modules of the packages that a reader's modules are in."""
    own = set(sources(name))
    files = (
        path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py")) if path not in own
    )
    parts = [path.relative_to(ROOT).with_suffix("").parts for path in files]
    return [".".join(part[:-1] if part[-1] == "__init__" else part) for part in parts]


def code_hash(name: str) -> str:
    """16 digits that change with the text of a reader's modules."""
    digest = hashlib.sha256()
    for path in sources(name):
        digest.update(f"{path.relative_to(ROOT).as_posix()}\n".encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
