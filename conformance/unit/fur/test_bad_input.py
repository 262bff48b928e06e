"""What cannot become fur is refused in one clear sentence with exit status 2, and nothing is left behind.

Plan.
  meshes   every kind of unreadable file: cut off, garbage, without positions, with indices or coordinates
           that are none, folders, unknown formats, archives, files that refer to others or announce what no
           memory holds; no sentence names an exception
  scenes   numbers that are not, negative lengths, zero shells, lights and cameras that point nowhere
  output   a folder that cannot be written
"""

import io
import json
import os
import re
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from codegen.cli import run

FURRY = (Path(__file__).parents[3] / "examples" / "scenes" / "furry-bunny.toml").read_text(encoding="utf-8")
NOISE = np.random.default_rng(3).integers(0, 256, 1000).astype(np.uint8).tobytes()
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
FLAT = """ply
format ascii 1.0
element vertex 3
property float x
property float y
element face 1
property list uchar int vertex_indices
end_header
0 0
1 0
0 1
3 0 1 2
"""


def glb(folder: Path, change: Callable[[dict[str, Any]], Any]) -> bytes:
    """A binary glTF of a ball whose description is changed."""
    trimesh.creation.icosphere(subdivisions=0).export(folder / "whole.glb")
    data = (folder / "whole.glb").read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    about, rest = json.loads(data[20 : 20 + length]), data[20 + length :]
    change(about)
    text = json.dumps(about).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A)
    return head + text + rest


def without_positions(about: dict[str, Any]) -> None:
    for mesh in about["meshes"]:
        for primitive in mesh["primitives"]:
            del primitive["attributes"]["POSITION"]


def elsewhere(about: dict[str, Any]) -> None:
    about["buffers"][0]["uri"] = "gone.bin"


def too_long(about: dict[str, Any]) -> None:
    about["bufferViews"][0]["byteLength"] = 10**9


def outside(about: dict[str, Any]) -> None:
    about["buffers"][0]["uri"] = "../../secret"


def endless(about: dict[str, Any]) -> None:
    """A buffer that would never end."""
    about["buffers"][0]["uri"] = "/dev/zero"


def announced(about: dict[str, Any]) -> None:
    """Numbers that are not in the file, which stand for zeros."""
    for accessor in about["accessors"]:
        del accessor["bufferView"]
        accessor["count"] = 10**9


def copied(about: dict[str, Any]) -> None:
    about["nodes"] = [{"mesh": 0} for _ in range(3000)]
    about["scenes"] = [{"nodes": list(range(3000))}]


def crowded(about: dict[str, Any]) -> None:
    about["nodes"] += [{} for _ in range(20_000)]


def compressed(data: str) -> bytes:
    """A mesh in an archive, as some programs hand them over."""
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as file:
        file.writestr("mesh.obj", data)
    return archive.getvalue()


