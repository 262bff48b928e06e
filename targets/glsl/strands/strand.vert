$head
$library

$frame

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 along;   // between the neighbours on the strand, of any length
layout(location = 2) in vec3 chord;   // the tangent where they coincide
layout(location = 3) in vec3 root;   // normal of the skin
layout(location = 4) in float side;   // -1 or 1
layout(location = 5) in float share;   // 0 at the root, 1 at the tip

out vec3 at_position;
out vec3 at_normal;
out vec3 at_tangent;
out float at_share;

void main()
{
    vec3 t = vair_safe_normalize(along, chord);
    vec3 v = vair_safe_normalize(hair.eye - position, chord);
    vec3 across = vair_safe_normalize(cross(t, v), root);
    float half_width = 0.5 * hair.width * vair_shell_shadow(1.0 - share, hair.tip_share);
    at_position = position + side * half_width * across;
    at_normal = root;
    at_tangent = t;
    at_share = share;
    gl_Position = hair.view_projection * vec4(at_position, 1.0);
}
