"""Complete programs: a library and an entry point's body, put into a target's harness."""

from collections.abc import Sequence
from pathlib import Path
from string import Template
from typing import Literal

from targets.textures import declarations

Form = Literal["plain", "pair", "uniform", "fragment"]
"""How a program walks over its lanes: one per invocation; two per invocation, each taken by
harness_take(j); all in one invocation with the input in uniform memory; one per fragment (GLSL only)."""

HARNESS_FILES = {
    ("glsl", "plain"): "harness.comp",
    ("glsl", "pair"): "harness-pair.comp",
    ("glsl", "uniform"): "harness-uniform.comp",
    ("glsl", "fragment"): "harness.frag",
    ("wgsl", "plain"): "harness.wgsl",
    ("wgsl", "pair"): "harness-pair.wgsl",
    ("wgsl", "uniform"): "harness-uniform.wgsl",
    ("opencl", "plain"): "harness.cl",
    ("opencl", "pair"): "harness-pair.cl",
    ("opencl", "uniform"): "harness-uniform.cl",
}

GLSL_VERSION = "430"
"""Version of GLSL where none is named: the first with compute shaders."""


def harness_text(target: str, form: Form = "plain") -> str:
    """The text of a target's harness, a string.Template of $library and $body (and $version for GLSL)."""
    return (Path(__file__).parent / target / HARNESS_FILES[target, form]).read_text(encoding="utf-8")


def complete_program(
    target: str,
    library: str,
    body: str,
    version: str = GLSL_VERSION,
    form: Form = "plain",
    textures: Sequence[str] = (),
) -> str:
    """Complete program text for a target's runtime.

    library  the functions under test; without a #version line
    body     statements that load words, call the library and store words, by load_T(k) and store_T(k, value)
             with T one of f32, i32, u32, bool and k the number of the word; in a pair after harness_take(j)
    version  GLSL only: what follows #version, for example 430, 450 or 310 es, with #extension lines below it
    textures names of maps that the body passes on; in the form "plain" only
    """
    if textures and form != "plain":
        raise ValueError(f"no harness of the form {form} has maps")
    text = Template(harness_text(target, form))
    return text.substitute(
        library=library, body=body, version=version, textures=declarations(target, textures)
    )
