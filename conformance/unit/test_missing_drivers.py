"""A missing driver skips a test and says why; where the environment requires the target, it fails."""

import pytest

from conformance.unit.support.drivers import REQUIRED_VARIABLE, need
from targets import TargetUnavailable


@pytest.fixture(autouse=True)
def only_wgsl(monkeypatch: pytest.MonkeyPatch) -> None:
    def probe(name: str) -> object:
        return object() if name == "wgsl" else TargetUnavailable("apt-get install a driver")

    monkeypatch.setattr("conformance.unit.support.drivers.probe", probe)


@pytest.mark.parametrize("required", ["", "wgsl", "opencl, wgsl"])
def test_a_missing_driver_skips_and_says_why(required: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(REQUIRED_VARIABLE, required)
    with pytest.raises(pytest.skip.Exception, match=r"^glsl: apt-get install a driver$"):
        need("wgsl", "glsl")
    need("wgsl")


@pytest.mark.parametrize("required", ["glsl", "opencl, glsl"])
def test_a_missing_driver_that_is_required_fails(required: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(REQUIRED_VARIABLE, required)
    with pytest.raises(pytest.fail.Exception, match="cannot run here; glsl: apt-get install a driver"):
        need("wgsl", "glsl")
