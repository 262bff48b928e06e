"""Integers and bit patterns; unsigned arithmetic wraps modulo 2^32. Read this file as a table."""

from codegen.ir.types import F32, U32
from codegen.ops.op import Op
from codegen.ops.rules import UINTS, one, same

SEE = "WGSL 8.9; GLSL 5.9; OpenCL C 6.3: exact"

OPERATORS = (
    Op("//", same((U32,), 2), lambda m, a, b: a // b, "divide", ((7, 2),), SEE),
    Op("%", same((U32,), 2), lambda m, a, b: a % b, "divide", ((7, 2),), SEE),
    Op("<<", same((U32,), 2), lambda m, a, b: a << b, "add", ((1, 4),), SEE),
    Op(">>", same((U32,), 2), lambda m, a, b: a >> b, "add", ((256, 4),), SEE),
    Op("&", same(UINTS, 2), lambda m, a, b: a & b, "add", ((6, 3),), SEE),
    Op("|", same(UINTS, 2), lambda m, a, b: a | b, "add", ((6, 3),), SEE),
    Op("^", same(UINTS, 2), lambda m, a, b: a ^ b, "add", ((6, 3),), SEE),
    Op("~", same(UINTS, 1), lambda m, a: ~a, "add", ((6,),), SEE),
)

BUILTINS = (
    Op(
        "float_to_bits",
        one((F32,), U32),
        lambda m, x: m.float_to_bits(x),
        "free",
        ((1.5,),),
        SEE,
        summary="The 32 bits of a float.",
        names=("x",),
        half=False,
        spell={"glsl": "floatBitsToUint", "wgsl": "bitcast<u32>", "opencl": "as_uint"},
    ),
    Op(
        "bits_to_float",
        one((U32,), F32),
        lambda m, x: m.bits_to_float(x),
        "free",
        ((0x3F800000,),),
        SEE,
        summary="The float of these 32 bits, which must be finite.",
        names=("x",),
        half=False,
        spell={"glsl": "uintBitsToFloat", "wgsl": "bitcast<f32>", "opencl": "as_float"},
    ),
)
