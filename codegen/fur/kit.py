"""Everything an engine needs to draw fur, as files: stages, pass states, layouts, buffers, values.

fur.json describes the others. Nothing in it differs between machines.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from codegen.fur.coat import FurMesh
from codegen.fur.layout import Block
from codegen.fur.shading import FurShading
from codegen.fur.stages import DIALECTS, STAGES, stage_texts
from codegen.fur.states import pass_states
from codegen.library import Library
from codegen.version import VERSION

FORMAT = 1
"""Counts incompatible changes of fur.json."""
BUFFERS = "fur.bin"


def kit_files(
    library: Library,
    shading: FurShading,
    block: Block,
    mesh: FurMesh,
    frame: Mapping[str, Any],
    matrices: Mapping[str, Any],
    scene: Mapping[str, Any],
    dialects: Mapping[str, tuple[str, ...]] = DIALECTS,
) -> dict[str, bytes]:
    """The files by name.

    frame     values by member of the uniform block, without view_projection
    matrices  view_projection by graphics interface, "opengl" and "webgpu", column by column
    scene     what the scene is called, its camera, how many layers it has, whether it has fins
    dialects  by target, those in which the stages are written
    """
    files = {}
    for target, chosen in dialects.items():
        for dialect in chosen:
            for name, text in stage_texts(library, shading, target, dialect).items():
                files[_file_name(name, dialect)] = text.encode("utf-8")
    arrays = {
        "vertices": mesh.vertices,
        "triangles": mesh.triangles,
        "fin_vertices": mesh.fin_vertices,
        "fin_triangles": mesh.fin_triangles,
    }
    files[BUFFERS] = b"".join(np.ascontiguousarray(array).tobytes() for array in arrays.values())
    manifest = {
        "format": FORMAT,
        "generator": f"Vair {VERSION}",
        "scene": dict(scene),
        "shading": {
            "function": shading.function.name,
            "material": {s.path: s.name for s in shading.material},
        },
        "passes": _passes(mesh, int(scene["layers"]), bool(scene["fins"]), dialects.get("glsl", ())),
        "buffers": {"file": BUFFERS, **_buffers(arrays)},
        "uniforms": _uniforms(block, frame),
        "view_projection": {name: _plain(matrix) for name, matrix in matrices.items()},
        "mesh": mesh.findings,
    }
    files["fur.json"] = (json.dumps(manifest, indent=1, allow_nan=False) + "\n").encode("utf-8")
    return files


def _file_name(name: str, dialect: str) -> str:
    """shell.vert of dialect es300 is shell-es300.vert; a WGSL module has one dialect."""
    stem, _, extension = name.rpartition(".")
    return name if dialect == extension else f"{stem}-{dialect}.{extension}"


def _passes(mesh: FurMesh, layers: int, fins: bool, glsl: tuple[str, ...]) -> list[dict[str, Any]]:
    """The draw calls in order, with the states of the lecture."""
    states = pass_states(closed=mesh.findings["border edges"] == 0)
    instances = {"base": 1, "shell": layers - 1, "fin": int(fins and layers > 1)}
    files = {
        stage: {
            dialect: [_file_name(f"{stage}.{kind}", dialect) for kind in ("vert", "frag")] for dialect in glsl
        }
        for stage in STAGES
    }
    return [
        {
            "name": stage,
            "glsl": files[stage],
            "wgsl": {"file": "fur.wgsl", "vertex": f"{stage}_vertex", "fragment": f"{stage}_fragment"},
            "vertices": "fin_vertices" if stage == "fin" else "vertices",
            "triangles": "fin_triangles" if stage == "fin" else "triangles",
            "instances": instances[stage],
            "state": states[stage],
        }
        for stage in STAGES
        if instances[stage] > 0
    ]


def _buffers(arrays: Mapping[str, Any]) -> dict[str, Any]:
    described: dict[str, Any] = {}
    at = 0
    for name, array in arrays.items():
        entry: dict[str, Any] = {"offset": at, "bytes": array.nbytes}
        if array.dtype.fields:
            entry |= {
                "count": len(array),
                "stride": array.dtype.itemsize,
                "attributes": [
                    {"name": key, "location": k, "offset": int(field[1]), "floats": field[0].itemsize // 4}
                    for k, (key, field) in enumerate(array.dtype.fields.items())
                ],
            }
        else:
            entry |= {"count": int(array.size), "type": "uint32"}
        described[name] = entry
        at += array.nbytes
    return described


def _uniforms(block: Block, frame: Mapping[str, Any]) -> dict[str, Any]:
    members = []
    for member in block.members:
        entry: dict[str, Any] = {"name": member.name, "type": member.type, "offset": member.offset}
        if member.count > 1:
            entry |= {"count": member.count, "stride": member.stride}
        if member.name in frame:
            entry["value"] = _plain(frame[member.name], member.kind)
        members.append(entry)
    return {"block": "FurFrame", "binding": 0, "bytes": block.size, "members": members}


def _plain(value: Any, kind: str = "<f4") -> Any:
    """Numbers as JSON holds them: the shortest decimals that read back as the same 32 bits."""
    array = np.asarray(value, kind)
    if kind != "<f4":
        return array.tolist() if array.size != 1 else int(array.reshape(-1)[0])
    texts = [float(str(x)) for x in array.reshape(-1)]
    return texts[0] if array.size == 1 else texts
