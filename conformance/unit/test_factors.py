"""Homomorphic factorisation, files of samples, Waterloo's format, and `vair factor`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from codegen.cli import run
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.factors import grids
from codegen.factors.homomorphic import Factors, Settings, error, factorise
from codegen.factors.maps import SHADES, factor_maps, read_factor_maps
from codegen.factors.samples import Samples, directions, read_samples
from codegen.factors.source import draw_samples
from codegen.factors.waterloo import read_waterloo, waterloo_files
from codegen.library import load_library
from codegen.maps.bilinear import lookup
from codegen.maps.image import png
from conformance.factored.published import SATIN, WATERLOO, cosine_weighted, viewer
from conformance.unit.support.tolerances import tolerance

EXACT = tolerance("exact_interpolation")


def smooth_factors(channels: int = 1) -> Factors:
    """Factors that are smooth on their grids, with a second channel half as strong."""
    y, x = np.mgrid[0:8, 0:8] / 8.0
    p = np.exp(-0.3 * (x - 0.4) ** 2 - 0.2 * y)
    q = np.exp(-1.5 * (x - 0.5) ** 2 - 0.5 * (y - 0.5) ** 2)
    strength = np.array([1.0, 0.5, 0.25])[:channels]
    p, q = (np.repeat(g[..., None] / g.max(), channels, axis=2) for g in (p, q))
    return Factors(2.0 * strength, p, q)


# ------------------------------------------------------------------------------------------------ grids


def test_a_plane_is_interpolated_exactly_and_does_not_bend() -> None:
    y, x = (np.mgrid[0:6, 0:6] + 0.5) / 6.0
    image = (1.0 + 2.0 * x - y)[..., None]
    uv = np.random.default_rng(3).uniform(1.0 / 12.0, 11.0 / 12.0, (500, 2))
    expected = 1.0 + 2.0 * uv[:, 0] - uv[:, 1]
    assert np.abs(lookup(image, uv)[:, 0] - expected).max() <= EXACT
    assert np.abs(grids.rows(grids.taps(uv, 6), 6) @ image.ravel() - expected).max() <= EXACT
    assert np.abs(grids.bends(6) @ image.ravel()).max() <= EXACT
    assert np.abs(grids.bends(6) @ (x**2).ravel()).max() > EXACT


@pytest.mark.parametrize("size", [1, 2])
def test_the_smallest_grids_work(size: int) -> None:
    found = lookup(np.full((size, size, 1), 3.0), np.array([[0.0, 0.0], [1.0, 1.0], [0.5, 0.25]]))
    assert np.abs(found - 3.0).max() <= EXACT


# -------------------------------------------------------------------------------------------------- fits


def test_what_is_a_product_of_factors_is_found_again() -> None:
    truth = smooth_factors(3)
    l, v = directions(5_000, seed=4)
    found = factorise(Samples(l, v, truth.value(l, v)), Settings(8, 8))
    l, v = directions(5_000, seed=5)
    fresh = Samples(l, v, truth.value(l, v))
    # What is left: the pull of the smoothness, and logarithms that are interpolated in place of values.
    assert error(found, fresh).p95 <= tolerance("half_vector_fit")
    assert np.abs(found.value(l, v) - found.value(v, l)).max() <= EXACT


def test_errors_are_of_values_and_of_what_is_seen() -> None:
    """A tenth too much of a constant: a tenth of the value, and of its product with the cosine."""
    constant = Factors(np.array([1.1]), np.ones((4, 4, 1)), np.ones((4, 4, 1)))
    l, v = directions(20_000, seed=11)
    samples = Samples(l, v, np.ones((len(l), 1)))
    found, inner = error(constant, samples), error(constant, samples.above(0.5))
    assert abs(found.rms - 0.1) <= EXACT and abs(found.largest - 0.1) <= EXACT
    cosine = np.sqrt((l[:, 2] ** 2).mean()) / l[:, 2].mean()
    assert abs(found.seen - 0.1 * cosine) <= EXACT
    assert len(samples.above(0.5)) == ((l[:, 2] >= 0.5) & (v[:, 2] >= 0.5)).sum() == inner.samples


def test_emphasis_lowers_the_error_of_what_is_seen() -> None:
    """The strand's lobe does not factor: what is left lies where the weights allow it."""
    drawn = draw_samples(load_library(), "strand_specular", {"exponent": 8.0}, 4000, diffuse=0.1)
    plain, leaning = (error(factorise(drawn, Settings(8, 16, emphasis=e)), drawn) for e in (0.0, 1.0))
    assert leaning.seen < plain.seen and leaning.median > plain.median


