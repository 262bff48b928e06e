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
            "f16": "f16",
            "hvec2": "vec2<f16>",
            "hvec3": "vec3<f16>",
            "hvec4": "vec4<f16>",
        },
        declaration="name: type",
        typed_suffix="f",
        half_suffix="h",
        half_enable="enable f16;",
        conditional="select",
        guard=False,
        texture=(("", "texture_2d<f32>"), ("_sampler", "sampler")),
    )
}
DEFAULT = "wgsl"
