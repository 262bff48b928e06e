$head
$library

$frame

in vec3 at_position;
in vec3 at_normal;
in vec3 at_tangent;
in vec2 at_share;
in vec4 at_lit;   // shares of lights that arrive   //? shadowed
in vec3 at_uv;   // along the edge, row of hairs, height
in float at_opacity;

layout(location = 0) out vec4 colour;

$lighting

void main()
{
    float height = clamp(at_uv.z, 0.0, 1.0);
    float thickness = vair_thinned(fur.thickness, at_share.y);   //? painted
    float thickness = fur.thickness;   //? whole
    float mask = vair_fin_strand_mask(
        at_uv.x, floor(at_uv.y + 0.5), height, fur.hairs, thickness, fur.seed);
    float alpha = vair_fin_alpha(at_opacity, height, mask);
    if (alpha <= 0.0) {
        discard;
    }
    vec3 n = vair_safe_normalize_dot(at_normal, vec3(0.0, 0.0, 1.0));
    vec3 t = vair_safe_normalize_dot(at_tangent, n);
    colour = vec4(fur_radiance(at_position, n, t, height, at_share.x, at_share.y), alpha);
}
