"""Programs of others that translate shaders, and glslang's reader of HLSL as the judge of what they write."""

import subprocess
from pathlib import Path

import pytest

from targets.packages import find_tool

ROOT = Path(__file__).parents[3]


def ran(*command: str, folder: Path = ROOT) -> subprocess.CompletedProcess[str]:
    """A command that has to succeed."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stdout}{done.stderr}"
    return done


def accepted_as_hlsl(text: Path, stage: str, entry: str) -> None:
    """glslang's own reader of HLSL makes SPIR-V of it, which spirv-val accepts."""
    if not find_tool("glslangValidator"):
        pytest.skip("no glslangValidator is here to read HLSL")
    again = text.with_suffix(".again.spv")
    ran("glslangValidator", "-D", "-V", "-S", stage, "-e", entry, "-o", str(again), str(text))
    if find_tool("spirv-val"):
        ran("spirv-val", str(again))
