// Light that a point of the coat sends to the eye, all lights together. The shading function is written
// out, with what all lights share before the loop.
// The first three lights have shadows of their own, all others share the fourth.   //? shadowed
vec3 fur_radiance(vec3 position, vec3 n, vec3 t, float height, float length_share, float density_share)
{
    vec3 v = vair_safe_normalize_dot(fur.eye - position, n);
$before
    vec3 radiance = vec3(0.0);
    if (fur.light_count > 0u) {
        // Tested at the end: drivers that run on the CPU compute one light too many for a test at the start.
        uint k = 0u;
        do {
            vec3 l = fur.light_direction[k].xyz;
            vec3 light = fur.light_colour[k].xyz;   //? open
            vec3 light = at_lit[min(k, 3u)] * fur.light_colour[k].xyz;   //? shadowed
$each
            k++;
        } while (k < fur.light_count);
    }
    return vair_coat_shadow(height, fur.s_min, density_share * length_share) * radiance;   //? painted
    return vair_shell_shadow(height, fur.s_min) * radiance;   //? whole
}
