// What all stages share; fur.json lists every member with its offset.
layout(std140) uniform FurFrame {
    mat4 view_projection;
    vec3 eye;
    float coat_length;
    vec3 force;
    float s_min;
    float hairs;
    float thickness;
    float opacity;
    float authored_layers;
    uint layers;
    uint seed;
    uint light_count;
    float fin_threshold;
    float rho_surface;
    float cos_dark;
    float cos_lit;
    float fin_opacity;
    vec4 light_direction[$lights];
    vec4 light_colour[$lights];
$material
} fur;
