$head
$library

$frame

in vec3 at_position;
in vec3 at_normal;
in vec3 at_tangent;
in vec2 at_share;
in vec4 at_lit;   // shares of lights that arrive   //? shadowed
in vec2 at_uv;
flat in vec2 at_layer;   // height, opacity

layout(location = 0) out vec4 colour;

$lighting

void main()
{
    float height = at_layer.x;
    float thickness = vair_thinned(fur.thickness, at_share.y);   //? painted
    float thickness = fur.thickness;   //? whole
    float alpha = at_layer.y * vair_shell_strand_mask(at_uv, height, fur.hairs, thickness, fur.seed);
    if (alpha <= 0.0) {
        discard;
    }
    vec3 n = vair_safe_normalize_dot(at_normal, vec3(0.0, 0.0, 1.0));
    vec3 t = vair_safe_normalize_dot(at_tangent, n);
    colour = vec4(fur_radiance(at_position, n, t, height, at_share.x, at_share.y), alpha);
}
