// SPDX-License-Identifier: MIT
// Vectors and built-ins of OpenCL C for a C compiler: as much as the emitted library uses.
// clang's extensions to C11 bring components, swizzles and arithmetic of vectors, and functions of one name;
// runner.py writes vector literals, (float3)(a, b, c), as calls of make_float3.
#pragma once

#include <stdbool.h>
#include <stdint.h>

typedef uint32_t uint;
typedef float float2 __attribute__((ext_vector_type(2)));
typedef float float3 __attribute__((ext_vector_type(3)));
typedef float float4 __attribute__((ext_vector_type(4)));
typedef uint uint2 __attribute__((ext_vector_type(2)));
typedef uint uint3 __attribute__((ext_vector_type(3)));

#define BUILT_IN static inline __attribute__((overloadable))

#define MAKE(T, V)                                                                    \
    BUILT_IN V##2 make_##V##2(T a) { return (V##2){a, a}; }                           \
    BUILT_IN V##2 make_##V##2(T a, T b) { return (V##2){a, b}; }                      \
    BUILT_IN V##3 make_##V##3(T a) { return (V##3){a, a, a}; }                        \
    BUILT_IN V##3 make_##V##3(T a, T b, T c) { return (V##3){a, b, c}; }              \
    BUILT_IN V##3 make_##V##3(V##2 v, T c) { return (V##3){v.x, v.y, c}; }            \
    BUILT_IN V##3 make_##V##3(T a, V##2 v) { return (V##3){a, v.x, v.y}; }
MAKE(float, float)
MAKE(uint, uint)
BUILT_IN float4 make_float4(float a, float b, float c, float d) { return (float4){a, b, c, d}; }
BUILT_IN float4 make_float4(float3 v, float d) { return (float4){v.x, v.y, v.z, d}; }

// A function of one number, and of vectors by component.
#define EACH(name)                                                                    \
    BUILT_IN float name(float a) { return __builtin_##name##f(a); }                   \
    BUILT_IN float2 name(float2 a) { return (float2){name(a.x), name(a.y)}; }         \
    BUILT_IN float3 name(float3 a) { return (float3){name(a.x), name(a.y), name(a.z)}; }
EACH(cos)
EACH(exp)
EACH(exp2)
EACH(fabs)
EACH(floor)
EACH(log)
EACH(log2)
EACH(sin)
EACH(sqrt)
BUILT_IN float rsqrt(float a) { return 1.0f / sqrt(a); }

#define ORDER(T)                                                                      \
    BUILT_IN T max(T a, T b) { return a < b ? b : a; }                                \
    BUILT_IN T min(T a, T b) { return b < a ? b : a; }                                \
    BUILT_IN T clamp(T a, T low, T high) { return min(max(a, low), high); }
ORDER(float)
ORDER(int)
ORDER(uint)
#define ORDERS(V)                                                                     \
    BUILT_IN V max(V a, float b) { return max(a, (V)(b)); }                           \
    BUILT_IN V min(V a, float b) { return min(a, (V)(b)); }                           \
    BUILT_IN V clamp(V a, V low, V high) { return min(max(a, low), high); }           \
    BUILT_IN V clamp(V a, float low, float high) { return min(max(a, low), high); }
BUILT_IN float2 max(float2 a, float2 b) { return (float2){max(a.x, b.x), max(a.y, b.y)}; }
BUILT_IN float2 min(float2 a, float2 b) { return (float2){min(a.x, b.x), min(a.y, b.y)}; }
BUILT_IN float3 max(float3 a, float3 b) { return (float3){max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)}; }
BUILT_IN float3 min(float3 a, float3 b) { return (float3){min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)}; }
ORDERS(float2)
ORDERS(float3)

BUILT_IN float dot(float2 a, float2 b) { return a.x * b.x + a.y * b.y; }
BUILT_IN float dot(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
BUILT_IN float3 cross(float3 a, float3 b) {
    return (float3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
#define LENGTH(V)                                                                     \
    BUILT_IN float length(V a) { return sqrt(dot(a, a)); }                            \
    BUILT_IN V normalize(V a) { return a / length(a); }
LENGTH(float2)
LENGTH(float3)

union word {
    float f;
    uint u;
    int i;
};
BUILT_IN float as_float(uint a) { return ((union word){.u = a}).f; }
BUILT_IN uint as_uint(float a) { return ((union word){.f = a}).u; }
BUILT_IN uint as_uint(int a) { return (uint)a; }
BUILT_IN int as_int(uint a) { return ((union word){.u = a}).i; }
