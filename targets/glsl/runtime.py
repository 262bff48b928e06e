"""Opens what runs GLSL programs on OpenGL: compute shaders, or fragments on old drivers."""

from typing import Literal

from targets.glsl.compute import REQUIRED_VERSION, GlslRuntime
from targets.glsl.fragment import GlslFragmentRuntime
from targets.packages import require_package


def open_runtime(
    require: int = REQUIRED_VERSION, stage: Literal["compute", "fragment"] = "compute", uniforms: bool = False
) -> GlslRuntime:
    """Open a context of its own; raises TargetUnavailable.

    require   version of OpenGL to ask for; compute below 430 needs the driver's ARB extensions
    stage     what runs a program once per lane: compute invocations or fragments
    uniforms  whether the input is a uniform block, for programs of the form "uniform"
    """
    moderngl = require_package("moderngl")
    if stage == "fragment":
        return GlslFragmentRuntime(moderngl, require)
    return GlslRuntime(moderngl, require, uniforms)