def test_missing_samples_are_left_out() -> None:
    truth = smooth_factors()
    l, v = directions(6_000, seed=6)
    value = truth.value(l, v)
    holes = value.copy()
    holes[::3] = np.nan
    holes[1::3] = 0.0
    found = factorise(Samples(l, v, holes), Settings(8, 8))
    assert error(found, Samples(l, v, value)).p95 <= tolerance("half_vector_fit")


def test_lobes_of_the_half_vector_fit_and_a_strand_needs_its_cosines() -> None:
    library = load_library()

    def rms(name: str, settings: Settings, count: int) -> float:
        constants = {"exponent": 32.0}
        drawn = draw_samples(library, name, constants, count, diffuse=0.3)
        fresh = draw_samples(library, name, constants, 10_000, diffuse=0.3, seed=2)
        return error(factorise(drawn, settings), fresh).rms

    assert rms("strand_specular_half", Settings(24, 48), 20_000) <= tolerance("half_vector_fit")
    alone = rms("strand_specular", Settings(16, 32), 20_000)
    assert tolerance("half_vector_fit") < alone <= tolerance("strand_fit")
    assert rms("strand_specular", Settings(8, 16, 64), 20_000) <= tolerance("strand_fit_with_cosines")


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        (Settings(size_p=1), "factor p: 1 texels along a side; there can be 2 to 512"),
        (Settings(size_r=600), "factor r: 600 texels along a side"),
        (Settings(smoothness=0.0), "smoothness 0: it must be above 0"),
    ],
)
def test_settings_that_no_fit_can_have(settings: Settings, told: str) -> None:
    l, v = directions(200, seed=1)
    with pytest.raises(UserError, match=told):
        factorise(Samples(l, v, np.ones((200, 1))), settings)


# ------------------------------------------------------------------------------------------------- files


def table(path: Path, header: str, rows: list[str]) -> Path:
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def test_samples_from_text_and_from_arrays_are_the_same(tmp_path: Path) -> None:
    l, v = directions(300, seed=7)
    value = smooth_factors(3).value(l, v)
    np.savez(tmp_path / "a.npz", l=l, v=v, value=value)
    lines = [",".join(f"{x:.17g}" for x in (*a, *b, *c)) for a, b, c in zip(l, v, value, strict=True)]
    lines[5] = lines[5].rsplit(",", 1)[0] + ","
    text = read_samples(table(tmp_path / "a.csv", "l.x,l.y,l.z,v.x,v.y,v.z,r,g,b", lines))
    arrays = read_samples(tmp_path / "a.npz")
    assert np.array_equal(text.l, arrays.l) and np.array_equal(text.v, arrays.v)
    assert np.isnan(text.value[5, 2]) and len(text.known()) == len(arrays.known()) - 1


def cut(path: Path) -> Path:
    """A file of arrays that ends too early."""
    l, v = directions(300, seed=7)
    np.savez(path, l=l, v=v, value=np.ones((300, 1)))
    path.write_bytes(path.read_bytes()[:500])
    return path


@pytest.mark.parametrize("shape", [(0,), (0, 3), (1,)])
def test_a_file_without_samples_is_refused(tmp_path: Path, shape: tuple[int, ...]) -> None:
    rows = shape[0]
    l = np.tile([0.0, 0.0, 1.0], (rows, 1))
    np.savez(tmp_path / "few.npz", l=l, v=l, value=np.ones(shape))
    with pytest.raises(UserError, match=f"few.npz: {rows} samples have a value above 0; a fit needs 100"):
        read_samples(tmp_path / "few.npz")


