"""GLSL: desktop 330, 430, 450; ES 300, 310; and 450 for Vulkan."""

from codegen.emit.dialect import Dialect

_TYPES = {
    "f32": "float",
    "i32": "int",
    "u32": "uint",
    "bool": "bool",
    "vec2": "vec2",
    "vec3": "vec3",
    "vec4": "vec4",
    "uvec2": "uvec2",
    "uvec3": "uvec3",
    "f16": "float",
    "hvec2": "vec2",
    "hvec3": "vec3",
    "hvec4": "vec4",
}


def _dialect(name: str, title: str, precision: str = "", precise: str = "") -> Dialect:
    return Dialect(
        target="glsl",
        name=name,
        title=title,
        extension="glsl",
        types=_TYPES,
        precision=precision,
        precise=precise,
        half_precision="mediump",
        texture=(("", "highp sampler2D" if precision else "sampler2D"),),
        line_map="#line {line} {file}",
    )


DIALECTS = {
    d.name: d
    for d in (
        _dialect("330", "GLSL 3.30"),
        _dialect("430", "GLSL 4.30", precise="precise"),
        _dialect("450", "GLSL 4.50", precise="precise"),
        _dialect("es300", "GLSL ES 3.00", precision="highp"),
        _dialect("es310", "GLSL ES 3.10", precision="highp"),
        _dialect("vulkan450", "GLSL 4.50 for Vulkan", precise="precise"),
    )
}
DEFAULT = "430"
