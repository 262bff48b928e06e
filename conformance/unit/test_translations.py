"""The library behind other people's translators: every function becomes HLSL and MSL and keeps its name.

Plan. One compute shader calls each function on words of a buffer: some drawn functions by day, all by night.
  SPIRV-Cross  from GLSL through glslang and SPIR-V
  naga         from WGSL
HLSL is read again by glslang. There is no validator of MSL for this system: of that only the names are held.
naga puts an underscore behind names that end in a digit.
"""

import os
import random
import re
from collections.abc import Sequence
from pathlib import Path

import pytest

from codegen.backends import complete_program, dialect
from codegen.emit.definition import read_definitions
from codegen.emit.module import DEFAULT_PREFIX, emit
from codegen.kernels import kernel_body
from codegen.library import load_library
from conformance.unit.support.translated import accepted_as_hlsl, ran
from targets.packages import find_tool

SEED = 8
FEW = 12
"""Functions of a day."""
some_and_all = pytest.mark.parametrize("count", [FEW, pytest.param(0, id="all", marks=pytest.mark.nightly)])
VULKAN = """#version 450
$library
layout(local_size_x = 1) in;
layout(std430, binding = 0) readonly buffer WordsIn { uint words_in[]; };
layout(std430, binding = 1) writeonly buffer WordsOut { uint words_out[]; };
uint load_u32(int k) { return words_in[k]; }
int load_i32(int k) { return int(load_u32(k)); }
float load_f32(int k) { return uintBitsToFloat(load_u32(k)); }
bool load_bool(int k) { return load_u32(k) != 0u; }
void store_u32(int k, uint value) { words_out[k] = value; }
void store_i32(int k, int value) { store_u32(k, uint(value)); }
void store_f32(int k, float value) { store_u32(k, floatBitsToUint(value)); }
void store_bool(int k, bool value) { store_u32(k, value ? 1u : 0u); }
void main() {
$body
}
"""


def drawn(count: int) -> list[str]:
    """So many functions, or all of them for 0."""
    names = sorted(load_library().public)
    chosen = random.Random(SEED).sample(names, count) if count else names
    print(f"seed {SEED}: {' '.join(chosen)}")
    return chosen


def texts(target: str, name: str, functions: Sequence[str]) -> tuple[str, str]:
    """The include of some functions, and statements that call each."""
    library = load_library()
    bodies = [f"{{\n{kernel_body(library, function, target)}\n}}" for function in functions]
    return emit(library, dialect(target, name), functions), "\n".join(bodies)


def missing(include: str, translated: str) -> set[str]:
    """Functions of an include that a translation does not call by their names."""
    named = {d.name for d in read_definitions(include) if "(" in d.code[0]}
    assert named
    return named - {name.rstrip("_") for name in re.findall(rf"\b{DEFAULT_PREFIX}\w+(?=\()", translated)}


@some_and_all
def test_spirv_cross_translates_functions(count: int, tmp_path: Path) -> None:
    for tool in ("glslangValidator", "spirv-cross"):
        if not find_tool(tool):
            pytest.skip(
                f"no {tool} is here: apt-get install --no-install-recommends glslang-tools spirv-cross"
            )
    include, body = texts("glsl", "vulkan450", drawn(count))
    shader, module = tmp_path / "all.comp", tmp_path / "all.spv"
    shader.write_text(VULKAN.replace("$library", include).replace("$body", body), encoding="utf-8")
    ran("glslangValidator", "-V", "-o", str(module), str(shader))
    for language, options in {"msl": ["--msl"], "hlsl": ["--hlsl", "--shader-model", "50"]}.items():
        text = module.with_suffix(f".{language}")
        ran("spirv-cross", *options, "--output", str(text), str(module))
        assert missing(include, text.read_text(encoding="utf-8")) == set()
    accepted_as_hlsl(module.with_suffix(".hlsl"), "comp", "main")


@some_and_all
def test_naga_translates_functions(count: int, tmp_path: Path) -> None:
    if not find_tool("naga"):
        pytest.skip("no naga is here: cargo install naga-cli --locked")
    include, body = texts("wgsl", "wgsl", drawn(count))
    source = tmp_path / "all.wgsl"
    source.write_text(complete_program("wgsl", include, body), encoding="utf-8")
    for language in ("metal", "hlsl"):
        text = source.with_suffix(f".{language}")
        ran(os.fspath(find_tool("naga") or ""), str(source), str(text))
        assert missing(include, text.read_text(encoding="utf-8")) == set()
    accepted_as_hlsl(source.with_suffix(".hlsl"), "comp", "harness_main")
