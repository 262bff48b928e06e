"""What the check draws, on what it runs, and what a result is named after."""

from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from codegen.errors import UserError
from codegen.kernels import kernel
from codegen.library import load_library
from conformance import cases
from conformance.check import backend as backends
from conformance.check import engine
from conformance.check.engine import Backend, check_function
from conformance.check.sample import together
from conformance.unit.support.sources import library_of
from targets import Device

SOURCE = "def probe(x: X) -> f32:\n    return x\n"


def columns(inputs: Mapping[str, Any]) -> list[Any]:
    return [c for v in inputs.values() for c in (columns(v) if isinstance(v, Mapping) else [v])]


@pytest.mark.parametrize("name", ["sin_angle", "to_local"])
def test_draws_are_joined_field_by_field(name: str) -> None:
    found = list(engine.draws(load_library().function(name), 30, 20))
    apart = [columns(d.inputs) for d in found]
    for k, whole in enumerate(columns(together(found).inputs)):
        assert np.array_equal(whole, np.concatenate([parts[k] for parts in apart]))


@pytest.mark.parametrize("name", ["sin_angle", "to_local"])
def test_single_draw_joined_is_itself(name: str) -> None:
    (found, *_) = engine.draws(load_library().function(name), 30, 20)
    assert all(map(np.array_equal, columns(together([found]).inputs), columns(found.inputs)))


@pytest.mark.parametrize("name", ["sin_angle", "to_local", "bessel_i0e"])
def test_draws_take_every_family_and_can_be_repeated(name: str) -> None:
    function = load_library().function(name)
    found = list(engine.draws(function, 30, 20))
    families = [d.family for d in found if d.family != cases.WORST]
    assert families == ["uniform", *cases.families_for(function.parameters)]
    assert (cases.WORST in [d.family for d in found]) == cases.has_worst(function)
    assert len(set(families)) > 2
    for d in found:
        again = engine.draw(function, d.family, d.count, d.seed)
        assert all(map(np.array_equal, columns(again.inputs), columns(d.inputs)))
        assert {len(c) for c in columns(d.inputs)} == {d.count}
    assert [d.count for d in found if d.family in ("uniform", "domain_ends")] == [30, 20]
    assert {d.seed for d in found} == {engine.SEED}


def test_maps_are_not_drawn() -> None:
    reading = [f for f in load_library().documented.values() if f.reads_textures]
    assert reading
    for function in reading:
        with pytest.raises(UserError, match=f"^{function.name} reads maps: "):
            engine.draw(function, "uniform", 10, engine.SEED)


def test_check_draws_for_itself() -> None:
    result = check_function(load_library(), "half_vector", engine.backend("numpy"), intervals=False)
    assert result.passed
    assert result.target == "numpy"
    assert "numpy" in result.driver
    assert result.lanes >= engine.UNIFORM_COUNT


def test_backend_runs_a_target_and_names_its_driver(monkeypatch: pytest.MonkeyPatch) -> None:
    runtime = SimpleNamespace(device=Device("glsl", "an API", "a driver 1.2", "a device"))
    monkeypatch.setattr(backends, "open_runtime", {"glsl": runtime}.__getitem__)
    monkeypatch.setattr(backends, "execute", lambda *arguments: arguments)
    found = engine.backend("glsl")
    assert (found.target, found.driver) == ("glsl", "an API; a driver 1.2; a device")
    library, inputs = load_library(), {"x": np.array([1], np.float32)}
    assert found.run(library, "probe", inputs) == (library, "probe", inputs, runtime)
    assert (found.device, found.judged_by) == (runtime.device, "glsl")
    assert found.text is not None
    assert found.text(library, "mirror") == kernel(library, "mirror", "glsl")


def test_evaluator_is_a_backend_without_a_driver() -> None:
    found = engine.backend("numpy")
    assert (found.target, found.driver) == ("numpy", f"numpy {np.__version__}, float32 op by op")


def test_function_without_finds_has_no_worst_inputs(tmp_path: Path) -> None:
    function = library_of(tmp_path, SOURCE).function("probe")
    assert not cases.has_worst(function)
    assert cases.WORST not in [d.family for d in engine.draws(function, 10, 10)]


def test_one_lane_of_a_draw_keeps_its_values() -> None:
    whole = engine.draw(load_library().function("to_local"), "uniform", 20, 1)
    one = engine.only_lane(whole, 7)
    assert (one.family, one.count, one.seed) == (whole.family, whole.count, whole.seed)
    for cut, full in zip(columns(one.inputs), columns(whole.inputs), strict=True):
        assert cut.shape[0] == 1
        assert np.array_equal(cut[0], full[7])


@pytest.mark.parametrize(("target", "table"), [("numpy", "wgsl"), ("glsl", "glsl"), ("opencl", "opencl")])
def test_result_names_source_emitted_text_and_table(target: str, table: str) -> None:
    library = load_library()
    run = engine.backend("numpy").run
    drawn = list(engine.draws(library.function("mirror"), 5, 5))[:1]
    plain = check_function(library, "mirror", Backend(target, "a driver", run), drawn)
    assert plain.source == library.select(["mirror"]).source_hash
    assert (plain.backend, plain.emitted) == (target, "")
    assert plain.permitted is not None
    assert plain.permitted.table == table
    on = Backend(target, "a driver", run, "numpy", "vulkan", lambda library, name: f"text of {name}")
    named = check_function(library, "mirror", on, drawn)
    assert named.backend == "numpy"
    assert named.emitted == sha256(b"text of mirror").hexdigest()[:16]
    assert named.permitted is not None
    assert named.permitted.table == "vulkan"


def test_lane_of_joined_draws_knows_where_it_comes_from() -> None:
    parts = list(engine.draws(load_library().function("mirror"), 7, 3))
    sample = together(parts)
    assert sample.lanes == sum(d.count for d in parts)
    lane = 0
    for d in parts:
        for k in range(d.count):
            from_, number = sample.origin(lane)
            assert (from_.family, from_.count, from_.seed, number) == (d.family, d.count, d.seed, k)
            assert np.array_equal(sample.inputs["l"][lane], d.inputs["l"][k])
            lane += 1
    assert sample.uniform.sum() == 7
    with pytest.raises(ValueError, match="nothing was drawn"):
        together([])
