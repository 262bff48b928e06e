"""Strands of hair are read, turned into ribbons and drawn alike everywhere, however short their segments are.

Plan.
  files     a TressFX file comes back as it was written; what is none is refused in one sentence
  ribbons   two vertices per point, two triangles per segment; tangents are unit for segments of any length,
            without length, and for strands that are one point
  agreement OpenGL against WebGPU, against rays on the evaluator and on OpenCL, Scheuermann and Banks, on a
            synthetic tuft with degenerate segments and on the carried strands; no sample is odd
  stages    glslang and naga accept them; both dialects of GLSL draw the same
  look      a ribbon is as wide as it is said to be and tapers; roots are darker by s_min
  copies    the first is the strand itself, the others are near, the same again
  command   `vair render` draws strands; every mistake is one sentence and exit status 2
  real      the whole file that the carried one is every third strand of, where it is at hand
"""

import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from codegen.cli import run
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.fur.shading import strand_shading
from codegen.library import load_library
from codegen.strands.ribbons import copied, ribbons
from codegen.strands.stages import strand_texts
from codegen.strands.tfx import HEADER, read_strands, tfx
from conformance.picture.strands.draw import draw_strands
from conformance.picture.strands.studio import StrandStudio, open_strands, set_up_strands
from conformance.picture.tolerances import tolerance
from conformance.picture.tone import steps_apart
from conformance.unit.support.drivers import need
from targets import TargetUnavailable, probe
from targets.packages import find_tool
from targets.wgsl import validate as wgsl

ROOT = Path(__file__).parents[3]
SCENES = ROOT / "examples" / "scenes"
MOHAWK = ROOT / "examples" / "data" / "mohawk.tfx"
WHOLE = ROOT.parent / "shared" / "data" / "strands" / "Ratboy_mohawk.tfx"
SCENE = (SCENES / "mohawk.toml").read_text(encoding="utf-8")
SHORTEST = 1.3e-7
"""Length of the shortest segment of the whole file."""
MODELS = {"scheuermann": "mohawk", "banks": "banks-mohawk"}
LIBRARY = load_library()


def tuft() -> np.ndarray[Any, np.dtype[np.float64]]:
    """Forty curls of twelve points on a disc, some of whose segments have hardly any length or none."""
    rng = np.random.default_rng(1994)
    u = np.linspace(0.0, 1.0, 12)
    root = np.concatenate([rng.uniform(-0.3, 0.3, (40, 1, 2)), np.zeros((40, 1, 1))], axis=2)[..., [0, 2, 1]]
    turn = 2.0 * np.pi * (u + rng.uniform(size=(40, 1)))
    curl = 0.06 * u[:, None] * np.stack([np.cos(turn), 0.0 * turn, np.sin(turn)], axis=-1)
    points: Any = root + np.stack([0.0 * u, u, 0.0 * u], axis=-1) + curl
    points[0, 5] = points[0, 4] + [0.0, 1.3e-7, 0.0]
    points[1, 3:6] = points[1, 3]  # segments without length
    points[2, 6] = points[2, 5] + [1e-38, 0.0, 0.0]
    points[3] = points[3, 0]  # a strand that is one point
    points[4, 1:] = points[4, :1] + np.arange(1, 12)[:, None] * [0.0, 1e-25, 0.0]
    return np.asarray(points)


def written(folder: Path, model: str = "scheuermann") -> Path:
    """A scene of the tuft."""
    (folder / "tuft.tfx").write_bytes(tfx(tuft()))
    text = (SCENES / f"{MODELS[model]}.toml").read_text(encoding="utf-8")
    for old, new in [
        ("../data/mohawk.tfx", "tuft.tfx"),
        ("width = 0.0008", "width = 0.03"),
        ("copies = 16", "copies = 1"),
        ("target = [0.0, 0.69, -0.06]", "target = [0.0, 0.5, 0.0]"),
        ("field_of_view = 23.5", "field_of_view = 34.0"),
    ]:
        assert old in text
        text = text.replace(old, new)
    path = folder / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return path


def drawn(studio: StrandStudio, target: str) -> np.ndarray:
    samples = draw_strands(studio, target)[0]
    assert np.isfinite(samples).all() and samples.min() >= 0.0
    assert set(np.unique(samples[..., 3])) == {0.0, 1.0} and samples[..., :3].max() > 0.05
    return samples[..., :3].astype(np.float64)


