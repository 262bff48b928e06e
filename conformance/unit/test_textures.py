"""Lookups in maps mean one thing, and nothing but a parameter is a map.

Plan.
  sources    a map is a parameter with its edges; everything else is refused with a place
  text       one parameter in GLSL, two in WGSL, three in OpenCL C; the packed lookup where it is needed
  meaning    texels at their centres, means between, edges, levels between and beyond; against the reference;
             float32, float64 and mpmath agree
  inputs     arrays that are no chain of levels get one sentence
  intervals  weights of the stated precision stay inside, weights that are further off do not
  packing    every level with its border, where lookup_level.cl expects it
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.backends import dialect
from codegen.emit.module import emit
from codegen.errors import SourceError, UserError
from codegen.evaluate import evaluate
from codegen.intervals import permitted
from codegen.library import Library, load_library
from conformance.reference import reference_for
from conformance.textures.maps import SIZES, chain, full_chain, places
from conformance.unit.support.sources import library_of
from targets.opencl.packed_levels import layout, packed
from targets.textures import TextureData

SEED = 20260802
PROBE = """
def probe(t: Annotated[Texture, Edges("{u}", "{v}")], uv: P, lod: X) -> vec4:
    \"\"\"A lookup.\"\"\"
    return lookup_level(t, uv, lod)

def base(t: Annotated[Texture, Edges("{u}", "{v}")], uv: P) -> vec4:
    \"\"\"A lookup.\"\"\"
    return lookup(t, uv)

def passed(t: Annotated[Texture, Edges("{u}", "{v}")], uv: P) -> vec4:
    \"\"\"A lookup through a call.\"\"\"
    return base(t, uv)

def rooted(t: Annotated[Texture, Edges("{u}", "{v}")], uv: P) -> f32:
    \"\"\"The root of a lookup.\"\"\"
    return sqrt(max(lookup(t, uv).x, 0.5))

def size(t: Annotated[Texture, Edges("{u}", "{v}")]) -> vec2:
    \"\"\"Its size.\"\"\"
    return texture_size(t)

def texel(t: Annotated[Texture, Edges("{u}", "{v}")], uv: P) -> vec2:
    \"\"\"A place in texels.\"\"\"
    return uv * texture_size(t)
