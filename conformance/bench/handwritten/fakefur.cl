// The obvious fake fur, as one writes it by hand: Goldman 1997 with the lecture's misprints put right, the
// built-in functions of the language, no guard and no care for accuracy. `fur_by_hand` takes every parameter;
// `fur_by_hand_fixed` has those of dense-fur.toml typed in, and leaves out what they make neutral.

static inline float3 fur_by_hand(
    float density, float hair_length, float radius_base, float radius_tip, float3 k_diffuse, float3 k_specular, float exponent, float rho_reflect, float rho_transmit, float rho_surface, float
    cos_dark, float cos_lit, float overlap, float3 t, float3 n, float3 v, float3 skin, float3 l, float3
    light
) {
    float cl = dot(t, l);
    float cv = dot(t, v);
    float sl = sqrt(1.0f - cl * cl);
    float sv = sqrt(1.0f - cv * cv);
    float kappa = dot(normalize(cross(t, l)), normalize(cross(t, v)));
    float f_dir = (1.0f + kappa) * 0.5f * rho_reflect + (1.0f - kappa) * 0.5f * rho_transmit;
    float nl = dot(n, l);
    float f_surface = 1.0f + rho_surface * (smoothstep(cos_dark, cos_lit, nl) - 1.0f);
    float area = density * hair_length * (radius_base + radius_tip);
    float alpha_v = 1.0f - exp(-area * sv / dot(n, v));
    float alpha_l = 1.0f - exp(-area * sl / nl);
    float3 psi = k_diffuse * sl + k_specular * pow(max(sl * sv - cl * cv, 0.0f), exponent);
    float3 hair = psi * (f_dir * f_surface * (1.0f - overlap * alpha_l));
    float3 under = skin * (1.0f - alpha_l);
    return light * (hair * alpha_v + under * (1.0f - alpha_v));
}

static inline float3 fur_by_hand_fixed(
    float3 t, float3 n, float3 v, float3 l, float3 light
) {
    float cl = dot(t, l);
    float cv = dot(t, v);
    float sl = sqrt(1.0f - cl * cl);
    float sv = sqrt(1.0f - cv * cv);
    float nl = dot(n, l);
    float alpha_v = 1.0f - exp(-4.5f * sv / dot(n, v));
    float alpha_l = 1.0f - exp(-4.5f * sl / nl);
    float3 psi = (float3)(0.45f, 0.3f, 0.18f) * sl + 0.3f * pow(max(sl * sv - cl * cv, 0.0f), 40.0f);
    float3 hair = psi * (0.7f * (1.0f - 0.5f * alpha_l));
    float3 under = (float3)(0.3f, 0.2f, 0.15f) * (1.0f - alpha_l);
    return light * (hair * alpha_v + under * (1.0f - alpha_v));
}
