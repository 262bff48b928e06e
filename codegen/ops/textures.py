"""Lookups in maps. Read this file as a table.

A map is a chain of levels of RGBA floats; row 0 of a level lies at v = 0, column 0 at u = 0, and texel (i, j)
of w by h at ((i + 1/2) / w, (j + 1/2) / h). Level k + 1 is half of level k, rounded down, at least 1.
"""

from codegen.ir.types import F32, TEXTURE, VEC2, VEC4
from codegen.ops.op import Op
from codegen.ops.rules import one

SEE = "WGSL 17.7.11 textureSampleLevel; Vulkan 16.8 Texel Filtering; OpenGL 8.14; OpenCL 8.2 image filtering"

BUILTINS = (
    Op(
        "lookup",
        one((TEXTURE, VEC2), VEC4),
        lambda m, t, uv: m.lookup_level(t, uv, None),
        "texture",
        (),
        SEE,
        summary="Bilinear lookup in the largest level.",
        names=("t", "uv"),
        spell={"glsl": "textureLod", "wgsl": "textureSampleLevel"},
        half=False,
        trailing=(0.0,),
    ),
    Op(
        "lookup_level",
        one((TEXTURE, VEC2, F32), VEC4),
        lambda m, t, uv, level: m.lookup_level(t, uv, level),
        "texture",
        (),
        SEE,
        summary="Lookup in two levels, bilinear in each and linear between them; the last level stays.",
        names=("t", "uv", "lod"),
        spell={"glsl": "textureLod", "wgsl": "textureSampleLevel"},
        half=False,
    ),
    Op(
        "texture_size",
        one((TEXTURE,), VEC2),
        lambda m, t: m.texture_size(t),
        "free",
        (),
        "WGSL 17.7.1 textureDimensions; GLSL 8.9.1 textureSize; OpenCL 6.15.15 get_image_dim",
        summary="Width and height of the largest level, in texels.",
        names=("t",),
        text={
            "glsl": "vec2(textureSize({0}, 0))",
            "wgsl": "vec2<f32>(textureDimensions({0}))",
            "opencl": "convert_float2({0}_layout.xy)",
        },
        half=False,
    ),
)
