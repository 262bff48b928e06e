"""SwiftShader's sine, off by up to 1.9e-4, is permitted by WGSL and yet visible in the accuracy.

Plan. sin(x), one line of source, on SwiftShader and on lavapipe, each in a process of its own: both are
permitted; only the accuracy tells them apart.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from conformance.mutation.fake_backend import SINE_ERROR
from targets import TargetUnavailable
from targets.drivers import driver, environment_of

ROOT = Path(__file__).parents[2]
NEAR_ONE = 2.0**24
"""ULP in 1, for numbers just below it."""


def checked(name: str, folder: Path) -> dict[str, Any]:
    """The result on a driver, or a skip where it does not open."""
    try:
        environment = environment_of(driver(name))
    except TargetUnavailable as reason:
        pytest.skip(f"{name}: {reason}")
    done = subprocess.run(
        [sys.executable, "-m", "conformance.unit.support.sine_on_driver", name, str(folder)],
        env=environment,
        cwd=ROOT,
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
    )
    assert done.returncode == 0, done.stderr
    data: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    if "unavailable" in data:
        pytest.skip(f"{name}: {data['unavailable']}")
    return data


@pytest.mark.parametrize(
    ("name", "is_poor"), [("swiftshader", True), pytest.param("lavapipe", False, marks=pytest.mark.nightly)]
)
def test_sine_is_permitted_and_its_error_is_told(name: str, is_poor: bool, tmp_path: Path) -> None:
    result = checked(name, tmp_path)
    assert result["verdicts"]["permitted"] == "permitted"
    assert result["permitted"]["table"] == "wgsl"
    assert result["permitted"]["inside"] == result["lanes"]
    (accuracy,) = result["accuracy"]
    assert accuracy["measure"] == "ULP"
    assert (accuracy["p999"] > 0.5 * SINE_ERROR * NEAR_ONE) == is_poor
    (bound,) = result["bounds"]
    assert (bound["measured"] > 0.5 * SINE_ERROR) == is_poor