Content = str | bytes | Callable[[Path], bytes] | None
MESHES: dict[str, tuple[Content, str]] = {
    "absent.obj": (None, "there is no such mesh file"),
    "empty.obj": ("", "holds no triangles"),
    "points.obj": ("v 0 0 0\nv 1 0 0\n", "holds no triangles"),
    "words.obj": ("v a b c\nf 1 2 3\n", "cannot be read as a mesh"),
    "outside.obj": (TRIANGLE + "f 1 2 9\n", "cannot be read as a mesh"),
    "before.obj": (TRIANGLE + "f -1 -2 -9\n", "cannot be read as a mesh"),
    "infinite.obj": (TRIANGLE.replace("v 1 0 0", "v inf 0 0"), "has a vertex that is not finite"),
    "flat.obj": (TRIANGLE.replace("v 0 1 0", "v 2 0 0"), "all of its 1 triangles are degenerate"),
    "noise.obj": (NOISE, "cannot be read as a mesh"),
    "noise.ply": (NOISE, "cannot be read as a mesh"),
    "noise.stl": (NOISE, "cannot be read as a mesh"),
    "noise.glb": (NOISE, "cannot be read as a mesh"),
    "flat.ply": (FLAT, 'it lacks "z"'),
    "cut.ply": (lambda folder: cut(folder, "ball.ply"), "cannot be read as a mesh"),
    "cut.glb": (lambda folder: cut(folder, "ball.glb"), "cannot be read as a mesh"),
    "bare.glb": (lambda folder: glb(folder, without_positions), 'it lacks "POSITION"'),
    "long.glb": (lambda folder: glb(folder, too_long), "cannot be read as a mesh"),
    "elsewhere.gltf": (lambda folder: gltf(folder), "it refers to a file that is not there, gone.bin"),
    "outside.gltf": (lambda folder: gltf(folder, outside), "it refers to ../../secret, which lies outside"),
    "endless.gltf": (lambda folder: gltf(folder, endless), "it refers to /dev/zero, which lies outside"),
    "announced.glb": (lambda folder: glb(folder, announced), "its parts have 2e+09 vertices and indices"),
    "copied.glb": (lambda folder: glb(folder, copied), "it is put together of 3000 parts, more than 2048"),
    "crowded.glb": (lambda folder: glb(folder, crowded), "nodes, more than 16384"),
    "many.obj": (
        TRIANGLE + "".join(f"usemtl m{k}\nf 1 2 3\n" for k in range(3000)),
        "it is put together of 3000 parts, more than 2048",
    ),
    "mesh.zip": (compressed(TRIANGLE), "its name ends in none of .obj, .ply, .gltf, .glb, .stl, .off"),
    "mesh.doc": (TRIANGLE, "its name ends in none of .obj, .ply, .gltf, .glb, .stl, .off"),
    "mesh": (TRIANGLE, "its name ends in none of .obj, .ply, .gltf, .glb, .stl, .off"),
}


