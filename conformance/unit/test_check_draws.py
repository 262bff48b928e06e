"""What the check draws, on what it runs, and what a result is named after."""

from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from codegen.kernels import kernel
from codegen.library import load_library
from conformance import cases
from conformance.check import engine
from conformance.check.engine import Backend, check_function
from conformance.unit.support.sources import library_of

SOURCE = "def probe(x: X) -> f32:\n    return x\n"


def columns(inputs: Mapping[str, Any]) -> list[Any]:
    return [c for v in inputs.values() for c in (columns(v) if isinstance(v, Mapping) else [v])]


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


def test_check_draws_for_itself() -> None:
    result = check_function(load_library(), "half_vector", engine.backend("numpy"))
    assert result.passed
    assert result.target == "numpy"
    assert "numpy" in result.driver
    assert result.lanes >= engine.UNIFORM_COUNT


def test_backend_runs_a_target_and_names_its_driver(monkeypatch: pytest.MonkeyPatch) -> None:
    runtime = SimpleNamespace(device=SimpleNamespace(api="an API", driver="a driver 1.2", device="a device"))
    monkeypatch.setattr(engine, "open_runtime", {"glsl": runtime}.__getitem__)
    monkeypatch.setattr(engine, "execute", lambda *arguments: arguments)
    found = engine.backend("glsl")
    assert (found.target, found.driver) == ("glsl", "an API; a driver 1.2; a device")
    library, inputs = load_library(), {"x": np.array([1], np.float32)}
    assert found.run(library, "probe", inputs) == (library, "probe", inputs, runtime)


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


@pytest.mark.parametrize("target", ["numpy", "glsl", "opencl"])
def test_result_names_source_and_emitted_text(target: str) -> None:
    library = load_library()
    run = engine.backend("numpy").run
    result = check_function(library, "mirror", Backend(target, "a driver", run), [])
    assert result.source == library.select(["mirror"]).source_hash
    assert result.backend == target
    text = b"" if target == "numpy" else kernel(library, "mirror", target).encode()
    assert result.emitted == (sha256(text).hexdigest()[:16] if text else "")
    named = check_function(library, "mirror", Backend(target, "a driver", run, "numpy"), [])
    assert named.backend == "numpy"
