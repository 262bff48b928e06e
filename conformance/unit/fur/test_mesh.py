"""Fur grows on any mesh that is one, and what is odd about a mesh is counted.

Plan.
  reading   closed (the bunny), open, non-manifold, with degenerate and doubled faces, with normals that
            cancel, in OBJ, PLY and glTF; what cannot bear fur is refused in one sentence
  normals   unit, finite, outward
  charts    one scale, no stretch beyond a bound, the same charts again
  shells    where charts meet, vertices differ in nothing but uv
  fins      one quad per edge; both face normals; uv along the edge; w = 0, 1, 1, 0
  combing   tangential, of the stated strength
  painting  vertex colours scale length and density
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from codegen.errors import UserError
from codegen.fur.charts import cut_charts
from codegen.fur.coat import Combing, FurMesh, comb_field, grow
from codegen.fur.edges import find_edges
from codegen.fur.surface import Surface, face_normals, read_surface, subdivided
from conformance.picture.tolerances import tolerance

BUNNY = Path(__file__).parents[3] / "examples" / "data" / "bunny.obj"
SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"
THREE_AT_AN_EDGE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n"


def written(folder: Path, text: str, name: str = "mesh.obj") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def bunny() -> FurMesh:
    return grow(BUNNY, spacing=0.1, combing=Combing((0.0, -1.0, 0.0), 0.5))


def test_the_bunny_is_closed(bunny: FurMesh) -> None:
    findings = bunny.findings
    assert findings["triangles in the file"] == findings["triangles"] == 3674
    assert findings["border edges"] == findings["edges between more than two triangles"] == 0
    assert (
        findings["degenerate or doubled triangles left out"] == findings["vertices whose normals cancel"] == 0
    )
    # Every triangle of a closed surface has three edges, every edge two triangles.
    assert findings["fins"] == 3674 * 3 // 2


def test_normals_are_unit_and_point_outward(bunny: FurMesh) -> None:
    vertices = bunny.vertices
    length = np.linalg.norm(vertices["normal"].astype(np.float64), axis=1)
    assert np.abs(length - 1.0).max() < tolerance("unit_length")
    corners = vertices["position"][bunny.triangles].astype(np.float64)
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6.0
    assert volume > 0.0
    facing = np.einsum(
        "ij,ij->i", vertices["normal"][bunny.triangles[:, 0]], _face_normals(bunny).astype(np.float32)
    )
    assert (facing > 0.0).mean() > tolerance("fur_facing_share")


def _face_normals(mesh: FurMesh) -> np.ndarray:
    return face_normals(mesh.vertices["position"].astype(np.float64), mesh.triangles.astype(np.int64))


def test_vertices_where_charts_meet_differ_in_uv_only(bunny: FurMesh) -> None:
    fields = ["position", "normal", "comb", "length_share", "density_share"]
    together = np.unique(bunny.vertices["position"], axis=0)
    kinds = np.unique(np.column_stack([bunny.vertices[name] for name in fields]), axis=0)
    assert len(together) == len(kinds) == 1839 < len(bunny.vertices)


def test_charts_have_one_scale_and_little_stretch() -> None:
    surface = read_surface(BUNNY)
    charts, again = cut_charts(surface), cut_charts(surface)
    assert np.array_equal(charts.uv, again.uv) and charts.scale == again.scale
    corners = surface.positions[surface.triangles]
    edge = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=1)
    flat = np.stack([charts.uv[:, 1] - charts.uv[:, 0], charts.uv[:, 2] - charts.uv[:, 0]], axis=1)
    lengths = charts.scale * np.linalg.norm(flat, axis=2) / np.linalg.norm(edge, axis=2)
    low, high = np.quantile(lengths, [0.01, 0.99])
    bound = tolerance("fur_chart_stretch")
    assert 1.0 / bound < low < high < bound
    assert charts.uv.min() >= 0.0 and charts.uv.max() <= 1.0


def test_every_edge_is_one_quad(bunny: FurMesh) -> None:
    fins = bunny.fin_vertices.reshape(-1, 4)
    assert np.array_equal(fins["w"], np.broadcast_to(np.array([0, 1, 1, 0], np.float32), fins.shape))
    assert np.array_equal(fins["position"][:, 0], fins["position"][:, 1])
    assert np.array_equal(fins["position"][:, 2], fins["position"][:, 3])
    ends = np.sort(np.ascontiguousarray(fins["position"][:, [0, 3]]).view("f4,f4,f4")[..., 0], axis=1)
    assert len(np.unique(ends, axis=0)) == len(fins)
    w = bunny.fin_vertices["w"][bunny.fin_triangles].reshape(-1, 2, 3)
    assert np.array_equal(w, np.broadcast_to(np.array([[0, 1, 1], [1, 0, 0]], np.float32), w.shape))
    along = np.linalg.norm(fins["position"][:, 3] - fins["position"][:, 0], axis=1)
    uv = fins["uv"][..., 0]
    assert (uv[:, :2] == 0.0).all() and (uv[:, 2] == uv[:, 3]).all()
    ratio = along / uv[:, 3]
    assert np.ptp(ratio) / ratio.mean() < tolerance("fur_fin_scale")
    assert (fins["uv"][..., 1] == np.round(fins["uv"][..., 1])).all()


def test_a_fin_knows_both_faces(tmp_path: Path) -> None:
    box = trimesh.creation.box()
    path = tmp_path / "box.ply"
    box.export(path)
    edges = find_edges(read_surface(path))
    assert (len(edges.vertices), edges.border, edges.crowded) == (18, 0, 0)
    across = np.einsum("ij,ij->i", edges.face_a, edges.face_b)
    assert np.unique(np.round(across, 6)).tolist() == [0.0, 1.0]  # 12 edges of the box, 6 diagonals
    assert (np.round(across) == 1.0).sum() == 6


def test_an_open_mesh_keeps_the_fins_of_its_border(tmp_path: Path) -> None:
    mesh = grow(written(tmp_path, SQUARE), spacing=0.1)
    assert mesh.findings["border edges"] == 4 and mesh.findings["fins"] == 5
    fins = mesh.fin_vertices.reshape(-1, 4)[:, 0]
    opposed = np.einsum("ij,ij->i", fins["face_a"], fins["face_b"]) < 0.0
    assert opposed.sum() == 4  # fin_opacity_silhouette is then 1 from everywhere


def test_negative_zero_is_zero(tmp_path: Path) -> None:
    text = SQUARE.replace("f 1 3 4", "v -0.0 -0.0 -0.0\nv 1 1 -0.0\nf 5 6 4")
    mesh = grow(written(tmp_path, text), spacing=0.1)
    assert mesh.findings["border edges"] == 4 and len(np.unique(mesh.vertices["position"], axis=0)) == 4


def test_a_crowded_edge_has_one_fin(tmp_path: Path) -> None:
    mesh = grow(written(tmp_path, THREE_AT_AN_EDGE), spacing=0.1)
    assert mesh.findings["edges between more than two triangles"] == 1
    assert mesh.findings["fins"] == 7
    with pytest.raises(UserError, match="an edge between more than two triangles needs subdivide = 0"):
        grow(written(tmp_path, THREE_AT_AN_EDGE), spacing=0.1, subdivide=1)


def test_degenerate_and_doubled_faces_are_left_out(tmp_path: Path) -> None:
    odd = SQUARE + "v 0.5 0.5 0\nf 1 1 2\nf 1 5 3\nf 3 1 2\n"
    mesh = grow(written(tmp_path, odd), spacing=0.1)
    assert mesh.findings["degenerate or doubled triangles left out"] == 3
    assert mesh.findings["triangles"] == 2
    assert np.isfinite(mesh.vertices["normal"]).all() and np.isfinite(mesh.vertices["uv"]).all()


def test_normals_that_cancel_are_replaced(tmp_path: Path) -> None:
    # Two sheets of the same square, back to back, share vertices but no face.
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n"
    surface = read_surface(written(tmp_path, text))
    assert surface.findings["vertices whose normals cancel"] == 4
    assert np.abs(np.linalg.norm(surface.normals, axis=1) - 1.0).max() < tolerance("unit_length")


def test_normals_in_the_file_do_not_matter(tmp_path: Path) -> None:
    lines = SQUARE.replace("f 1 2 3", "vn 0 0 0\nf 1//1 2//1 3//1").replace("f 1 3 4", "f 1//1 3//1 4//1")
    surface = read_surface(written(tmp_path, lines))
    assert np.array_equal(surface.normals, np.broadcast_to([0.0, 0.0, 1.0], (4, 3)))


@pytest.mark.parametrize("name", ["ball.obj", "ball.ply", "ball.glb", "ball.gltf", "ball.stl", "ball.off"])
def test_formats_agree(tmp_path: Path, name: str) -> None:
    ball = trimesh.creation.icosphere(subdivisions=2)
    if name == "ball.gltf":  # its numbers are in files of their own
        export: Any = trimesh.exchange.gltf.export_gltf
        for file, data in export(ball.scene()).items():
            (tmp_path / (name if file == "model.gltf" else file)).write_bytes(data)
    else:
        ball.export(tmp_path / name)
    surface = read_surface(tmp_path / name)
    assert surface.positions.shape == (162, 3) and surface.triangles.shape == (320, 3)
    assert np.sum(surface.normals * surface.positions, axis=1).min() > 0.9


def test_subdivision_takes_corners_along() -> None:
    ball = trimesh.creation.icosphere(subdivisions=1)
    flat = Surface(
        positions=np.asarray(ball.vertices),
        triangles=np.asarray(ball.faces),
        normals=np.asarray(ball.vertex_normals),
        paint=np.ones((len(ball.faces), 3, 2)),
        findings={},
    )
    fine, carried = subdivided(flat, flat.positions[flat.triangles], 2)
    assert len(fine.triangles) == 16 * len(flat.triangles)
    # The plain midpoints stay near the subdivided ball, corner by corner.
    apart = np.linalg.norm(carried - fine.positions[fine.triangles], axis=2)
    assert apart.max() < tolerance("fur_subdivided_corner")


def test_combing_is_tangential_and_of_the_stated_strength() -> None:
    rng = np.random.default_rng(7)
    n = rng.normal(size=(1000, 3))
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    comb = comb_field(n, Combing((0.0, -3.0, 0.0), 0.8))
    assert np.abs(np.sum(n * comb, axis=1)).max() < tolerance("fur_comb")
    expected = 0.8 * np.sqrt(1.0 - n[:, 1] ** 2)
    assert np.abs(np.linalg.norm(comb, axis=1) - expected).max() < tolerance("fur_comb")
    assert not comb_field(n, Combing()).any()


def test_vertex_colours_paint_length_and_density(tmp_path: Path) -> None:
    ball = trimesh.creation.icosphere(subdivisions=1)
    colours = np.full((len(ball.vertices), 4), 255, np.uint8)
    colours[:, 0] = np.where(ball.vertices[:, 1] > 0.0, 255, 51)
    colours[:, 1] = 102
    ball.visual.vertex_colors = colours
    path = tmp_path / "painted.ply"
    ball.export(path)
    mesh = grow(path, spacing=0.2, channels=("red", "green"))
    upper = mesh.vertices["position"][:, 1] > 0.0
    assert np.unique(mesh.vertices["length_share"][upper]).tolist() == [1.0]
    assert np.unique(mesh.vertices["length_share"][~upper]).tolist() == [np.float32(0.2)]
    assert np.unique(mesh.vertices["density_share"]).tolist() == [np.float32(0.4)]
    finer = grow(path, spacing=0.2, channels=("red", ""), subdivide=1)
    assert (
        np.unique(finer.vertices["length_share"]).tolist() == np.array([0.2, 0.6, 1.0], np.float32).tolist()
    )


REFUSED = {
    "absent": (None, "there is no such mesh file"),
    "empty": ("", "holds no triangles"),
    "points": ("v 0 0 0\nv 1 0 0\n", "holds no triangles"),
    "flat": ("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "all of its 1 triangles are degenerate"),
    "nan": (SQUARE.replace("v 1 0 0", "v 1 nan 0"), "has a vertex that is not finite"),
    "far": (SQUARE.replace("v 1 0 0", "v 5000 0 0"), "reaches out to 5000"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_bears_no_fur_is_refused(tmp_path: Path, name: str) -> None:
    text, sentence = REFUSED[name]
    path = tmp_path / "mesh.obj"
    if text is not None:
        written(tmp_path, text)
    with pytest.raises(UserError, match=sentence) as caught:
        grow(path, spacing=0.1)
    assert str(caught.value).startswith(f"{path}: ") and "\n" not in str(caught.value)


def test_a_mesh_may_not_be_huge(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("codegen.fur.surface.MOST_TRIANGLES", 1)
    with pytest.raises(UserError, match="has 2 triangles, more than 1; simplify it first"):
        grow(written(tmp_path, SQUARE), spacing=0.1)
    monkeypatch.setattr("codegen.fur.surface.MOST_TRIANGLES", 2)
    monkeypatch.setattr("codegen.fur.surface.MOST_SUBDIVIDED", 8)
    assert grow(written(tmp_path, SQUARE), spacing=0.1, subdivide=1).findings["triangles"] == 8
    with pytest.raises(UserError, match="subdivide = 2 makes more than 8 triangles"):
        grow(written(tmp_path, SQUARE), spacing=0.1, subdivide=2)
    monkeypatch.setattr("codegen.fur.meshfile.LARGEST_FILE", 10)
    with pytest.raises(UserError, match="is larger than"):
        grow(written(tmp_path, SQUARE), spacing=0.1)


def test_missing_colours_and_too_fine_a_spacing_are_refused(tmp_path: Path) -> None:
    path = written(tmp_path, SQUARE)
    with pytest.raises(UserError, match="has no vertex colours, which are to paint the coat"):
        grow(path, spacing=0.1, channels=("red", ""))
    with pytest.raises(UserError, match="a spacing of 1e-05 is too fine for this mesh"):
        grow(path, spacing=1e-5)


def test_a_file_that_is_no_mesh_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "mesh.ply"
    path.write_bytes(b"ply\nformat ascii 1.0\nelement vertex 1000\n\xff\xfe")
    with pytest.raises(UserError, match=r"cannot be read as a mesh|holds no triangles"):
        grow(path, spacing=0.1)
