"""The smallest shaders around an include, one for each way in which a host may compile it."""

from __future__ import annotations

from dataclasses import dataclass

from targets.glsl.validate import ES_PRECISION


@dataclass(frozen=True)
class Shell:
    """A shader without an include.

    dialect  of the include that goes into it
    version  what stands behind #version
    stage    as glslang spells it
    options  of glslangValidator; none: syntax and types are checked, as an OpenGL driver's front end does
    """

    dialect: str
    version: str
    stage: str
    options: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The row of the table."""
        return " ".join([f"#version {self.version}, {self.stage}", *self.options])

    def text(self, include: str) -> str:
        """The shader with an include."""
        precision = ES_PRECISION if self.version.endswith("es") else ""
        if self.stage == "comp":
            body, rest = "layout(local_size_x = 1) in;\n", "void main() {}\n"
        elif self.stage == "frag":
            location = "layout(location = 0) " if "-V" in self.options else ""
            body, rest = f"{location}out vec4 colour;\n", "void main() { colour = vec4(0.0); }\n"
        else:
            body, rest = "", "void main() { gl_Position = vec4(0.0); }\n"
        return f"#version {self.version}\n{precision}{body}{include}{rest}"


SPIRV = ("-V", "--keep-uncalled")
"""SPIR-V for Vulkan; functions that nothing calls stay in it, as they would be called."""

SHELLS = (
    Shell("es300", "300 es", "frag"),
    Shell("es300", "300 es", "vert"),
    Shell("330", "330", "frag"),
    Shell("430", "430", "comp"),
    Shell("450", "450", "comp"),
    Shell("es310", "310 es", "comp"),
    Shell("vulkan450", "450", "comp", SPIRV),
    Shell("vulkan450", "450", "frag", SPIRV),
    Shell("vulkan450", "430", "comp", SPIRV),
    Shell("vulkan450", "430", "frag", SPIRV),
    Shell("vulkan450", "330", "frag", SPIRV),
    Shell("es310", "310 es", "comp", SPIRV),
)
"""Each dialect as conformance validates it, then the same include under other versions and stages."""
