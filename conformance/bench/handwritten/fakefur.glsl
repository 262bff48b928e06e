// The obvious fake fur, as one writes it by hand: Goldman 1997 with the lecture's misprints put right, the
// built-in functions of the language, no guard and no care for accuracy. `fur_by_hand` takes every parameter;
// `fur_by_hand_fixed` has those of dense-fur.toml typed in, and leaves out what they make neutral.

vec3 fur_by_hand(
    float density, float hair_length, float radius_base, float radius_tip, vec3 k_diffuse, vec3 k_specular, float exponent, float rho_reflect, float rho_transmit, float rho_surface, float
    cos_dark, float cos_lit, float overlap, vec3 t, vec3 n, vec3 v, vec3 skin, vec3 l, vec3 light
) {
    float cl = dot(t, l);
    float cv = dot(t, v);
    float sl = sqrt(1.0 - cl * cl);
    float sv = sqrt(1.0 - cv * cv);
    float kappa = dot(normalize(cross(t, l)), normalize(cross(t, v)));
    float f_dir = (1.0 + kappa) * 0.5 * rho_reflect + (1.0 - kappa) * 0.5 * rho_transmit;
    float nl = dot(n, l);
    float f_surface = 1.0 + rho_surface * (smoothstep(cos_dark, cos_lit, nl) - 1.0);
    float area = density * hair_length * (radius_base + radius_tip);
    float alpha_v = 1.0 - exp(-area * sv / dot(n, v));
    float alpha_l = 1.0 - exp(-area * sl / nl);
    vec3 psi = k_diffuse * sl + k_specular * pow(max(sl * sv - cl * cv, 0.0), exponent);
    vec3 hair = psi * (f_dir * f_surface * (1.0 - overlap * alpha_l));
    vec3 under = skin * (1.0 - alpha_l);
    return light * (hair * alpha_v + under * (1.0 - alpha_v));
}

vec3 fur_by_hand_fixed(
    vec3 t, vec3 n, vec3 v, vec3 l, vec3 light
) {
    float cl = dot(t, l);
    float cv = dot(t, v);
    float sl = sqrt(1.0 - cl * cl);
    float sv = sqrt(1.0 - cv * cv);
    float nl = dot(n, l);
    float alpha_v = 1.0 - exp(-4.5 * sv / dot(n, v));
    float alpha_l = 1.0 - exp(-4.5 * sl / nl);
    vec3 psi = vec3(0.45, 0.3, 0.18) * sl + 0.3 * pow(max(sl * sv - cl * cv, 0.0), 40.0);
    vec3 hair = psi * (0.7 * (1.0 - 0.5 * alpha_l));
    vec3 under = vec3(0.3, 0.2, 0.15) * (1.0 - alpha_l);
    return light * (hair * alpha_v + under * (1.0 - alpha_v));
}