def agree(one: np.ndarray, other: np.ndarray, share: str) -> None:
    steps = steps_apart(one, other)
    assert steps.mean() < tolerance("fur_mean_steps")
    assert (steps.max(axis=2) < tolerance("fur_pixel_steps")).mean() > tolerance(share)


def test_a_file_comes_back_as_written(tmp_path: Path) -> None:
    points = tuft().astype(np.float32)
    (tmp_path / "tuft.tfx").write_bytes(tfx(points))
    assert np.array_equal(read_strands(tmp_path / "tuft.tfx"), points.astype(np.float64))


def broken(**fields: Any) -> bytes:
    """A file whose header says something else."""
    said: dict[str, Any] = {"version": 4.0, "strands": 40, "points": 12, "offset": 160} | fields
    return HEADER.pack(*said.values(), 0, 0, 0, 0) + tfx(tuft())[HEADER.size :]


REFUSED: dict[str, tuple[bytes | None, str]] = {
    "absent": (None, "there is no such file of strands"),
    "empty": (b"", "is no TressFX file of version 4"),
    "text": (b"v 0 0 0\n" * 40, "is no TressFX file of version 4"),
    "version": (broken(version=3.0), "is no TressFX file of version 4"),
    "no strands": (broken(strands=0), "holds no strands of two points or more"),
    "points": (broken(points=1), "holds no strands of two points or more"),
    "huge": (broken(strands=2**31), "points, more than 2097152; thin the strands first"),
    "offset": (broken(offset=4), "ends before its 40 strands of 12 points do"),
    "truncated": (tfx(tuft())[:-1], "ends before its 40 strands of 12 points do"),
    "nan": (tfx(np.full((2, 3, 3), np.nan)), "has a point that is not finite"),
    "infinite": (tfx(np.full((2, 3, 3), np.inf)), "has a point that is not finite"),
    "far": (tfx(np.full((2, 3, 3), 5e3)), "reaches out to 5000; strands are drawn within 1000 units"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_files_that_hold_no_strands_are_refused(tmp_path: Path, name: str) -> None:
    data, sentence = REFUSED[name]
    path = tmp_path / "hair.tfx"
    if data is not None:
        path.write_bytes(data)
    with pytest.raises(UserError) as caught:
        read_strands(path)
    assert str(caught.value).startswith(f"{path}: ") and sentence in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_may_not_be_huge(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("codegen.strands.tfx.LARGEST_FILE", 1 << 12)
    (tmp_path / "hair.tfx").write_bytes(tfx(tuft()))
    with pytest.raises(UserError, match="is larger than 0 MiB; thin the strands first"):
        read_strands(tmp_path / "hair.tfx")


def test_ribbons_have_two_edges() -> None:
    made = ribbons(tuft())
    assert made.vertices.shape == (40 * 12 * 2,) and made.triangles.shape == (40 * 11 * 2, 3)
    rows = made.vertices.reshape(40, 12, 2)
    assert np.array_equal(rows["position"][:, :, 0], rows["position"][:, :, 1])
    assert np.array_equal(rows["side"], np.broadcast_to(np.array([-1, 1], np.float32), rows.shape))
    assert (rows["share"][:, 0] == 0.0).all() and (rows["share"][:, -1] == 1.0).all()
    strand = made.triangles.reshape(40, -1) // 24
    assert (strand == np.arange(40)[:, None]).all()  # no triangle joins two strands
    found = made.findings
    assert (found["strands"], found["points per strand"], found["strands without length"]) == (40, 12, 1)
    assert found["segments without length"] == 2 + 1 + 11


def test_tangents_are_unit_for_segments_of_any_length() -> None:
    vertices = ribbons(tuft()).vertices.reshape(40, 12, 2)[:, :, 0]
    flat = vertices.reshape(-1)
    inputs = {"x": flat["along"], "fallback": flat["chord"]}
    t = np.asarray(evaluate(LIBRARY, "safe_normalize", inputs, "float32")).reshape(40, 12, 3)
    assert np.abs(np.linalg.norm(t.astype(np.float64), axis=2) - 1.0).max() < tolerance("tangent_length")
    for name in ("chord", "root"):
        length = np.linalg.norm(flat[name].astype(np.float64), axis=1)
        assert np.abs(length - 1.0).max() < tolerance("unit_length")
    assert (t[3] == [0.0, 1.0, 0.0]).all()  # no direction at all: upright
    assert np.array_equal(t[1, 4], vertices["chord"][1, 4])  # neighbours coincide: along the strand
    assert (t[4] == [0.0, 1.0, 0.0]).all()  # 1e-25 long, still their own direction


@pytest.fixture(scope="module", params=list(MODELS))
def studio(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> StrandStudio:
    path = written(tmp_path_factory.mktemp("tuft"), request.param)
    return set_up_strands(LIBRARY, path, size=(64, 64), supersample=1)


def test_opengl_and_webgpu_draw_the_same_strands(studio: StrandStudio) -> None:
    need("glsl", "wgsl")
    agree(drawn(studio, "glsl"), drawn(studio, "wgsl"), "fur_pixel_share")


def test_rays_see_what_opengl_draws(studio: StrandStudio) -> None:
    need("glsl")
    agree(drawn(studio, "glsl"), drawn(studio, "numpy32"), "fur_march_share")


def test_backends_that_draw_nothing_agree(studio: StrandStudio) -> None:
    reference = drawn(studio, "numpy")
    others = ["numpy32"] + ["opencl"] * (not isinstance(probe("opencl"), TargetUnavailable))
    for target in others:
        agree(drawn(studio, target), reference, "fur_pixel_share")


def test_the_carried_strands_are_drawn_alike() -> None:
    need("glsl", "wgsl")
    made = set_up_strands(LIBRARY, SCENES / "mohawk.toml", size=(96, 96), supersample=1)
    assert made.ribbons.findings["strands"] == 743 * 16
    agree(drawn(made, "glsl"), drawn(made, "wgsl"), "fur_pixel_share")


def test_the_dialects_of_glsl_draw_the_same(studio: StrandStudio) -> None:
    need("glsl")
    pictures = []
    for dialect in ("330", "es300"):
        drawing = open_strands(studio, "glsl", dialect)
        pictures.append(drawing.draw(studio.block.pack(studio.values("glsl"))))
        drawing.release()
    assert np.array_equal(pictures[0], pictures[1])


@pytest.mark.parametrize("model", MODELS)
def test_compilers_accept_the_stages(tmp_path: Path, model: str) -> None:
    shading = strand_shading(LIBRARY, f"{model}_shade")
    wgsl.validate(strand_texts(LIBRARY, shading, "wgsl", "wgsl")["strands.wgsl"])
    glslang = find_tool("glslangValidator", "glslang")
    if glslang is None:
        pytest.skip("glslangValidator is not installed")
    for dialect in ("330", "es300"):
        for name, text in strand_texts(LIBRARY, shading, "glsl", dialect).items():
            (tmp_path / name).write_text(text, encoding="utf-8")
            done = subprocess.run(
                [glslang, str(tmp_path / name)], capture_output=True, text=True, check=False
            )
            assert done.returncode == 0, done.stdout


def test_a_ribbon_is_as_wide_as_said(tmp_path: Path) -> None:
    need("glsl")
    made = set_up_strands(LIBRARY, written(tmp_path), size=(100, 100), supersample=1)
    line = np.linspace([0.0, 0.0, 0.0], [0.0, 1.0, 0.0], 9)[None]
    camera = replace(made.picture.camera, eye=(0.0, 0.5, 4.0), target=(0.0, 0.5, 0.0))
    camera = replace(camera, field_of_view=float(2.0 * np.degrees(np.arctan(0.5 / 4.0))))
    hair = replace(made.hair, width=0.2, tip=0.5, s_min=0.5)
    alone = replace(made, ribbons=ribbons(line), picture=replace(made.picture, camera=camera), hair=hair)
    samples = draw_strands(alone, "glsl")[0]
    wide = samples[..., 3].sum(axis=1)  # a hundredth of a unit per pixel, the tip above
    assert abs(wide[97] - 20.0) <= 1.0 and abs(wide[2] - 10.0) <= 1.0 and abs(wide[50] - 15.0) <= 1.0
    full = draw_strands(replace(alone, hair=replace(hair, s_min=1.0)), "glsl")[0]
    ratio = samples[:, 50, :3] / full[:, 50, :3]
    heights = 1.0 - (np.arange(100) + 0.5) / 100.0
    assert np.abs(ratio - (0.5 + 0.5 * heights)[:, None]).max() < tolerance("fur_half_float")


def test_copies_are_beside_the_strand() -> None:
    points = tuft()
    made = copied(points, 5, 0.02, seed=7).reshape(40, 5, 12, 3)
    assert np.array_equal(made[:, 0], points) and np.array_equal(copied(points, 1, 0.02, 7), points)
    away = np.linalg.norm(made[:, 1:] - points[:, None], axis=-1)
    spread = 0.02
    assert 0.75 * spread < away.max() < spread + tolerance("position")
    assert np.ptp(away, axis=2).max() < tolerance("position")
    assert np.array_equal(copied(points, 5, 0.02, seed=7).reshape(made.shape), made)


def test_the_command_draws_strands(tmp_path: Path) -> None:
    need("glsl")
    path = written(tmp_path)
    path.write_text(path.read_text().replace("[480, 480]", "[40, 30]"), encoding="utf-8")
    output = tmp_path / "tuft.png"
    assert run(["render", str(path), "--target", "glsl", "-o", str(output)]) == 0
    with Image.open(output) as image:
        pixels = np.asarray(image).astype(int)
    assert pixels.shape == (30, 40, 3) and (pixels[..., 0] > pixels[..., 2] + 10).mean() > 0.02


WRONG: dict[str, tuple[str, str, str]] = {
    "no file": ('file = "tuft.tfx"', "", "[strands] file: is missing"),
    "absent": ("tuft.tfx", "tufts.tfx", "tufts.tfx: there is no such file of strands"),
    "negative": ("width = 0.03", "width = -0.03", "[strands] width: must be a number from 1e-06 to 100"),
    "nan": ("width = 0.03", "width = nan", "[strands] width: must be a number from 1e-06 to 100, not nan"),
    "misspelt": ("tip =", "tipp =", '[strands] has an unknown key "tipp"; did you mean "tip"?'),
    "none": ("copies = 1", "copies = 0", "[strands] copies: must be a whole number from 1 to 64, not 0"),
    "shadows": ("shadows = false", "", "[render] shadows: strands cast no shadows; set it to false"),
    "both": ("[strands]", "[fur]\nlength = 1\nspacing = 1\n[strands]", "has a [fur] and a [strands] table"),
    "size": ("supersample = 3", "supersample = 8\nsubdivide = 0", "size times supersample may be 8192"),
    "mesh": ("[render]\n", '[render]\nmesh = "bunny.obj"\n', '[render] has an unknown key "mesh"'),
    "model": ('"scheuermann"', '"brushed"', '[parameters] "base": brushed_shade has no such parameter'),
}


@pytest.mark.parametrize("name", WRONG)
def test_bad_strands_are_refused_in_one_sentence(
    tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    right, wrong, sentence = WRONG[name]
    path = written(tmp_path)
    text = path.read_text(encoding="utf-8")
    assert right in text
    text = text.replace("[480, 480]", "[1200, 20]") if name == "size" else text
    path.write_text(text.replace(right, wrong, 1), encoding="utf-8")
    assert run(["render", str(path), "-o", str(tmp_path / "tuft.png")]) == 2
    said = capsys.readouterr().err.strip()
    assert sentence in said and "\n" not in said
    assert not (tmp_path / "tuft.png").exists()


def test_copies_may_not_be_too_many(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("conformance.picture.strands.studio.MOST_POINTS", 479)
    with pytest.raises(UserError, match=r"\[strands\] copies: 1 make more than 479 points"):
        set_up_strands(LIBRARY, written(tmp_path))


def test_what_no_strand_has_and_targets_without_ribbons_are_refused(tmp_path: Path) -> None:
    for model, what in (("fakefur_shade", "coat.density"), ("brushed_shade", "map_tangent")):
        with pytest.raises(UserError, match=f'{model} cannot shade strands: a strand has no "{what}"'):
            strand_shading(LIBRARY, model)
    made = set_up_strands(LIBRARY, written(tmp_path))
    with pytest.raises(UserError, match="target opencl draws no strands; glsl and wgsl do"):
        open_strands(made, "opencl")


def test_the_whole_file_is_drawn_without_an_odd_sample(tmp_path: Path) -> None:
    if not WHOLE.is_file():
        pytest.skip(f"{WHOLE.name} lies with the project's shared data, which is not here")
    need("glsl", "wgsl")
    whole = read_strands(WHOLE)
    assert np.array_equal(read_strands(MOHAWK), whole[::3])
    shortest = np.linalg.norm(np.diff(whole, axis=1), axis=2).min()
    assert whole.shape == (2228, 32, 3) and np.isclose(shortest, SHORTEST, rtol=tolerance("shortest_segment"))
    path = tmp_path / "scene.toml"
    path.write_text(
        SCENE.replace("../data/mohawk.tfx", WHOLE.as_posix()).replace("copies = 16", "copies = 1")
    )
    made = set_up_strands(LIBRARY, path, size=(160, 160), supersample=1)
    agree(drawn(made, "glsl"), drawn(made, "wgsl"), "fur_pixel_share")
