"""Complete programs: a library and an entry point's body, put into a target's harness."""

from pathlib import Path
from string import Template

HARNESS_FILES = {"glsl": "harness.comp", "wgsl": "harness.wgsl", "opencl": "harness.cl"}

GLSL_VERSION = "430"
"""Version of GLSL where none is named: the first with compute shaders."""


def harness_text(target: str) -> str:
    """The text of a target's harness, a string.Template of $library and $body (and $version for GLSL)."""
    return (Path(__file__).parent / target / HARNESS_FILES[target]).read_text(encoding="utf-8")


def complete_program(target: str, library: str, body: str, version: str = GLSL_VERSION) -> str:
    """Complete program text for a target's runtime.

    library  the functions under test; without a #version line
    body     statements that load words, call the library and store words, by load_T(k) and store_T(k, value)
             with T one of f32, i32, u32, bool and k the number of the word
    version  GLSL only: what follows #version, for example 430, 450 or 310 es
    """
    text = Template(harness_text(target))
    return text.substitute(library=library, body=body, version=version)