def test_what_holds_no_samples_gets_one_sentence(tmp_path: Path) -> None:
    header = "l.x,l.y,l.z,v.x,v.y,v.z,value"
    good = ["0,0,1,0,0,1,1"] * 200
    cases = {
        'the column "v.z" is missing': table(tmp_path / "1.csv", header.replace("v.z", "v.w"), good),
        r"row 3: v = \(0, 0, 2\) is no unit vector": table(
            tmp_path / "2.csv", header, [*good[:2], "0,0,1,0,0,2,1", *good]
        ),
        "99 samples have a value above 0; a fit needs 100": table(tmp_path / "3.csv", header, good[:99]),
        "samples are a .csv or .npz file": table(tmp_path / "4.txt", header, good),
        "no such file": tmp_path / "5.csv",
        "not a readable .npz file": table(tmp_path / "6.npz", header, good),
        "row 8: the value -1 is no reflectance \\(1 such rows\\)": table(
            tmp_path / "7.csv", header, [*good[:7], "0,0,1,0,0,1,-1", *good]
        ),
        "row 1: the value inf is no reflectance": table(
            tmp_path / "8.csv", header, ["0,0,1,0,0,1,inf", *good]
        ),
        r"row 1: l = \(nan, 0, 1\) is no unit vector": table(
            tmp_path / "9.csv", header, ["nan,0,1,0,0,1,1", *good]
        ),
        "0 samples have a value above 0": table(tmp_path / "10.csv", header, ["0,0,1,0,0,1,nan"] * 200),
        "not a table of numbers: it is empty": table(tmp_path / "11.csv", "", []),
        r"12\.npz: not a readable \.npz file": cut(tmp_path / "12.npz"),
    }
    for told, path in cases.items():
        with pytest.raises(UserError, match=told):
            read_samples(path)


def test_a_material_survives_the_repository_format_up_to_eight_bits(tmp_path: Path) -> None:
    truth = smooth_factors(3)
    for name, data in waterloo_files("smooth", "smooth", truth).items():
        (tmp_path / name).write_bytes(data)
    found = read_waterloo(tmp_path)
    assert (found.name, found.zeros) == ("smooth", 0)
    assert np.abs(found.factors.p - truth.p).max() <= tolerance("eight_bits")
    assert np.abs(found.factors.scale - truth.scale).max() <= EXACT
    with pytest.raises(UserError, match="leave out the factor r"):
        waterloo_files("x", "x", Factors(truth.scale, truth.p, truth.q, truth.q))


def test_what_is_no_material_gets_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="0 materials; name one"):
        read_waterloo(tmp_path)
    bad = tmp_path / "bad.txt"
    for text, told in (
        ("a\nb\n", "not a factored material"),
        ("a\n0\n1 x 2\n", "the scale is three numbers"),
    ):
        bad.write_text(text)
        with pytest.raises(UserError, match=told):
            read_waterloo(bad)
    bad.write_text("a\n0\n1 1 1\n")
    with pytest.raises(UserError, match="no such file"):
        read_waterloo(bad)
    files = waterloo_files("a", "bad", smooth_factors(3))
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
    (tmp_path / "bad_1.png").write_bytes(files["bad_1.png"][:-40])
    with pytest.raises(UserError, match=r"bad_1\.png"):
        read_waterloo(bad)
    (tmp_path / "bad_1.png").write_bytes(b"not a picture")
    with pytest.raises(UserError, match=r"bad_1\.png"):
        read_waterloo(bad)
    (tmp_path / "bad_1.png").write_bytes(png(np.ones((4, 8, 3))))
    with pytest.raises(UserError, match=r"bad_1\.png: 8 x 4; a parabolic map is square"):
        read_waterloo(bad)
    foreign = tmp_path / "bad.jpg"
    foreign.write_bytes(b"x")
    with pytest.raises(UserError, match=r"a factored material is a \.txt file or a folder"):
        read_waterloo(foreign)


@pytest.mark.skipif(not WATERLOO.is_dir(), reason="the Waterloo data are not carried; see CREDITS.md")
def test_the_published_satin_is_symmetric_and_as_anisotropic_as_measured() -> None:
    satin = read_waterloo(WATERLOO / "satin").factors
    l = cosine_weighted(256)
    for azimuth, expected in SATIN.items():
        v = np.broadcast_to(viewer(azimuth), l.shape)
        assert np.abs(satin.value(l, v) - satin.value(v, l)).max() <= EXACT
        assert abs(satin.value(l, v).mean() - expected) <= tolerance("satin_mean")
    assert read_waterloo(WATERLOO / "garnetred" / "garnetred64.txt").zeros > 0


# ----------------------------------------------------------------------------------------- command line


