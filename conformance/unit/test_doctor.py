"""The doctor's report has a row for every component and a hint in every row."""

import sys

import pytest

import targets
from targets import TargetUnavailable, doctor


def test_every_component_has_a_row_and_a_hint() -> None:
    rows = doctor.report()
    assert [(row.kind, row.component) for row in rows] == [
        *(("driver", target) for target in ("glsl", "wgsl", "opencl")),
        *(("validator", command) for command in ("glslangValidator", "spirv-val", "naga")),
        *(("package", name) for name in ("moderngl", "wgpu", "pyopencl", "embreex", "trimesh")),
    ]
    for row in rows:
        assert row.hint
        assert bool(row.version) == row.found


def test_missing_driver_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    reason = TargetUnavailable("no OpenCL device is here: apt-get install pocl-opencl-icd")
    monkeypatch.setattr(doctor, "probe", lambda name: reason)
    drivers = [row for row in doctor.report() if row.kind == "driver"]
    assert [(row.found, row.hint) for row in drivers] == [(False, str(reason))] * len(targets.TARGETS)


def test_missing_tools_and_packages_are_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "probe", lambda name: TargetUnavailable("install a driver"))
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr(sys, "path", [])
    monkeypatch.setattr(sys, "path_importer_cache", {})
    for package in doctor.PACKAGES:
        monkeypatch.delitem(sys.modules, package, raising=False)
    assert not any(row.found for row in doctor.report())
