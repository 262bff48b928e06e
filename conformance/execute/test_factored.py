"""Factored reflectances and tables over angles, as every driver executes them.

Plan.
  tables     the strand cosine from 256 x 256 texels against the cosine itself, within the declared bound; the
             ends of the axes; results that the specification permits
  factors    random factors, whose neighbouring texels differ as much as they can, against the reference
  degenerate l below the surface: 0; v below it, and l = -v: finite, the documented value
  symmetry   the same for light and viewer exchanged, once the cosine is divided out
  material   the published satin, where its files are: symmetric, and as anisotropic as published

Drivers without a declared filter (textures/filtering.toml) are held to their specification alone.
"""

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from codegen.execute import execute
from codegen.factors.maps import read_factor_maps
from codegen.intervals import DEFAULT_TABLES, permitted
from codegen.library import load_library
from codegen.tables.arguments import two_arguments
from codegen.tables.tabulate import made
from conformance.check.features import applies
from conformance.factored.published import SATIN, WATERLOO, cosine_weighted, viewer
from conformance.reference import ambiguous, reference_for
from conformance.textures.filtering import declared
from conformance.textures.readers import SHADES, cosines, directions, factors
from conformance.unit.support.tolerances import tolerance
from targets import TimedRuntime

Array = npt.NDArray[Any]
COUNT = 20_000


def test_the_strand_cosine_from_a_table(runtime: TimedRuntime) -> None:
    library = load_library()
    x, y, function = two_arguments(library, "strand_cosine", {})
    table = made(replace(x, warp="angle"), replace(y, warp="angle"), function, 256, 256)
    levels = [np.repeat(table.values[:, :, None], 4, axis=2)]
    cos_l, cos_v = cosines(COUNT)
    inputs = {"table": levels, "cos_l": cos_l, "cos_v": cos_v}
    got = np.asarray(execute(library, "strand_cosine_table", inputs, runtime))
    l, v = cos_l.astype(np.float64), cos_v.astype(np.float64)
    exact = np.sqrt((1.0 - l) * (1.0 + l) * (1.0 - v) * (1.0 + v)) - l * v
    (bound,) = library.bounds["strand_cosine_table"]
    assert np.isfinite(got).all()
    if declared(runtime.device) is not None:
        assert np.abs(got - exact).max() <= bound.bound
        stated = reference_for("strand_cosine_table")(levels, cos_l, cos_v)
        assert np.abs(got - stated).max() <= bound.bound - table.error
    few = {"table": levels, "cos_l": cos_l[::200], "cos_v": cos_v[::200]}
    found = permitted(library, "strand_cosine_table", few, DEFAULT_TABLES[runtime.device.target])
    assert found.contains(got[::200]).all()


@pytest.mark.parametrize("name", SHADES)
def test_shades_of_factors(name: str, runtime: TimedRuntime) -> None:
    library = load_library()
    l, v = directions(COUNT)
    inputs = {**factors(name), "l": l, "v": v}
    got = np.asarray(execute(library, name, inputs, runtime))
    assert np.isfinite(got).all()
    assert (got[l[:, 2] <= 0.0] == 0.0).all()
    maps = [inputs[k] for k in "pqr" if k in inputs]
    exact = reference_for(name)(*maps, l, v, np.ones((COUNT, 3)))
    (bound,) = library.bounds[name]
    judged = applies(bound, {"l": l, "v": v}, COUNT) & ~ambiguous(name, {"l": l, "v": v})
    assert judged.sum() > COUNT / 2
    if declared(runtime.device) is not None:
        assert np.abs(got - exact)[judged].max() <= bound.bound
    few = {**inputs, "l": l[::100], "v": v[::100]}
    found = permitted(library, name, few, DEFAULT_TABLES[runtime.device.target])
    assert found.contains(got[::100]).all()


@pytest.mark.parametrize("name", SHADES)
def test_degenerate_directions(name: str, runtime: TimedRuntime) -> None:
    library = load_library()
    slanted = [0.48, 0.6, 0.64]
    flat = [0.6, 0.8, 0.0]
    up, down = [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]
    rows = [(flat, [-0.6, -0.8, 0.0]), (up, down), (down, up), (slanted, [-0.48, -0.6, -0.64]), (up, flat)]
    rows += [(flat, up), (up, [1.0, 0.0, 0.0]), (up, [-1.0, -0.0, -0.0]), (slanted, [0.6, 0.48, -0.64])]
    l, v = (np.array(column, np.float32) for column in zip(*rows, strict=True))
    inputs = {**factors(name), "l": l, "v": v}
    got = np.asarray(execute(library, name, inputs, runtime))
    assert np.isfinite(got).all()
    dark = l[:, 2] <= 0.0
    assert (got[dark] == 0.0).all() and (got[~dark] > 0.0).all()
    exact = reference_for(name)(*(inputs[k] for k in "pqr" if k in inputs), l, v, np.ones((len(rows), 3)))
    if declared(runtime.device) is not None:
        assert np.abs(got - exact).max() <= library.bounds[name][0].bound


def test_light_and_viewer_may_be_exchanged(runtime: TimedRuntime) -> None:
    l, v = directions(2000)
    l, v = (np.where(w[:, 2:] < 0.0, -w, w) for w in (l, v))
    inputs = factors("factored_shade")
    there, back = (
        np.asarray(execute(load_library(), "factored_shade", {**inputs, "l": a, "v": b}, runtime))
        for a, b in ((l, v), (v, l))
    )
    assert np.abs(there * v[:, 2:] - back * l[:, 2:]).max() <= tolerance("exchanged_factors")


@pytest.mark.skipif(not WATERLOO.is_dir(), reason="the Waterloo data are not carried; see CREDITS.md")
@pytest.mark.parametrize("material", ["satin", "garnetred"])
def test_published_materials(material: str, runtime: TimedRuntime) -> None:
    maps = read_factor_maps(WATERLOO / material)
    l = cosine_weighted(64).astype(np.float32)
    for azimuth, expected in SATIN.items():
        v = viewer(azimuth).astype(np.float32)
        inputs = {**maps.inputs(), "l": l, "v": v}
        got = np.asarray(execute(load_library(), maps.function, inputs, runtime))
        swapped = {**maps.inputs(), "l": v, "v": l}
        back = np.asarray(execute(load_library(), maps.function, swapped, runtime))
        assert np.abs(got * v[2] - back * l[:, 2:]).max() <= tolerance("exchanged_factors") * maps.scale.max()
        if material == "satin":
            mean = float((got / l[:, 2:]).mean())
            assert abs(mean - expected) <= tolerance("satin_mean"), azimuth