def test_the_command_writes_images_scale_and_error(tmp_path: Path) -> None:
    arguments = ["lambert_value", "--samples", "2000", "--size-q", "8", "-o", str(tmp_path / "out")]
    assert run(["factor", *arguments]) == 0
    manifest = json.loads((tmp_path / "out" / "factors.json").read_text())
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["factors.json", "p.exr", "q.exr"]
    # A constant reflectance is a product of constants.
    assert abs(manifest["scale"][0] * np.pi - 1.0) <= tolerance("half_vector_fit")
    assert manifest["error"]["largest"] <= tolerance("constant_fit")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["strand_speculr"], 'unknown function "strand_speculr"; did you mean "strand_specular"?'),
        (["strand_specular"], "strand_specular needs a value of exponent: --set exponent=..."),
        (["strand_specular", "--set", "exponent=-1"], "exponent = -1 is not in [0, 100000]"),
        (["strand_specular", "--set", "exponent"], "it is NAME=NUMBER, with an ="),
        (["strand_specular", "--set", "exponet=1"], 'did you mean "exponent"?'),
        (["fur_opacity"], "fur_opacity is no reflectance"),
        (["lambert_value", "--format", "jpeg"], 'unknown format "jpeg"; valid names: exr, waterloo'),
        (["lambert_value", "--diffuse", "1"], "--diffuse 1: the constant part is in [0, 1)"),
        (["lambert_value", "--samples", "10"], "--samples 10: a fit takes 1000 to 10000000"),
        (["lambert_value", "--emphasis", "2"], "emphasis 2: it is in [0, 1]"),
        (["lambert_value", "--angles", "acros"], 'unknown angles of r "acros"; did you mean "across"?'),
        (["none/such"], 'cannot read "none/such"'),
        (["absent.txt"], 'cannot read "absent.txt": no such file'),
    ],
)
def test_bad_usage_gets_one_sentence_and_writes_nothing(
    arguments: list[str], told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["factor", *arguments, "-o", str(tmp_path / "out")]) == 2
    assert told in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_folder_that_cannot_be_written_gets_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "file"
    file.write_text("kept")
    for output, told in ((file, "it is a file"), (tmp_path / "no" / "out", "does not exist")):
        assert run(["factor", "lambert_value", "--samples", "1000", "--size-q", "8", "-o", str(output)]) == 2
        assert told in capsys.readouterr().err
    assert file.read_text() == "kept" and [path.name for path in tmp_path.iterdir()] == ["file"]


# --------------------------------------------------------------------------------------- maps of factors


@pytest.mark.parametrize("angles", ["", "along", "across"])
def test_written_factors_are_read_as_maps(angles: str, tmp_path: Path) -> None:
    third = ["--size-r", "8", "--angles", angles] if angles else []
    arguments = ["lambert_value", "--samples", "1000", "--size-p", "4", "--size-q", "8", *third]
    assert run(["factor", *arguments, "-o", str(tmp_path)]) == 0
    maps = read_factor_maps(tmp_path)
    assert (maps.name, maps.function) == ("lambert_value", SHADES[angles])
    l, v = directions(200, seed=8)
    inputs = {**maps.inputs(), "l": l, "v": v}
    shaded = np.asarray(evaluate(load_library(), maps.function, inputs, "float64"))
    assert np.abs(shaded * np.pi - l[:, 2:]).max() <= tolerance("half_vector_fit")


@pytest.mark.parametrize(
    "text",
    ["", "{}", '{"scale": [1, 2], "angles": ""}', '{"scale": [1], "angles": "up"}']
    + [f'{{"scale": [{scale}], "angles": ""}}' for scale in ("1e39", "0", "-1", "NaN")],
)
def test_a_foreign_description_gets_one_sentence(text: str, tmp_path: Path) -> None:
    (tmp_path / "factors.json").write_text(text)
    with pytest.raises(UserError, match=r'not what "vair factor" writes|is not valid JSON'):
        read_factor_maps(tmp_path)


@pytest.mark.parametrize("angles", ["", "along", "across"])
def test_the_emitted_function_computes_what_was_fitted(angles: str) -> None:
    truth = smooth_factors(3)
    y, x = np.mgrid[0:8, 0:8] / 8.0
    r = np.repeat(np.exp(-x * y)[..., None], 3, axis=2)
    factors = Factors(truth.scale, truth.p, truth.q, r, angles) if angles else truth
    maps = factor_maps("smooth", factors)
    l, v = directions(2000, seed=9)
    shaded = np.asarray(evaluate(load_library(), maps.function, {**maps.inputs(), "l": l, "v": v}, "float64"))
    assert np.abs(shaded - factors.value(l, v) * l[:, 2:]).max() <= tolerance("emitted_factors")
