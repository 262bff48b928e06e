"""A backend that is not ours: the OpenCL C text as plain C with a header of vectors, run on the processor.

Plan. Its runner reads a kit and nothing of the project, and its results are judged like a driver's.
  good   functions of every kind of value pass every verdict
  wrong  a header with a poor dot product is caught, in the functions that call it
Every function of the library: nightly. Without clang the tests are skipped and say so.
"""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path
from typing import Any

import pytest

from codegen.cli import run
from codegen.kernels import kernel_body
from codegen.library import load_library

FOLDER = Path(__file__).parents[2] / "foreign" / "c"
FUNCTIONS = (
    "sin_angle",
    "pcg3d",
    "strand_angles",
    "fakefur_shade",
    "frame_from_tangent",
    "octahedral_encode",
)
LANES = "16"


def load_runner() -> Any:
    spec = importlib.util.spec_from_file_location("foreign_runner", FOLDER / "runner.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def runner() -> Any:
    module = load_runner()
    if module.compiler() is None:
        pytest.skip("no clang is here: apt-get install --no-install-recommends clang")
    return module


@pytest.fixture(scope="module")
def kit(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("foreign") / "kit"
    names = [part for name in FUNCTIONS for part in ("--function", name)]
    assert run(["kit", "-o", str(folder), "--target", "opencl", "--lanes", LANES, *names]) == 0
    return folder


def test_a_foreign_backend_passes(
    runner: Any, kit: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "results.json"
    path.write_text(json.dumps(runner.run(kit)), encoding="utf-8")
    status = run(["check", "--results", str(path)])
    told = capsys.readouterr().out
    assert status == 0, told
    assert f"of {len(FUNCTIONS)} functions: permitted {len(FUNCTIONS)}, within bound {len(FUNCTIONS)}" in told


def test_a_poor_built_in_is_caught(
    runner: Any,
    kit: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """A dot product off by a thousandth spoils what is built on it, and leaves whole numbers alone."""
    sum_of_three = "a.x * b.x + a.y * b.y + a.z * b.z;"
    for file in FOLDER.glob("*.[ch]"):
        text = file.read_text(encoding="utf-8")
        poor = text.replace(f"return {sum_of_three}", f"return 1.001f * ({sum_of_three[:-1]});")
        (tmp_path / file.name).write_text(poor, encoding="utf-8")
    monkeypatch.setattr(runner, "HERE", tmp_path)
    path = tmp_path / "results.json"
    path.write_text(json.dumps(runner.run(kit)), encoding="utf-8")
    assert run(["check", "--results", str(path)]) == 1
    told = capsys.readouterr().out
    assert "sin_angle on " in told
    assert "outside what opencl permits" in told
    assert "pcg3d on " not in told


def test_a_function_that_is_not_compiled_says_so(runner: Any, kit: Path, tmp_path: Path) -> None:
    bad = tmp_path / "opencl"
    for folder in ("opencl/calls", "vectors"):
        (tmp_path / folder).mkdir(parents=True)
    (bad / "library.cl").write_text("float broken(", encoding="utf-8")
    (bad / "calls" / "sin_angle.cl").write_text(
        kernel_body(load_library(), "sin_angle", "opencl"), encoding="utf-8"
    )
    (tmp_path / "vectors" / "sin_angle.json").write_bytes((kit / "vectors" / "sin_angle.json").read_bytes())
    with pytest.raises(RuntimeError, match="error"):
        runner.build(tmp_path, tmp_path, ["sin_angle"])


@pytest.mark.nightly
def test_every_function_passes_on_a_foreign_backend(
    runner: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    kit, path = tmp_path / "kit", tmp_path / "results.json"
    assert run(["kit", "-o", str(kit), "--target", "opencl", "--lanes", "8"]) == 0
    path.write_text(json.dumps(runner.run(kit)), encoding="utf-8")
    status = run(["check", "--results", str(path)])
    assert status == 0, capsys.readouterr().out
