// What both stages share.
layout(std140) uniform StrandFrame {
    mat4 view_projection;
    vec3 eye;
    float width;
    float tip_share;
    float s_min;
    uint light_count;
    vec4 light_direction[$lights];
    vec4 light_colour[$lights];
$material
} hair;