"""
MAP = 't: Annotated[Texture, Edges("repeat", "clamp")]'


def probe(folder: Path, u: str = "repeat", v: str = "clamp") -> Library:
    return library_of(folder, PROBE.format(u=u, v=v))


def value(library: Library, name: str, inputs: dict[str, Any], arithmetic: str = "float64") -> Any:
    return np.asarray(evaluate(library, name, inputs, arithmetic)).astype(np.float64)


REFUSED = {
    "a map without its edges": ("def f(t: Texture) -> f32:\n    return 1.0\n", "state the domain"),
    "edges of a number": (
        'def f(x: Annotated[f32, Edges("repeat", "clamp")]) -> f32:\n    return x\n',
        "Edges is the domain of Texture",
    ),
    "an interval of a map": (
        "def f(t: Annotated[Texture, Interval(0.0, 1.0)]) -> f32:\n    return 1.0\n",
        "Edges is the domain of Texture",
    ),
    "an unknown edge": (
        'def f(t: Annotated[Texture, Edges("repeat", "mirror")]) -> f32:\n    return 1.0\n',
        'unknown edge "mirror"',
    ),
    "a local map": (f"def f({MAP}, uv: P) -> vec4:\n    s = t\n    return lookup(s, uv)\n", "pass it on"),
    "a chosen map": (
        f"def f({MAP}, s: Annotated[Texture, Edges('clamp', 'clamp')], uv: P) -> vec4:\n"
        "    return lookup(t if uv.x < 0.5 else s, uv)\n",
        "no expression chooses one",
    ),
    "a returned map": (f"def f({MAP}) -> Texture:\n    return t\n", "no function returns one"),
    "a sum of maps": (f"def f({MAP}) -> f32:\n    return t + t\n", "takes no"),
    "a lookup of numbers": (
        f"def f({MAP}, x: X) -> vec4:\n    return lookup(t, x)\n",
        "lookup takes no Texture, f32",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_maps_are_parameters_only(case: str, tmp_path: Path) -> None:
    text, told = REFUSED[case]
    with pytest.raises(SourceError, match=told):
        library_of(tmp_path, text.replace(":\n    ", ':\n    """F."""\n    ', 1)).function("f")


def test_text_of_every_target(tmp_path: Path) -> None:
    library = probe(tmp_path)
    texts = {target: emit(library, dialect(target), ["passed"]) for target in ("glsl", "wgsl", "opencl")}
    assert "vec4 vair_passed(sampler2D t, vec2 uv) {\n    return vair_base(t, uv);" in texts["glsl"]
    assert "return textureLod(t, uv, 0.0);" in texts["glsl"]
    assert (
        "fn vair_base(t: texture_2d<f32>, t_sampler: sampler, uv: vec2<f32>) -> vec4<f32> {" in texts["wgsl"]
    )
    assert "return textureSampleLevel(t, t_sampler, uv, 0.0);" in texts["wgsl"]
    assert "return vair_base(t, t_sampler, t_layout, uv);" in texts["opencl"]
    assert "return vair_lookup_level(t, t_sampler, t_layout, uv, 0.0f);" in texts["opencl"]
    assert "$" not in texts["opencl"]
    rooted = {target: emit(library, dialect(target), ["rooted"]) for target in ("glsl", "wgsl", "opencl")}
    assert "return sqrt(max(textureLod(t, uv, 0.0).x, 0.5));" in rooted["glsl"]
    assert "return sqrt(max(textureSampleLevel(t, t_sampler, uv, 0.0).x, 0.5));" in rooted["wgsl"]
    assert (
        "return sqrt(max(vair_lookup_level(t, t_sampler, t_layout, uv, 0.0f).x, 0.5f));" in rooted["opencl"]
    )
    sizes = {target: emit(library, dialect(target), ["size"]) for target in ("glsl", "wgsl", "opencl")}
    assert "return vec2(textureSize(t, 0));" in sizes["glsl"]
    assert "return vec2<f32>(textureDimensions(t));" in sizes["wgsl"]
    assert "return convert_float2(t_layout.xy);" in sizes["opencl"]
    assert "lookup_level" not in emit(load_library(), dialect("opencl"), ["sin_angle"])


def test_texels_at_centres_and_means_between(tmp_path: Path) -> None:
    library = probe(tmp_path)
    (level,) = chain(4, 2, 1, SEED)
    at = {"t": level, "uv": [[0.375, 0.25], [0.5, 0.25], [0.375, 0.5], [0.5, 0.5]]}
    got = value(library, "base", at)
    assert np.array_equal(got[0], level[0, 1])
    assert np.allclose(got[1], (level[0, 1].astype(float) + level[0, 2]) / 2)
    assert np.allclose(got[2], (level[0, 1].astype(float) + level[1, 1]) / 2)
    assert np.allclose(got[3], level[:, 1:3].astype(float).mean(axis=(0, 1)))


@pytest.mark.parametrize("arithmetic", ["float32", "float64", "mpmath"])
def test_sizes_are_those_of_the_largest_level(arithmetic: str, tmp_path: Path) -> None:
    library = probe(tmp_path)
    levels = chain(5, 3, 2, SEED)
    assert value(library, "size", {"t": levels}, arithmetic).tolist() == [[5.0, 3.0]]
    uv = [[0.25, 0.5], [1.0, 2.0]]
    places_in_texels = [[1.25, 1.5], [5.0, 6.0]]
    assert value(library, "texel", {"t": levels, "uv": uv}, arithmetic).tolist() == places_in_texels
    found = permitted(library, "texel", {"t": levels, "uv": uv}, "wgsl")
    assert found.contains(np.array(places_in_texels, np.float32)).all()
    assert not found.contains(np.array(places_in_texels, np.float32) + 1.0).any()


@pytest.mark.parametrize("edges", [("repeat", "clamp"), ("clamp", "repeat"), ("repeat", "repeat")])
def test_maps_go_on_beyond_their_edges(edges: tuple[str, str], tmp_path: Path) -> None:
    library = probe(tmp_path, *edges)
    (level,) = chain(4, 4, 1, SEED)
    uv = places(50, 4, 4, SEED)["uv"].astype(np.float64)
    inside = np.where(np.array(edges) == "repeat", uv - np.floor(uv), np.clip(uv, 0.0, 1.0))
    assert np.allclose(
        value(library, "base", {"t": level, "uv": uv}), value(library, "base", {"t": level, "uv": inside})
    )
    ends = value(library, "base", {"t": level, "uv": [[0.0, 0.375], [1.0, 0.375], [-5.0, 0.375]]})
    wanted = level[1, [0, 3]].astype(float).mean(axis=0) if edges[0] == "repeat" else level[1, 0]
    assert np.allclose(ends[0], wanted)
    assert np.allclose(ends[2], wanted)


def test_levels_between_and_beyond(tmp_path: Path) -> None:
    library = probe(tmp_path)
    levels = chain(4, 4, 3, SEED)
    uv = [[0.3, 0.6]] * 5
    got = value(library, "probe", {"t": levels, "uv": uv, "lod": [0.0, 1.0, 0.25, 7.0, -1.0]})
    first, second = got[0], got[1]
    assert np.allclose(got[2], 0.75 * first + 0.25 * second)
    assert np.allclose(got[3], levels[2][0, 0])
    assert np.array_equal(got[4], first)
    assert np.array_equal(first, value(library, "base", {"t": levels, "uv": uv})[0])


@pytest.mark.parametrize("size", SIZES)
def test_evaluations_agree(size: tuple[int, int], tmp_path: Path) -> None:
    library = probe(tmp_path)
    inputs = {"t": chain(*size, full_chain(*size), SEED), **places(20, *size, SEED)}
    exact = value(library, "probe", inputs, "mpmath")
    assert np.abs(value(library, "probe", inputs) - exact).max() < 2.0**-45
    assert np.abs(value(library, "probe", inputs, "float32") - exact).max() < 2.0**-14


def test_the_environment_agrees_with_its_reference() -> None:
    rng = np.random.Generator(np.random.PCG64(SEED))
    levels = chain(16, 8, 5, SEED)
    w = rng.normal(size=(2000, 3))
    w = (w / np.linalg.norm(w, axis=1)[:, None]).astype(np.float32)
    lod = rng.uniform(0.0, 7.0, 2000).astype(np.float32)
    got = value(load_library(), "environment_latlong", {"environment": levels, "w": w, "lod": lod})
    expected = reference_for("environment_latlong")(levels, w.astype(np.float64), lod.astype(np.float64))
    assert np.abs(got - expected).max() < 2.0**-20


BAD: dict[str, tuple[Any, str]] = {
    "a number": (1.0, "is a map: give an array"),
    "no level": ([], "is a map: give an array"),
    "three channels": (np.zeros((2, 2, 3)), r"level 0 has shape \(2, 2, 3\)"),
    "a level of the wrong size": ([np.zeros((4, 4, 4)), np.zeros((4, 2, 4))], r"\(2, 2, 4\) follows"),
    "too many levels": ([np.zeros((1, 1, 4))] * 2, "no more than its size allows"),
    "not a number": (np.full((1, 1, 4), np.nan), "holds 4 numbers that are not finite"),
}


@pytest.mark.parametrize("case", BAD)
def test_what_is_no_map_is_refused(case: str, tmp_path: Path) -> None:
    given, told = BAD[case]
    with pytest.raises(UserError, match=told):
        evaluate(probe(tmp_path), "base", {"t": given, "uv": [0.5, 0.5]})


def with_weights(level: Any, uv: Any, bits: int) -> Any:
    """A bilinear lookup that clamps, with places rounded to so many bits of a texel."""
    height, width = level.shape[:2]
    at = np.clip(uv, 0.0, 1.0) * (width, height) - 0.5
    at = np.round(at * 2.0**bits) / 2.0**bits
    i, f = np.floor(at).astype(int), (at - np.floor(at))[:, None]
    columns = [np.clip(i[:, 0] + k, 0, width - 1) for k in (0, 1)]
    rows = [np.clip(i[:, 1] + k, 0, height - 1) for k in (0, 1)]
    top, bottom = (level[r, columns[0]] * (1 - f[..., 0]) + level[r, columns[1]] * f[..., 0] for r in rows)
    return top * (1 - f[..., 1]) + bottom * f[..., 1]


@pytest.mark.parametrize("size", SIZES)
def test_permitted_values_hold_the_stated_weights(size: tuple[int, int], tmp_path: Path) -> None:
    library = probe(tmp_path, "clamp", "clamp")
    (level,) = chain(*size, 1, SEED)
    uv = places(100, *size, SEED)["uv"]
    inputs = {"t": level, "uv": uv}
    for table in ("vulkan", "wgsl", "glsl", "opencl"):
        found = permitted(library, "base", inputs, table)
        assert found.guaranteed.all()
        for bits in (4, 5, 8, 23):
            assert found.contains(with_weights(level.astype(float), uv.astype(float), bits)).all()
    if size == (16, 8):
        found = permitted(library, "base", inputs, "vulkan")
        assert not found.contains(with_weights(level.astype(float), uv.astype(float), 1)).all()
        assert np.median(np.asarray(found.high) - np.asarray(found.low)) < 0.3


def test_levels_lie_side_by_side_with_borders() -> None:
    levels = tuple(chain(4, 2, 3, SEED))
    texture = TextureData(levels, repeat_u=True)
    image = packed(texture)
    assert image.shape == (4, 6 + 4 + 3, 4)
    assert layout(texture).tolist() == [4, 2, 3, 1]
    assert np.array_equal(image[1:3, 1:5], levels[0])
    assert np.array_equal(image[1:2, 7:9], levels[1])
    assert np.array_equal(image[1, 11], levels[2][0, 0])
    assert np.array_equal(image[1:3, 0], levels[0][:, 3])
    assert np.array_equal(image[1:3, 5], levels[0][:, 0])
    assert np.array_equal(image[0, 1:5], levels[0][0])
    assert np.array_equal(image[3, 1:5], levels[0][1])
