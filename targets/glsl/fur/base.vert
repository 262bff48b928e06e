$head
$library

$frame

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 comb;
layout(location = 3) in vec2 uv;
layout(location = 4) in float length_share;
layout(location = 5) in float density_share;
layout(location = 6) in vec4 lit;   //? shadowed

out vec3 at_position;
out vec3 at_normal;
out vec3 at_tangent;
out vec2 at_share;
out vec4 at_lit;   //? shadowed

void main()
{
    at_position = position;
    at_normal = normal;
    at_tangent = vair_shell_tangent(normal, 0.0, comb, fur.force);
    at_share = vec2(length_share, density_share);
    at_lit = lit;   //? shadowed
    gl_Position = fur.view_projection * vec4(position, 1.0);
}
