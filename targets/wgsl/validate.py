"""Validates a WGSL library by naga: inside wgpu, and by the naga command where it is installed."""

import os
import tempfile
from pathlib import Path

from targets import open_runtime
from targets.packages import find_tool, run_tool
from targets.protocol import BuildFailed, TargetUnavailable
from targets.wgsl.runtime import WgslRuntime

DIALECT = "wgsl"


def validator_available() -> str | None:
    """None where validation can run, else the reason why it cannot."""
    if find_tool("naga"):
        return None
    try:
        open_runtime("wgsl")
    except TargetUnavailable as reason:
        return str(reason)
    return None


def validate(text: str, dialect: str = DIALECT) -> None:
    """Check a library text, which is a WGSL module by itself.

    errors  BuildFailed with naga's report; TargetUnavailable where neither wgpu nor the naga command runs;
            ValueError for an unknown dialect
    """
    if dialect != DIALECT:
        raise ValueError(f"no dialect of WGSL is called {dialect!r}; the only one is {DIALECT}")
    command = find_tool("naga")
    if command:
        _validate_by_command(command, text)
    try:
        runtime = open_runtime("wgsl")
    except TargetUnavailable:
        if command:
            return
        raise
    assert isinstance(runtime, WgslRuntime)
    runtime.create_module(text)


def _validate_by_command(command: str, text: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "library.wgsl"
        file.write_text(text, encoding="utf-8")
        status, log = run_tool(command, str(file), environment={**os.environ, "NO_COLOR": "1"})
        if status != 0:
            raise BuildFailed(log.replace(str(file), file.name).strip())
