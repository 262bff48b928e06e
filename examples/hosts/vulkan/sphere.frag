#version 450
// A sphere that is brushed along its circles of latitude, under one light.
#extension GL_GOOGLE_include_directive : require
#include "vair-vulkan450.glsl"

layout(location = 0) in vec2 place;
layout(location = 0) out vec4 pixel;

void main() {
    float inside = 1.0 - dot(place, place);
    vec3 n = vec3(place, sqrt(max(inside, 0.0)));
    vec3 t = vec3(n.z, 0.0, -n.x) / max(length(n.xz), 1e-6);
    vec3 l = normalize(vec3(0.5, 0.6, 0.8));
    vec3 v = vec3(0.0, 0.0, 1.0);
    vec3 shade = vair_banks_shade(t, n, l, v, vec3(0.5, 0.3, 0.2), vec3(0.5), 24.0);
    pixel = vec4(inside > 0.0 ? sqrt(shade) : vec3(0.0), 1.0);
}
