"""Environment maps on the host: files, solid angles, resampling, chains and prefiltering."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np
import pytest

from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.library import load_library
from codegen.maps import latlong, mipmap, octahedral, paraboloid, prefilter
from codegen.maps.image import exr, read_pixels
from codegen.maps.image import png as as_png
from codegen.maps.radiance import read_radiance
from codegen.maps.undated import WRITTEN, undated_exr

DATA = Path(__file__).parents[2] / "examples" / "data"
ROUNDING = 1e-12
"""Float64 sums over a map's texels."""
FLOAT32 = 2.0**-22
"""A few roundings to float32, as the library's functions make them."""
CLAMPED_EDGE = np.pi / 64
"""The midpoint rule at the edge of a clamped lobe: one row of texels of a map of 64 rows."""
REDUCED = 1.0 / prefilter.TEXELS_ACROSS**3
"""A smooth lobe sampled this many times across: the midpoint rule errs by far less than its first order."""


def smooth(height: int, width: int) -> np.ndarray:
    """A map whose value is a polynomial of the direction: what it should look like anywhere is known."""
    return polynomial(latlong.directions(height, width))


def polynomial(w: np.ndarray) -> np.ndarray:
    x, y, z = w[..., 0], w[..., 1], w[..., 2]
    return np.stack([2.0 + x, 1.5 + 0.5 * y * z, 1.0 + 0.25 * x * y - 0.5 * z], axis=-1)


def resampled(width: int, size: int) -> float:
    """What two bilinear filters change of a polynomial of degree 2: second differences of both grids."""
    return (2.0 * np.pi / width) ** 2 + (2.0 * paraboloid.BORDER / size) ** 2


