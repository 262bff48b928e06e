$head
$library

$frame

in vec3 at_position;
in vec3 at_normal;
in vec3 at_tangent;
in vec2 at_share;
in vec4 at_lit;   // shares of lights that arrive   //? shadowed

layout(location = 0) out vec4 colour;

$lighting

void main()
{
    vec3 n = vair_safe_normalize_dot(at_normal, vec3(0.0, 0.0, 1.0));
    vec3 t = vair_safe_normalize_dot(at_tangent, n);
    colour = vec4(fur_radiance(at_position, n, t, 0.0, at_share.x, at_share.y), 1.0);
}
