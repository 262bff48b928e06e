"""The host programs of examples/hosts use the generated files as an engine would and draw the right sphere.

Plan. Each program is built and run by the one command of its README in a process of its own; its picture is
compared pixel by pixel. Their stages pass through other people's translators, as all functions do in
test_translations.
"""

import os
import shutil
import sys
from pathlib import Path

import pytest

from conformance.picture.tolerances import tolerance
from conformance.unit.support.drivers import need
from conformance.unit.support.sphere import off, pixels, sphere
from conformance.unit.support.translated import accepted_as_hlsl, ran
from targets.packages import find_tool

ROOT = Path(__file__).parents[2]
HOSTS = ROOT / "examples" / "hosts"
WHOLE = 2.0
"""A radius that takes in every pixel."""
PROGRAMS = {
    "webgpu": ("wgsl", ()),
    "opencl": ("opencl", ()),
    "vulkan": ("wgsl", ("glslangValidator", "spirv-val")),
}


@pytest.mark.parametrize(
    "host", [pytest.param(h, marks=pytest.mark.nightly) if h == "vulkan" else h for h in PROGRAMS]
)
def test_a_program_in_python_draws_the_sphere(host: str, tmp_path: Path) -> None:
    target, tools = PROGRAMS[host]
    need(target)
    for tool in tools:
        if not find_tool(tool):
            pytest.skip(f"no {tool} is here")
    picture = tmp_path / "sphere.png"
    ran(sys.executable, str(HOSTS / host / f"{host}_sphere.py"), "-o", str(picture))
    assert off(pixels(picture), WHOLE) <= tolerance("host_steps")


def test_a_program_in_c_draws_the_sphere(tmp_path: Path) -> None:
    need("glsl")
    if not (shutil.which("make") and shutil.which("cc")):
        pytest.skip("no C compiler or no make is here: apt-get install --no-install-recommends gcc make")
    if not all(Path(f"/usr/include/{name}").exists() for name in ("EGL/egl.h", "GL/glext.h")):
        pytest.skip(
            "no headers of EGL are here: apt-get install --no-install-recommends libegl-dev libgl-dev"
        )
    ran("make", "-C", str(HOSTS / "opengl"), f"BUILD={tmp_path}")
    assert off(pixels(tmp_path / "sphere.ppm"), WHOLE) <= tolerance("host_steps")


def test_the_sphere_is_worth_drawing() -> None:
    picture = sphere()
    assert picture.max() > 200
    assert (picture == 0).all(-1).any()


@pytest.fixture(scope="module")
def module(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The fragment stage of the Vulkan host as SPIR-V."""
    if not find_tool("glslangValidator"):
        pytest.skip("no glslangValidator is here")
    path = tmp_path_factory.mktemp("spirv") / "sphere.spv"
    include = f"-I{ROOT / 'targets' / 'glsl' / 'include'}"
    ran("glslangValidator", "-V", include, "-o", str(path), str(HOSTS / "vulkan" / "sphere.frag"))
    return path


@pytest.mark.parametrize("language", ["hlsl", "msl"])
def test_spirv_cross_translates_the_stage(language: str, module: Path) -> None:
    if not shutil.which("spirv-cross"):
        pytest.skip("no spirv-cross is here: apt-get install --no-install-recommends spirv-cross")
    text = module.with_suffix(f".{language}")
    options = ["--hlsl", "--shader-model", "50"] if language == "hlsl" else ["--msl"]
    ran("spirv-cross", *options, "--output", str(text), str(module))
    assert "vair_banks_shade" in text.read_text(encoding="utf-8")
    if language == "hlsl":
        accepted_as_hlsl(text, "frag", "main")


@pytest.mark.parametrize("language", ["hlsl", "metal"])
def test_naga_translates_the_stages(language: str, tmp_path: Path) -> None:
    if not find_tool("naga"):
        pytest.skip("no naga is here: cargo install naga-cli --locked")
    library = ROOT / "targets" / "wgsl" / "include" / "vair.wgsl"
    stages = HOSTS / "webgpu" / "sphere.wgsl"
    source, text = tmp_path / "sphere.wgsl", tmp_path / f"sphere.{language}"
    source.write_text(
        library.read_text(encoding="utf-8") + stages.read_text(encoding="utf-8"), encoding="utf-8"
    )
    ran(os.fspath(find_tool("naga") or ""), str(source), str(text))
    assert "vair_banks_shade" in text.read_text(encoding="utf-8")
    if language == "hlsl":
        accepted_as_hlsl(text, "frag", "fragment_")