def png(folder: Path, code: int) -> Path:
    """A 1 x 1 grey PNG."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    path = folder / "grey.png"
    header = chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 0, 0, 0, 0))
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", zlib.compress(bytes([0, code]))) + chunk(b"IEND", b"")
    )
    return path


# ------------------------------------------------------------------------------------------------ files


def test_pixels_survive_writing_and_reading(tmp_path: Path) -> None:
    pixels = np.random.default_rng(1).uniform(0.0, 1e4, (5, 7, 3)).astype(np.float32)
    (tmp_path / "a.exr").write_bytes(exr(pixels))
    assert np.array_equal(read_pixels(tmp_path / "a.exr"), pixels)


def test_integers_are_decoded_only_where_light_is_wanted(tmp_path: Path) -> None:
    path = png(tmp_path, 188)
    assert read_pixels(path).shape == (1, 1, 3)
    assert read_pixels(path)[0, 0, 0] == np.float32(188 / 255)
    linear = ((188 / 255 + 0.055) / 1.055) ** 2.4
    assert abs(read_pixels(path, linear=True)[0, 0, 1] - linear) <= FLOAT32


def test_files_do_not_tell_when_they_were_written(tmp_path: Path) -> None:
    """OpenImageIO writes the second; two runs then differed wherever a second passed between them."""
    pixels = np.random.default_rng(5).random((3, 5, 3)).astype(np.float32)
    dated, undated = exr(pixels), undated_exr(pixels)
    assert undated.count(WRITTEN) == 1 and WRITTEN not in dated
    assert len(undated) == len(dated)
    places = [k for k in range(len(dated)) if dated[k] != undated[k]]
    assert undated.index(WRITTEN) <= places[0] and places[-1] < undated.index(WRITTEN) + len(WRITTEN)
    (tmp_path / "a.exr").write_bytes(undated)
    assert (read_pixels(tmp_path / "a.exr") == pixels).all()


def test_a_header_that_is_no_text_gets_a_sentence(tmp_path: Path) -> None:
    """OpenImageIO tells of it in the bytes of the file, which are no UTF-8."""
    whole = exr(np.ones((2, 2, 3)))
    broken = whole.replace(b"screenWindowWidth\0float", b"screenWindowWidth\0\x93\xffoat")
    assert broken != whole
    (tmp_path / "a.exr").write_bytes(broken)
    with pytest.raises(UserError, match="cannot read"):
        read_pixels(tmp_path / "a.exr")


def test_what_a_library_prints_of_an_image_is_not_shown(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    whole = as_png(np.ones((8, 8, 3)))
    (tmp_path / "a.png").write_bytes(whole[:40] + b"\xff" * 8 + whole[48:])
    with pytest.raises(UserError, match="cannot read"):
        read_pixels(tmp_path / "a.png")
    assert capfd.readouterr().err == ""


def test_what_is_no_image_gets_one_sentence(tmp_path: Path) -> None:
    text = tmp_path / "notes.exr"
    text.write_text("not an image")
    whole = DATA / "dawn.exr"
    cut = tmp_path / "cut.exr"
    cut.write_bytes(whole.read_bytes()[:20000])
    for path in (tmp_path / "absent.exr", tmp_path, text, cut):
        with pytest.raises(UserError) as caught:
            read_pixels(path)
        assert str(path) in str(caught.value) and "\n" not in str(caught.value)


def test_values_that_are_no_radiance_are_refused_with_count_and_place(tmp_path: Path) -> None:
    pixels = np.ones((4, 8, 3), np.float32)
    pixels[1, 2, 1], pixels[3, 0, 0], pixels[3, 7, 2] = np.nan, -0.5, np.inf
    pixels[0, 0, 0] = 7.0
    (tmp_path / "bad.exr").write_bytes(exr(pixels))
    with pytest.raises(
        UserError, match=r"bad\.exr: 3 pixels are no radiance, first row 1, column 2: G = nan"
    ):
        read_radiance(tmp_path / "bad.exr")
    mended = read_radiance(tmp_path / "bad.exr", clean=True)
    assert (mended[1, 2, 1], mended[3, 0, 0], mended[3, 7, 2]) == (0.0, 0.0, 7.0)


@pytest.mark.parametrize("name", ["dawn", "venice", "studio"])
def test_the_carried_maps_are_whole(name: str) -> None:
    pixels = read_radiance(DATA / f"{name}.exr", clean=True)
    assert pixels.shape == (256, 512, 3) and np.isfinite(pixels).all()


# --------------------------------------------------------------------------------------- solid angles


@pytest.mark.parametrize("size", [(1, 1), (1, 2), (16, 32), (256, 512)])
def test_latitude_longitude_texels_fill_the_sphere(size: tuple[int, int]) -> None:
    assert abs(latlong.solid_angles(*size).sum() * size[1] / (4.0 * np.pi) - 1.0) <= ROUNDING


def test_the_host_maps_directions_as_the_library_does() -> None:
    library = load_library()
    w = latlong.directions(16, 32).reshape(-1, 3)
    uv = np.asarray(evaluate(library, "latlong_uv", {"w": w}, "float64"))
    assert np.abs(uv - latlong.coordinates(w.astype(np.float32).astype(np.float64))).max() <= FLOAT32
    s, t = paraboloid.points(16, 1.2)
    for side in (paraboloid.FRONT, paraboloid.BACK):
        w = paraboloid.directions(s, t, side).reshape(-1, 3)
        inside = (s * s + t * t).ravel() < 1.0
        found = evaluate(library, "dual_paraboloid_uv", {"w": w, "border": np.full(len(w), 1.2)}, "float64")
        assert isinstance(found, dict)
        texels = np.stack([(s.ravel() / 1.2 + 1.0) / 2.0, (t.ravel() / 1.2 + 1.0) / 2.0], axis=-1)
        assert np.abs(np.asarray(found["uv"]) - texels)[inside].max() <= FLOAT32
        assert (np.asarray(found["back"])[inside] == (side == paraboloid.BACK)).all()
    uv = octahedral.points(16).reshape(-1, 2)
    w = np.asarray(evaluate(library, "octahedral_decode", {"uv": uv}, "float64"))
    assert np.abs(w - octahedral.directions(uv)).max() <= FLOAT32


# ------------------------------------------------------------------------------- resampling and chains


def test_paraboloid_discs_show_the_map_also_beyond_the_rim() -> None:
    discs = paraboloid.from_latlong(smooth(128, 256), size=64)
    s, t = paraboloid.points(64, paraboloid.BORDER)
    for disc, side in zip(discs, (paraboloid.FRONT, paraboloid.BACK), strict=True):
        expected = polynomial(paraboloid.directions(s, t, side))
        assert np.abs(disc - expected).max() <= resampled(256, 64)


def test_a_lookup_across_the_rim_of_an_octahedral_map_is_continuous() -> None:
    size = 64
    level = octahedral.from_latlong(smooth(128, 256), size)
    wide = octahedral.bordered(level)
    flat = octahedral.points(size)
    # Every texel of the border lies beside its inner neighbour on the sphere, at most 4 / size away, and
    # the map's slope is at most 2.
    step = 2.0 * 4.0 / size
    pairs = [(wide[0], wide[1]), (wide[-1], wide[-2]), (wide[:, 0], wide[:, 1]), (wide[:, -1], wide[:, -2])]
    assert flat.shape == (size, size, 2)
    for outside, inside in pairs:
        assert np.abs(outside - inside).max() <= step


def test_a_chain_keeps_the_mean_over_solid_angle_at_every_level() -> None:
    pixels = np.random.default_rng(2).uniform(0.0, 5.0, (48, 96, 3))
    weights = np.broadcast_to(latlong.solid_angles(48, 96)[:, None], (48, 96))
    mean = (pixels * weights[..., None]).sum((0, 1)) / weights.sum()
    levels = mipmap.chain(pixels, weights)
    assert [level.shape[:2] for level in levels] == [
        (48, 96),
        (24, 48),
        (12, 24),
        (6, 12),
        (3, 6),
        (1, 3),
        (1, 1),
    ]
    assert np.abs(levels[-1][0, 0] - mean).max() <= ROUNDING * pixels.max()


def test_chains_of_odd_sizes_average_whole_areas() -> None:
    level = np.arange(5, dtype=np.float64)[None, :, None]
    (_, smaller, last) = mipmap.chain(level)
    # 5 texels become 2 of 2.5 each: (0 + 1 + 2/2) / 2.5 and (2/2 + 3 + 4) / 2.5
    assert np.abs(smaller[0, :, 0] - [0.8, 3.2]).max() <= ROUNDING
    assert abs(last[0, 0, 0] - 2.0) <= ROUNDING
    assert len(mipmap.chain(np.ones((1, 1, 3)))) == 1


# ------------------------------------------------------------------------------------------ prefiltering


@pytest.mark.parametrize("exponent", [0.0, 1.0, 2.5, 10.0])
def test_prefiltering_a_constant_map_changes_nothing(exponent: float) -> None:
    r = latlong.directions(4, 8).reshape(-1, 3)
    found = prefilter.convolved(np.full((64, 128, 3), 2.5), exponent, r)
    assert np.abs(found / 2.5 - 1.0).max() <= CLAMPED_EDGE


def test_prefiltering_agrees_with_the_sum_over_every_texel() -> None:
    pixels = read_radiance(DATA / "dawn.exr", clean=True)
    w = latlong.directions(256, 512).reshape(-1, 3)
    weighted = (pixels * latlong.solid_angles(256, 512)[:, None, None]).reshape(-1, 3)
    r = latlong.directions(3, 5).reshape(-1, 3)
    for exponent in (10.0, 100.0):
        lobe = np.maximum(r @ w.T, 0.0) ** exponent
        truth = lobe @ weighted * (exponent + 1.0) / (2.0 * np.pi)
        found = prefilter.convolved(pixels, exponent, r)
        assert np.sqrt(((found - truth) ** 2).mean() / (truth**2).mean()) <= REDUCED
