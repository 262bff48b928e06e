// SPDX-License-Identifier: MIT
// Vectors and built-ins of OpenCL C for a C++ compiler: as much as the emitted library uses.
// runner.py rewrites what C++ spells otherwise: (float3)(a, b, c) as float3(a, b, c), v.xy as v.xy().
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

typedef uint32_t uint;

template <class T> struct vector2 {
    T x, y;
    vector2() = default;
    vector2(T s) : x(s), y(s) {}
    vector2(T a, T b) : x(a), y(b) {}
    vector2 yx() const { return {y, x}; }
};

template <class T> struct vector3 {
    T x, y, z;
    vector3() = default;
    vector3(T s) : x(s), y(s), z(s) {}
    vector3(T a, T b, T c) : x(a), y(b), z(c) {}
    vector3(vector2<T> v, T c) : x(v.x), y(v.y), z(c) {}
    vector3(T a, vector2<T> v) : x(a), y(v.x), z(v.y) {}
    vector2<T> xy() const { return {x, y}; }
    vector2<T> xz() const { return {x, z}; }
};

template <class T> struct vector4 {
    T x, y, z, w;
    vector4() = default;
    vector4(T s) : x(s), y(s), z(s), w(s) {}
    vector4(T a, T b, T c, T d) : x(a), y(b), z(c), w(d) {}
    vector4(vector3<T> v, T d) : x(v.x), y(v.y), z(v.z), w(d) {}
    vector2<T> xy() const { return {x, y}; }
    vector3<T> xyz() const { return {x, y, z}; }
};

typedef vector2<float> float2;
typedef vector3<float> float3;
typedef vector4<float> float4;
typedef vector2<uint> uint2;
typedef vector3<uint> uint3;

// Applies a function of one or two scalars to every component.
template <class T, class F> vector2<T> each(vector2<T> a, F f) { return {f(a.x), f(a.y)}; }
template <class T, class F> vector3<T> each(vector3<T> a, F f) { return {f(a.x), f(a.y), f(a.z)}; }
template <class T, class F> vector4<T> each(vector4<T> a, F f) { return {f(a.x), f(a.y), f(a.z), f(a.w)}; }
template <class T, class F> vector2<T> each(vector2<T> a, vector2<T> b, F f) {
    return {f(a.x, b.x), f(a.y, b.y)};
}
template <class T, class F> vector3<T> each(vector3<T> a, vector3<T> b, F f) {
    return {f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};
}
template <class T, class F> vector4<T> each(vector4<T> a, vector4<T> b, F f) {
    return {f(a.x, b.x), f(a.y, b.y), f(a.z, b.z), f(a.w, b.w)};
}

#define OPERATOR(V, T, op)                                                                        \
    inline V operator op(V a, V b) { return each(a, b, [](T x, T y) -> T { return x op y; }); }     \
    inline V operator op(V a, T b) { return a op V(b); }                                           \
    inline V operator op(T a, V b) { return V(a) op b; }
#define FLOATS(V)                                                                                 \
    OPERATOR(V, float, +) OPERATOR(V, float, -) OPERATOR(V, float, *) OPERATOR(V, float, /)         \
    inline V operator-(V a) { return each(a, [](float x) { return -x; }); }                        \
    inline V floor(V a) { return each(a, [](float x) { return std::floor(x); }); }                 \
    inline V fabs(V a) { return each(a, [](float x) { return std::fabs(x); }); }                   \
    inline V sqrt(V a) { return each(a, [](float x) { return std::sqrt(x); }); }                   \
    inline V exp(V a) { return each(a, [](float x) { return std::exp(x); }); }                     \
    inline V max(V a, V b) { return each(a, b, [](float x, float y) { return x < y ? y : x; }); }  \
    inline V min(V a, V b) { return each(a, b, [](float x, float y) { return y < x ? y : x; }); }  \
    inline V max(V a, float b) { return max(a, V(b)); }                                            \
    inline V min(V a, float b) { return min(a, V(b)); }                                            \
    inline V clamp(V a, V low, V high) { return min(max(a, low), high); }                          \
    inline V clamp(V a, float low, float high) { return min(max(a, V(low)), V(high)); }            \
    inline float length(V a) { return std::sqrt(dot(a, a)); }                                      \
    inline V normalize(V a) { return a / length(a); }
#define UINTS(V)                                                                                  \
    OPERATOR(V, uint, +) OPERATOR(V, uint, *) OPERATOR(V, uint, ^) OPERATOR(V, uint, >>)

inline float dot(float2 a, float2 b) { return a.x * b.x + a.y * b.y; }
inline float dot(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline float dot(float4 a, float4 b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
FLOATS(float2) FLOATS(float3) FLOATS(float4)
UINTS(uint2) UINTS(uint3)

inline float3 cross(float3 a, float3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> T max(T a, T b) { return a < b ? b : a; }
template <class T> T min(T a, T b) { return b < a ? b : a; }
inline float clamp(float a, float low, float high) { return min(max(a, low), high); }
inline float rsqrt(float a) { return 1.0f / std::sqrt(a); }
using std::cos;
using std::exp;
using std::exp2;
using std::fabs;
using std::floor;
using std::log;
using std::log2;
using std::sin;
using std::sqrt;

template <class To, class From> To bits(From from) {
    To to;
    std::memcpy(&to, &from, sizeof to);
    return to;
}
inline float as_float(uint a) { return bits<float>(a); }
inline uint as_uint(float a) { return bits<uint>(a); }
inline int as_int(uint a) { return bits<int>(a); }
inline uint as_uint(int a) { return bits<uint>(a); }
