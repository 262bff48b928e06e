"""Exact and structural properties of sequences, shells, fins and maps on every target.

Plan. On the device:
  sequences   2^20 indices each, and 2^32 - 1, bit for bit as exact integer arithmetic gives them
  shells      shadow and height exact at both ends; a strand mask in [0, 1] that falls with height and repeats
  fins        fin_opacity <= fin_opacity_surface
  maps        direction -> uv -> direction within 2e-6 rad on all families; solid angles sum to the sphere and
              equal the numeric Jacobian of the float64 map
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.library import load_library
from conformance import cases
from conformance.reference import maps, sampling
from conformance.statistics.device import device_call
from conformance.statistics.evaluator import Array
from conformance.statistics.sphere_maps import solid_angle_per_area, texel_centres
from targets import TimedRuntime

CHECKS: dict[str, Any] = tomllib.loads(
    Path(__file__).with_name("scene_statistics.toml").read_text(encoding="utf-8")
)
LIBRARY = load_library()
SEED = 20_100
EDGE_ON = 1e-3
"""Sine of the angle between view and fin below which no plane holds both."""
ABOVE_RIM = 1e-3
"""Height on a paraboloid map above which its derivative exists: the two maps meet at 0."""
MAP_FAMILIES = ("uniform", "axis_aligned", "near_axes", "map_equators", "map_poles", "latlong_seam")


def indices() -> Any:
    """The first 2^20 words, and the last."""
    count = CHECKS["sequences"]["indices"]
    return np.concatenate([np.arange(count), [2**32 - 1]]).astype(np.uint32)


@pytest.mark.parametrize(
    ("name", "argument"),
    [("radical_inverse_base2", "i"), ("unit_float", "bits"), ("r2_sequence", "i"), ("pcg_hash", "x")],
)
def test_sequences_are_bit_exact(runtime: TimedRuntime, name: str, argument: str) -> None:
    got = device_call(LIBRARY, runtime)(name, {argument: indices()})
    np.testing.assert_array_equal(got, sampling.REFERENCES[name](indices()))


@pytest.mark.parametrize("points", [1 << 20, 1_000_003, 40])
def test_hammersley_is_bit_exact(runtime: TimedRuntime, points: int) -> None:
    i = np.arange(min(points, 1 << 20), dtype=np.uint32)
    n = (
        np.full(len(i), max(points, 1), dtype=np.uint32)
        if points <= 1 << 20
        else np.full(len(i), 1 << 20, np.uint32)
    )
    got = device_call(LIBRARY, runtime)("hammersley", {"i": i, "n": n})
    np.testing.assert_array_equal(got, sampling.hammersley(i, n))


def test_hashes_of_cells_are_bit_exact(runtime: TimedRuntime) -> None:
    i = indices()
    x = np.stack([i, i[::-1], i * np.uint32(2654435761)], axis=1)
    np.testing.assert_array_equal(device_call(LIBRARY, runtime)("pcg3d", {"x": x}), sampling.pcg3d(x))


def test_unit_floats_stay_below_one(runtime: TimedRuntime) -> None:
    bits = np.arange(2**32 - 1000, 2**32, dtype=np.uint64).astype(np.uint32)
    assert device_call(LIBRARY, runtime)("unit_float", {"bits": bits}).max() < 1.0


def test_shifts_on_the_grid_are_exact(runtime: TimedRuntime) -> None:
    words = np.random.Generator(np.random.Philox(SEED)).integers(0, 1 << 24, (200_000, 4))
    pairs = words * 2.0**-24
    points = cases.load("shifted_pairs")
    u = np.concatenate([pairs[:, :2], points["u"]])
    shift = np.concatenate([pairs[:, 2:], points["shift"]])
    got = device_call(LIBRARY, runtime)("cranley_patterson", {"u": u, "shift": shift})
    np.testing.assert_array_equal(got, sampling.cranley_patterson(u, shift))


def test_shadow_and_height_are_exact_at_their_ends(runtime: TimedRuntime) -> None:
    call = device_call(LIBRARY, runtime)
    lowest = np.arange(1 << 16) * 2.0**-16
    count = len(lowest)
    np.testing.assert_array_equal(call("shell_shadow", {"height": np.zeros(count), "s_min": lowest}), lowest)
    np.testing.assert_array_equal(call("shell_shadow", {"height": np.ones(count), "s_min": lowest}), 1.0)
    layers = np.arange(1, 1 << 16, dtype=np.uint32)
    top = call("shell_height", {"layer": layers - 1, "layers": layers})
    np.testing.assert_array_equal(top, np.where(layers > 1, 1.0, 0.0))
    np.testing.assert_array_equal(call("shell_height", {"layer": 0 * layers, "layers": layers}), 0.0)


def mask_inputs(points: int) -> dict[str, Any]:
    """Random places and coats without a height."""
    function = LIBRARY.function("shell_strand_mask")
    return cases.draw(function, "uniform", points, SEED)


def test_strand_mask_tapers(runtime: TimedRuntime) -> None:
    call, check = device_call(LIBRARY, runtime), CHECKS["mask"]
    inputs = mask_inputs(check["points"])
    before = np.ones(check["points"])
    for height in np.linspace(0.0, 1.0, check["heights"]):
        inputs["height"] = np.full(check["points"], height, dtype=np.float32)
        mask = call("shell_strand_mask", inputs)
        np.testing.assert_array_equal(mask, call("shell_strand_mask", inputs))
        assert ((mask >= 0.0) & (mask <= 1.0)).all()
        assert (mask <= before).all(), height
        before = mask


def test_strand_mask_depends_on_the_seed(runtime: TimedRuntime) -> None:
    call = device_call(LIBRARY, runtime)
    inputs = mask_inputs(CHECKS["mask"]["points"])
    inputs["height"] = np.zeros_like(inputs["height"])
    first = call("shell_strand_mask", inputs)
    other = call("shell_strand_mask", inputs | {"seed": inputs["seed"] ^ np.uint32(1)})
    assert (first != other).any()


@pytest.mark.parametrize("family", ["uniform", "near_orthogonal", "fins_edge_on"])
def test_fins_are_never_above_the_slides_bound(runtime: TimedRuntime, family: str) -> None:
    call = device_call(LIBRARY, runtime)
    inputs = cases.draw(LIBRARY.function("fin_opacity"), family, 50_000, SEED)
    v, n_fin = (np.asarray(inputs[key], np.float64) for key in ("v", "n_fin"))
    # the surface normal in the plane of v and n_fin is the worst: |cos(v, n_fin)| = sin(v, n)
    across = np.cross(np.cross(v, n_fin), n_fin)
    size = np.linalg.norm(across, axis=1, keepdims=True)
    n = np.where(size > EDGE_ON, across / np.maximum(size, EDGE_ON), np.roll(n_fin, 1, axis=1))
    n -= np.sum(n * n_fin, axis=1, keepdims=True) * n_fin
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    fin = call("fin_opacity", {"v": v, "n_fin": n_fin})
    surface = call("fin_opacity_surface", {"v": v, "n": n})
    assert (fin - surface).max() <= CHECKS["fins"]["excess"]


def there_and_back(call: Any, name: str, w: Array) -> Array:
    """Direction -> uv -> direction on the device."""
    if name == "dual_paraboloid":
        border = np.full(len(w), 1.2)
        found = call("dual_paraboloid_uv", {"w": w, "border": border})
        inputs = {"uv": found["uv"], "back": found["back"], "border": border}
        return np.asarray(call("dual_paraboloid_direction", inputs))
    forward, back = {
        "octahedral": ("octahedral_encode", "octahedral_decode"),
        "latlong": ("latlong_uv", "latlong_direction"),
        "parabolic": ("parabolic_uv", "parabolic_direction"),
    }[name]
    return np.asarray(call(back, {"uv": call(forward, {"w": w})}))


@pytest.mark.parametrize("family", MAP_FAMILIES)
@pytest.mark.parametrize("name", ["octahedral", "latlong", "dual_paraboloid", "parabolic"])
def test_maps_there_and_back(runtime: TimedRuntime, name: str, family: str) -> None:
    function = LIBRARY.function("octahedral_encode")
    count = 200_000 if family == "uniform" else cases.coverage(function, family)
    w = np.asarray(cases.draw(function, family, count, SEED)["w"], np.float64)
    if name == "parabolic":  # one paraboloid shows one hemisphere
        w = w[w[:, 2] >= 0.0]
    got = there_and_back(device_call(LIBRARY, runtime), name, w)
    assert np.isfinite(got).all()
    unit_w = w / np.linalg.norm(w, axis=1, keepdims=True)
    unit_got = got / np.linalg.norm(got, axis=1, keepdims=True)
    angle = np.linalg.norm(unit_got - unit_w, axis=1)
    worst = int(np.argmax(angle))
    assert angle[worst] <= CHECKS["maps"]["round_trip"], (w[worst].tolist(), angle[worst])


def test_solid_angles_sum_to_the_sphere(runtime: TimedRuntime) -> None:
    call, check = device_call(LIBRARY, runtime), CHECKS["maps"]
    size = 16
    uv = texel_centres(size, size)
    full = np.ones(len(uv))
    total = call("octahedral_solid_angle", {"uv": uv, "size": size * full}).sum()
    assert abs(total / (4.0 * np.pi) - 1.0) <= check["octahedral_sum"]
    v = texel_centres(64, 32)[:, 1]
    inputs = {"v": v, "width": np.full(len(v), 64.0), "height": np.full(len(v), 32.0)}
    assert abs(call("latlong_solid_angle", inputs).sum() / (4.0 * np.pi) - 1.0) <= check["sum"]


def cube_face(uv: Array) -> Array:
    """Directions through the face z = 1 of a cube."""
    p = np.concatenate([2.0 * uv - 1.0, np.ones((len(uv), 1))], axis=1)
    return np.asarray(p / np.linalg.norm(p, axis=1, keepdims=True), dtype=np.float64)


def paraboloid(uv: Array) -> Array:
    """Directions of the front face of a dual-paraboloid map with border 1."""
    return maps.dual_paraboloid_direction(uv, np.zeros(len(uv)), np.ones(len(uv)))


def test_solid_angles_are_jacobians(runtime: TimedRuntime) -> None:
    call, check = device_call(LIBRARY, runtime), CHECKS["maps"]
    uv = np.random.Generator(np.random.Philox(SEED)).uniform(0.03, 0.97, (20_000, 2))
    p = np.abs(2.0 * uv - 1.0)
    uv = (
        uv[(np.abs(p.sum(axis=1) - 1.0) > 0.02) & (p.min(axis=1) > 0.02)]
        .astype(np.float32)
        .astype(np.float64)
    )
    ones, step = np.ones(len(uv)), check["jacobian_step"]

    def agree(got: Array, to_sphere: Any, chosen: Any = slice(None)) -> None:
        wanted = solid_angle_per_area(to_sphere, uv, step)
        np.testing.assert_allclose(got[chosen], wanted[chosen], rtol=check["jacobian"])

    agree(call("octahedral_solid_angle", {"uv": uv, "size": ones}), maps.octahedral_decode)
    agree(call("cube_solid_angle", {"uv": uv, "size": ones}), cube_face)
    rows = np.full(len(uv), 4096.0)
    texel = call("latlong_solid_angle", {"v": uv[:, 1], "width": rows, "height": rows})
    agree(texel * 4096.0**2, maps.latlong_direction)
    z = paraboloid(uv)[:, 2]
    inputs = {"z": z, "width": ones, "height": ones, "border": ones}
    agree(call("dual_paraboloid_solid_angle", inputs), paraboloid, z > ABOVE_RIM)
