"""The functions that read environment maps are complete and generated, and their reference is sound.

Plan. The sources below shaderlib/environment are what the template gives; every lobe has every estimator,
with the library's parameters. The reference, which tests on drivers trust, agrees with the lookups of
conformance/light away from the rim, is continuous across it, and finds a constant sky at every level. What
`vair env` prepares, the functions read: directions keep their axes. Estimators keep in float32 what they
promise beside their bounds: of few samples, about the step of the guard, at the limit, at the corners, and
with quotients and roots off in their last bits.
"""

import numpy as np
import pytest

from codegen.estimators import estimator_sources
from codegen.evaluate import evaluate
from codegen.library import default_root, load_library
from codegen.maps import latlong
from codegen.maps.prepared import Settings, levels
from conformance.light.environment import Environment
from conformance.reference import reference_for
from conformance.reference.environment import BLEND_HEIGHT, ESTIMATORS
from conformance.reference.lobes import LOBES
from conformance.textures.environments import looks, paraboloid, parameters, views
from conformance.textures.estimators import is_estimator, keeps_promises, peak_inputs

SEED = 20260808
LIBRARY = load_library()
USUAL = ("env_guarded_lambert", "env_monte_carlo_phong", "env_grid_blinn_phong")
"""What a normal run holds to its promises; the others stand in the nightly one."""
SUMS = [name for name in LIBRARY.documented if is_estimator(name)]
(RADIANCE,) = LIBRARY.bounds["env_radiance"]
COUNT = 400
CLEAR_OF_STEPS = 0.3
"""Least component of a direction that a map of 32 texels looks up without a texel of the other octants."""


@pytest.mark.parametrize(("path", "text"), list(estimator_sources()), ids=lambda x: x.split("\n")[0])
def test_sources_are_what_the_template_gives(path: str, text: str) -> None:
    assert (default_root() / path).read_text(encoding="utf-8") == text, "run python -m codegen.generate"


@pytest.mark.parametrize("lobe", LOBES)
@pytest.mark.parametrize("estimator", ESTIMATORS)
def test_every_lobe_has_every_estimator(estimator: str, lobe: str) -> None:
    names = [p.name for p in LIBRARY.function(f"env_{estimator}_{lobe}").parameters]
    assert names == ["env", "frame", "v", "samples", "shift", *LOBES[lobe]]


def test_reference_agrees_with_other_lookups_away_from_the_rim() -> None:
    rng = np.random.Generator(np.random.PCG64(SEED))
    here = Environment(rng.random((16, 32, 3)), size=16)
    levels = [np.concatenate(list(level), axis=1) for level in here.levels]
    asked = {name: values.astype(np.float64) for name, values in looks(COUNT, SEED).items()}
    far = np.abs(asked["w"][:, 2]) > BLEND_HEIGHT
    got = reference_for("env_radiance")(levels, asked["w"][far], asked["lod"][far])
    assert np.abs(got - here.radiance(asked["w"][far], asked["lod"][far])).max() <= RADIANCE.bound


def test_reference_is_continuous_across_the_rim() -> None:
    turns = np.linspace(0.0, 2.0 * np.pi, 64)
    env = paraboloid(32, "random", SEED)
    for level in range(8):
        sides = [
            reference_for("env_radiance")(
                env,
                np.stack([np.cos(turns), np.sin(turns), np.full(64, z)], axis=-1),
                np.full(64, float(level)),
            )
            for z in (1e-9, -1e-9)
        ]
        assert np.abs(sides[0] - sides[1]).max() <= RADIANCE.bound


@pytest.mark.parametrize("lobe", ["lambert", "phong", "ggx", "strand"])
def test_reference_of_a_constant_sky_does_not_depend_on_levels(lobe: str) -> None:
    env = [np.ones_like(level) for level in paraboloid(8, "black", SEED)]
    shaded = views(40, SEED)
    given = [shaded[name] for name in ("frame", "v", "samples", "shift")]
    values = parameters(LOBES[lobe], 40, SEED)
    found = [
        reference_for(f"env_{estimator}_{lobe}")(env, *given, *values.values())
        for estimator in ("monte_carlo", "filtered", "guarded")
    ]
    assert found[0].any()
    for other in found[1:]:
        assert np.abs(other - found[0]).max() <= RADIANCE.bound


@pytest.mark.parametrize("name", ["env_radiance", "env_prefiltered"])
def test_prepared_maps_keep_their_axes(name: str) -> None:
    pixels = (latlong.directions(32, 64) > 0.0).astype(np.float32)
    chain = [np.concatenate([x, x[..., :1]], axis=-1) for x in levels(pixels, Settings(size=32))]
    w = looks(COUNT, SEED)["w"]
    w = w[np.abs(w).min(axis=1) > CLEAR_OF_STEPS]
    inputs = {"env": chain, "w": w} | ({"lod": np.zeros(len(w))} if name == "env_radiance" else {})
    assert len(w) > 0
    assert np.abs(evaluate(LIBRARY, name, inputs) - (w > 0.0)).max() <= RADIANCE.bound


@pytest.mark.parametrize(
    "name", [n if n in USUAL else pytest.param(n, marks=pytest.mark.nightly) for n in SUMS]
)
def test_estimators_keep_what_they_promise(name: str) -> None:
    assert keeps_promises(LIBRARY, name)


def test_views_about_the_step_of_the_guard_are_filtered_on_one_side() -> None:
    """Half of the views each: there the guarded estimator is the filtered one, here the unfiltered one."""
    inputs = peak_inputs("env_guarded_ggx")
    guarded, filtered, plain = (
        np.asarray(evaluate(LIBRARY, f"env_{estimator}_ggx", inputs))
        for estimator in ("guarded", "filtered", "monte_carlo")
    )
    half = len(guarded) // 2
    assert np.array_equal(guarded[half:], filtered[half:])
    assert np.abs(guarded[:half] - plain[:half]).max() <= RADIANCE.bound
    assert np.abs(filtered[:half] - plain[:half]).max() > RADIANCE.bound
