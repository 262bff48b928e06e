// One level of a map whose levels lie side by side in one image, each with a border of one texel
// that continues it beyond its edges.
//   t         the image; linear, unnormalised, clamped to the edge is what its sampler has to be
//   t_layout  width and height of level 0, levels, edges: 1 repeats u, 2 repeats v, 3 both
//   uv        coordinates of the map, (0, 0) to (1, 1)
//   k         the level, from 0 to the last
//   form      level k is width >> k by height >> k, at least 1; its first texel lies in column
//             1 + the sum of (width of level j) + 2 over j < k, in row 1
static inline float4 ${prefix}lookup_packed(
    image2d_t t, sampler_t t_sampler, int4 t_layout, float2 uv, int k) {
    int column = 1;
    for (int j = 0; j < k; j++) {
        column += max(t_layout.x >> j, 1) + 2;
    }
    float2 size = (float2)((float)max(t_layout.x >> k, 1), (float)max(t_layout.y >> k, 1));
    float x = (t_layout.w & 1) != 0 ? uv.x - floor(uv.x) : clamp(uv.x, 0.0f, 1.0f);
    float y = (t_layout.w & 2) != 0 ? uv.y - floor(uv.y) : clamp(uv.y, 0.0f, 1.0f);
    return read_imagef(t, t_sampler, (float2)((float)column, 1.0f) + (float2)(x, y) * size);
}

// Lookup in two levels of such a map, linear between them.
//   t, t_sampler, t_layout, uv  as above
//   lod                         in levels from the largest, at least 0; the last one stays
static inline float4 ${prefix}lookup_level(
    image2d_t t, sampler_t t_sampler, int4 t_layout, float2 uv, float lod) {
    float held = clamp(lod, 0.0f, (float)(t_layout.z - 1));
    int first = (int)held;
    float4 a = ${prefix}lookup_packed(t, t_sampler, t_layout, uv, first);
    if (held == (float)first) {
        return a;
    }
    float4 b = ${prefix}lookup_packed(t, t_sampler, t_layout, uv, min(first + 1, t_layout.z - 1));
    return a + (held - (float)first) * (b - a);
}
