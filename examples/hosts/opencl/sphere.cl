// A sphere that is brushed along its circles of latitude, under one light: one work item a pixel.
#include "vair-1.2.cl"

kernel void sphere(global uchar4 *pixels, int side) {
    int column = get_global_id(0), row = get_global_id(1);
    float2 place = (float2)(column + 0.5f, side - row - 0.5f) * (2.0f / side) - 1.0f;
    float inside = 1.0f - dot(place, place);
    float3 n = (float3)(place, sqrt(max(inside, 0.0f)));
    float3 t = (float3)(n.z, 0.0f, -n.x) / max(length(n.xz), 1e-6f);
    float3 l = normalize((float3)(0.5f, 0.6f, 0.8f));
    float3 v = (float3)(0.0f, 0.0f, 1.0f);
    float3 shade = vair_banks_shade(t, n, l, v, (float3)(0.5f, 0.3f, 0.2f), (float3)(0.5f), 24.0f);
    float4 pixel = (float4)(inside > 0.0f ? sqrt(shade) : (float3)(0.0f), 1.0f);
    pixels[row * side + column] = convert_uchar4_sat_rte(255.0f * pixel);
}
