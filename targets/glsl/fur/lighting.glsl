// Light that a point of the coat sends to the eye, all lights together.
// The first three lights have shadows of their own, all others share the fourth.   //? shadowed
vec3 fur_radiance(vec3 position, vec3 n, vec3 t, float height, float length_share, float density_share)
{
    vec3 v = vair_safe_normalize(fur.eye - position, n);
    vec3 radiance = vec3(0.0);
    for (uint k = 0u; k < fur.light_count; k++) {
        vec3 l = fur.light_direction[k].xyz;
        vec3 light = fur.light_colour[k].xyz;   //? open
        vec3 light = at_lit[min(k, 3u)] * fur.light_colour[k].xyz;   //? shadowed
$shading
        float surface = vair_fur_surface_attenuation(dot(n, l), fur.rho_surface, fur.cos_dark, fur.cos_lit);
        radiance += surface * reflected;
    }
    return vair_coat_shadow(height, fur.s_min, density_share * length_share) * radiance;
}
