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
out vec2 at_uv;
flat out vec2 at_layer;   // height, opacity

void main()
{
    // Instances run from the inner to the outer shells; layer 0 is the base.
    uint layer = uint(gl_InstanceID) + 1u;
    float height = vair_shell_height(layer, fur.layers);
    float blended = float(fur.layers) - 1.0;
    at_position = vair_shell_offset(
        position, normal, fur.coat_length * length_share, height, comb, fur.force);
    at_normal = normal;
    at_tangent = vair_shell_tangent(normal, height, comb, fur.force);
    at_share = vec2(length_share, density_share);
    at_lit = lit;   //? shadowed
    at_uv = uv;
    at_layer = vec2(height, vair_shell_alpha_resample(fur.opacity, fur.authored_layers, blended));
    gl_Position = fur.view_projection * vec4(at_position, 1.0);
}
