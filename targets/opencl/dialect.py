"""OpenCL C 1.2 and 3.0. A truth value is an int there; casts are C's."""

from pathlib import Path

from codegen.emit.dialect import Dialect

LOOKUP = (Path(__file__).parent / "lookup_level.cl").read_text(encoding="utf-8")
"""Lookups in a packed chain of levels: no software driver has mipmapped images."""


def _dialect(name: str) -> Dialect:
    return Dialect(
        target="opencl",
        name=name,
        title=f"OpenCL C {name}",
        extension="cl",
        types={
            "f32": "float",
            "i32": "int",
            "u32": "uint",
            "bool": "int",
            "vec2": "float2",
            "vec3": "float3",
            "vec4": "float4",
            "uvec2": "uint2",
            "uvec3": "uint3",
            "f16": "half",
            "hvec2": "half2",
            "hvec3": "half3",
            "hvec4": "half4",
        },
        qualifier="static inline ",
        float_suffix="f",
        half_suffix="h",
        half_enable="#pragma OPENCL EXTENSION cl_khr_fp16 : enable",
        vectors="cast",
        structs="compound",
        conversions="cast",
        texture=(("", "image2d_t"), ("_sampler", "sampler_t"), ("_layout", "int4")),
        lookup_library=LOOKUP,
        line_map='#line {line} "{file}"',
    )


DIALECTS = {name: _dialect(name) for name in ("1.2", "3.0")}
DEFAULT = "1.2"
