// Light that a point of a strand sends to the eye, all lights together.
vec3 strand_radiance(vec3 position, vec3 n, vec3 t, float share)
{
    vec3 v = vair_safe_normalize(hair.eye - position, n);
    vec3 radiance = vec3(0.0);
    for (uint k = 0u; k < hair.light_count; k++) {
        vec3 l = hair.light_direction[k].xyz;
        vec3 light = hair.light_colour[k].xyz;
$shading
        radiance += reflected;
    }
    return vair_shell_shadow(clamp(share, 0.0, 1.0), hair.s_min) * radiance;
}
