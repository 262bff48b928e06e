"""Validates a GLSL library by glslang, and its SPIR-V by spirv-val, dialect by dialect."""

import tempfile
from dataclasses import dataclass
from pathlib import Path

from targets.packages import find_tool, run_tool
from targets.protocol import BuildFailed, TargetUnavailable

MISSING_VALIDATOR = "glslangValidator is not installed: apt-get install glslang-tools"

COMPUTE_SHELL = "layout(local_size_x = 1) in;\n#line 1\n{library}\nvoid main() {{ }}\n"
FRAGMENT_SHELL = (
    "out vec4 vair_validation_colour;\n#line 1\n{library}\n"
    "void main() {{ vair_validation_colour = vec4(0.0); }}\n"
)
ES_PRECISION = "precision highp float;\nprecision highp int;\n"


@dataclass(frozen=True)
class Shell:
    """The smallest shader around a library.

    head    lines before the shader's body, the #version line first
    stage   stage as glslang spells it
    body    the shader with a place for the library; its lines are counted from 1 there
    vulkan  generate SPIR-V for Vulkan, uncalled functions included
    """

    head: str
    stage: str = "comp"
    body: str = COMPUTE_SHELL
    vulkan: bool = False


SHELLS = {
    "330": Shell("#version 330\n", "frag", FRAGMENT_SHELL),
    "430": Shell("#version 430\n"),
    "450": Shell("#version 450\n"),
    "es300": Shell("#version 300 es\n" + ES_PRECISION, "frag", FRAGMENT_SHELL),
    "es310": Shell("#version 310 es\n" + ES_PRECISION),
    "vulkan450": Shell("#version 450\n", vulkan=True),
}


def validator_available() -> str | None:
    """None where validation can run, else the reason why it cannot."""
    return None if _glslang() else MISSING_VALIDATOR


def validate(text: str, dialect: str = "430") -> None:
    """Check a library text without a #version line.

    errors  BuildFailed with glslang's log, whose lines count from 1 in the text; TargetUnavailable without
            glslang; ValueError for an unknown dialect
    """
    if dialect not in SHELLS:
        raise ValueError(f"no dialect of GLSL is called {dialect!r}; the dialects are {', '.join(SHELLS)}")
    glslang = _glslang()
    if glslang is None:
        raise TargetUnavailable(MISSING_VALIDATOR)
    shell = SHELLS[dialect]
    shader = shell.head + shell.body.format(library=text)
    if shell.vulkan:
        _validate_vulkan(glslang, shell.stage, shader)
    else:
        _check(run_tool(glslang, "--stdin", "-S", shell.stage, text=shader))


def _validate_vulkan(glslang: str, stage: str, shader: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        binary = str(Path(folder) / "library.spv")
        command = (glslang, "-V", "--keep-uncalled", "--stdin", "-S", stage, "-o", binary)
        _check(run_tool(*command, text=shader))
        spirv_val = find_tool("spirv-val")
        if spirv_val:
            _check(run_tool(spirv_val, "--target-env", "vulkan1.0", binary))


def _check(outcome: tuple[int, str]) -> None:
    status, log = outcome
    if status != 0:
        raise BuildFailed(log.strip())


def _glslang() -> str | None:
    return find_tool("glslangValidator", "glslang")
