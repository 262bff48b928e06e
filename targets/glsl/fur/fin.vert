$head
$library

$frame

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 comb;
layout(location = 3) in vec2 uv;   // along the edge; row of hairs
layout(location = 4) in float length_share;
layout(location = 5) in float density_share;
layout(location = 6) in vec3 face_a;
layout(location = 7) in vec3 face_b;
layout(location = 8) in float w;   // 0 at the skin, 1 at the tips
layout(location = 9) in vec4 lit;   //? shadowed

out vec3 at_position;
out vec3 at_normal;
out vec3 at_tangent;
out vec2 at_share;
out vec4 at_lit;   //? shadowed
out vec3 at_uv;   // along the edge, row of hairs, height
out float at_opacity;

void main()
{
    vec3 direction = vair_fin_direction(normal, comb, fur.force);
    vec3 v = vair_safe_normalize(fur.eye - position, normal);
    at_position = vair_fin_position(position, direction, w, fur.coat_length * length_share);
    at_normal = normal;
    at_tangent = vair_shell_tangent(normal, w, comb, fur.force);
    at_share = vec2(length_share, density_share);
    at_lit = lit;   //? shadowed
    at_uv = vec3(uv, w);
    at_opacity = fur.fin_opacity
        * vair_fin_opacity_silhouette(dot(v, face_a), dot(v, face_b), fur.fin_threshold);
    // w says which end of the hair this is; the homogeneous coordinate of a position is 1.
    gl_Position = fur.view_projection * vec4(at_position, 1.0);
}
