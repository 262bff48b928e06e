"""Lookups in maps give the same value on every target.

Plan. Random maps of all shapes and one with a single hot texel, repeated and clamped edges, places inside,
outside, on centres and edges, levels between and beyond: every result is one that the specification permits,
and on drivers of textures/filtering.toml within the declared error of the float64 evaluation. A function of
the library, with its reference. More than one map in a function; sizes of maps.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.execute import execute
from codegen.intervals import DEFAULT_TABLES, permitted
from codegen.kernels import KernelOptions
from codegen.library import load_library
from conformance.reference import reference_for
from conformance.textures.filtering import declared
from conformance.textures.maps import SIZES, chain, full_chain, places
from conformance.unit.support.sources import library_of
from targets import TimedRuntime

SEED = 20260803
COUNT = 200
PROBE = """
def probe(t: Annotated[Texture, Edges("{u}", "{v}")], uv: P, lod: X) -> vec4:
    \"\"\"A lookup.\"\"\"
    return lookup_level(t, uv, lod)

def blend(
    a: Annotated[Texture, Edges("{u}", "{v}")], uv: P, b: Annotated[Texture, Edges("{v}", "{u}")]
) -> vec4:
    \"\"\"Two maps.\"\"\"
    return lookup(a, uv) + 2.0 * lookup(b, uv.yx)

def sizes(a: Annotated[Texture, Edges("{u}", "{v}")], b: Annotated[Texture, Edges("{v}", "{u}")]) -> vec4:
    \"\"\"Sizes of two maps.\"\"\"
    return vec4(texture_size(a), texture_size(b))
"""


def judge(got: Any, exact: Any, largest: float, runtime: TimedRuntime) -> None:
    bound = declared(runtime.device)
    assert np.isfinite(got).all()
    assert bound is None or np.abs(got - exact).max() <= bound * largest


@pytest.mark.parametrize("edges", [("repeat", "clamp"), ("clamp", "repeat")])
@pytest.mark.parametrize("size", SIZES)
def test_lookups(
    size: tuple[int, int], edges: tuple[str, str], runtime: TimedRuntime, tmp_path: Path
) -> None:
    library = library_of(tmp_path, PROBE.format(u=edges[0], v=edges[1]))
    for hot in (False, True):
        levels = chain(*size, full_chain(*size), SEED, hot=hot)
        inputs = {"t": levels, **places(COUNT, *size, SEED)}
        got = execute(library, "probe", inputs, runtime)
        judge(got, evaluate(library, "probe", inputs, "float64"), float(levels[0].max()), runtime)
        found = permitted(library, "probe", inputs, DEFAULT_TABLES[runtime.device.target])
        assert found.contains(got).all()


def test_two_maps(runtime: TimedRuntime, tmp_path: Path) -> None:
    library = library_of(tmp_path, PROBE.format(u="repeat", v="clamp"))
    inputs = {
        "a": chain(16, 8, 2, SEED),
        "b": chain(5, 3, 1, SEED + 1),
        "uv": places(COUNT, 16, 8, SEED)["uv"],
    }
    judge(
        execute(library, "blend", inputs, runtime),
        evaluate(library, "blend", inputs, "float64"),
        3.0,
        runtime,
    )


def test_sizes_of_maps(runtime: TimedRuntime, tmp_path: Path) -> None:
    library = library_of(tmp_path, PROBE.format(u="repeat", v="clamp"))
    inputs = {"a": chain(16, 8, 3, SEED), "b": chain(5, 3, 1, SEED)}
    got = np.asarray(execute(library, "sizes", inputs, runtime))
    assert got.tolist() == [[16.0, 8.0, 5.0, 3.0]] * len(got)


def test_environment(runtime: TimedRuntime) -> None:
    rng = np.random.Generator(np.random.PCG64(SEED))
    w = rng.normal(size=(4000, 3))
    w = (w / np.linalg.norm(w, axis=1)[:, None]).astype(np.float32)
    lod = rng.uniform(0.0, 9.0, 4000).astype(np.float32)
    levels = chain(64, 32, 7, SEED)
    got = execute(load_library(), "environment_latlong", {"environment": levels, "w": w, "lod": lod}, runtime)
    exact = reference_for("environment_latlong")(levels, w.astype(np.float64), lod.astype(np.float64))
    (bound,) = load_library().bounds["environment_latlong"]
    assert declared(runtime.device) is None or np.abs(got - exact).max() <= bound.bound


def test_maps_need_a_plain_kernel(runtime: TimedRuntime, tmp_path: Path) -> None:
    library = library_of(tmp_path, PROBE.format(u="repeat", v="clamp"))
    inputs = {"t": chain(2, 2, 1, SEED), "uv": [0.5, 0.5], "lod": 0.0}
    with pytest.raises(UserError, match="reads maps"):
        execute(library, "probe", inputs, runtime, options=KernelOptions(form="pair"))
