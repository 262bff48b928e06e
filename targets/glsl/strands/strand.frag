$head
$library

$frame

in vec3 at_position;
in vec3 at_normal;
in vec3 at_tangent;
in float at_share;

layout(location = 0) out vec4 colour;

$lighting

void main()
{
    vec3 n = vair_safe_normalize(at_normal, vec3(0.0, 0.0, 1.0));
    vec3 t = vair_safe_normalize(at_tangent, n);
    colour = vec4(strand_radiance(at_position, n, t, at_share), 1.0);
}