def cut(folder: Path, name: str) -> bytes:
    trimesh.creation.icosphere(subdivisions=0).export(folder / name)
    data = (folder / name).read_bytes()
    return data[: len(data) // 2]


def gltf(folder: Path, change: Callable[[dict[str, Any]], Any] = elsewhere) -> bytes:
    """A description alone, whose buffer is in a file that is missing, or is changed otherwise."""
    found: list[dict[str, Any]] = []
    glb(folder, found.append)
    change(found[0])
    return json.dumps(found[0]).encode()


@pytest.mark.parametrize("name", MESHES)
def test_a_file_that_is_no_mesh_is_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    content, sentence = MESHES[name]
    data = content(tmp_path) if callable(content) else content
    if data is not None:
        (tmp_path / name).write_bytes(data.encode() if isinstance(data, str) else data)
    said = refused(tmp_path, capsys, FURRY.replace("../data/bunny.obj", name))
    assert f"{tmp_path / name}: " in said and sentence in said
    assert not re.search(r"Error\b|Exception|No module|Traceback", said)


def refused(folder: Path, capsys: pytest.CaptureFixture[str], text: str) -> str:
    """What `vair fur` says of a scene that it refuses."""
    scene = folder / "scene.toml"
    scene.write_text(text, encoding="utf-8")
    assert run(["fur", str(scene), "-o", str(folder / "kit")]) == 2
    said = capsys.readouterr().err.strip()
    assert said and "\n" not in said
    assert not (folder / "kit").exists() and not list(folder.glob(".vair*"))
    return said


def test_a_folder_is_no_mesh(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "folder.obj").mkdir()
    said = refused(tmp_path, capsys, FURRY.replace("../data/bunny.obj", "folder.obj"))
    assert "folder.obj: is a folder, not a mesh file" in said


def test_materials_of_a_mesh_are_not_read(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A pipe that nobody writes would hold a reader for ever."""
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "flat.obj").write_text(
        "mtllib pipe\n" + TRIANGLE.replace("v 0 1 0", "v 2 0 0"), encoding="utf-8"
    )
    said = refused(tmp_path, capsys, FURRY.replace("../data/bunny.obj", "flat.obj"))
    assert "all of its 1 triangles are degenerate" in said


def test_a_pipe_is_no_part_of_a_mesh(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    os.mkfifo(tmp_path / "gone.bin")
    (tmp_path / "mesh.gltf").write_bytes(gltf(tmp_path))
    said = refused(tmp_path, capsys, FURRY.replace("../data/bunny.obj", "mesh.gltf"))
    assert "it refers to a file that is not there, gone.bin" in said


NUMBERS: dict[str, tuple[str, str, str]] = {
    "eye": (
        "eye = [-7.0, 9.5, 24.0]",
        "eye = [nan, 9.5, 24.0]",
        "[render.camera] eye: must be three numbers",
    ),
    "light": ("direction = [-0.9, 0.9, 0.7]", "direction = [0, 0, 0]", "[render.light] direction: must be a"),
    "nan light": ("direction = [-0.9, 0.9, 0.7]", "direction = [nan, 0, 0]", "must be three numbers"),
    "dark light": (
        "[4.6, 4.25, 3.8]",
        "[-1, 1, 1]",
        "[render.light] colour: must be three numbers from 0 to",
    ),
    "endless light": ("[4.6, 4.25, 3.8]", "[inf, 1, 1]", "[render.light] colour: must be three numbers"),
    "nan parameter": (
        '"coat.density" = 700.0',
        '"coat.density" = nan',
        '[parameters] "coat.density": must be',
    ),
    "negative parameter": ('"coat.density" = 700.0', '"coat.density" = -1', "must lie in [0, 1e+09]"),
    "short parameter": ("skin = [0.20, 0.12, 0.10]", "skin = [0.20]", '[parameters] "skin": must be'),
    "combing": ("strength = 1.7", "strength = -1", "[fur.comb] strength: must be a number from 0 to 4"),
    "wind": ("force = [0.0, -0.45, 0.0]", "force = [nan, 0, 0]", "[fur] force: must be three numbers"),
    "coat": ("length = 0.5\nspacing", "length = -0.5\nspacing", "[fur] length: must be a number from 0 to"),
    "spacing": ("spacing = 0.038", "spacing = 0", "[fur] spacing: must be a number from 1e-06 to"),
    "shells": ("layers = 32", "layers = 0", "[fur] layers: must be a whole number from 1 to 256"),
    "half a shell": ("layers = 32", "layers = 2.5", "[fur] layers: must be a whole number from 1 to 256"),
    "seed": ("seed = 7", "seed = -1", "[fur] seed: must be a whole number from 0 to"),
    "size": ("size = [640, 640]", "size = [0, 640]", "[render] size: must be [width, height]"),
    "view": (
        "field_of_view = 27.0",
        "field_of_view = nan",
        "field_of_view: must be a number from 0.1 to 170",
    ),
}


@pytest.mark.parametrize("name", NUMBERS)
def test_a_number_that_is_none_is_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    right, wrong, sentence = NUMBERS[name]
    assert right in FURRY
    assert sentence in refused(tmp_path, capsys, FURRY.replace(right, wrong, 1))


def test_a_folder_that_cannot_be_written_is_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "kit").write_text("a file\n", encoding="utf-8")
    trimesh.creation.icosphere(subdivisions=0).export(tmp_path / "ball.ply")
    scene = tmp_path / "scene.toml"
    text = FURRY.replace("../data/bunny.obj", "ball.ply").replace("subdivide = 1", "subdivide = 0")
    scene.write_text(text.replace("spacing = 0.038", "spacing = 0.2"), encoding="utf-8")
    assert run(["fur", str(scene), "-o", str(tmp_path / "kit")]) == 2
    said = capsys.readouterr().err.strip()
    assert str(tmp_path / "kit") in said and "\n" not in said
    assert (tmp_path / "kit").read_text(encoding="utf-8") == "a file\n"
