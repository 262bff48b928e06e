"""WGSL: one dialect."""

from codegen.emit.dialect import Dialect

DIALECTS = {
    "wgsl": Dialect(
        target="wgsl",
        name="wgsl",
        title="WGSL",
        extension="wgsl",
        types={
            "f32": "f32",
            "i32": "i32",
            "u32": "u32",
            "bool": "bool",
            "vec2": "vec2<f32>",
            "vec3": "vec3<f32>",
            "vec4": "vec4<f32>",
            "uvec2": "vec2<u32>",
            "uvec3": "vec3<u32>",
        },
        declaration="name: type",
        conditional="select",
        guard=False,
    )
}
DEFAULT = "wgsl"
