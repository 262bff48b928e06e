// The obvious fake fur, as one writes it by hand: Goldman 1997 with the lecture's misprints put right, the
// built-in functions of the language, no guard and no care for accuracy. `fur_by_hand` takes every parameter;
// `fur_by_hand_fixed` has those of dense-fur.toml typed in, and leaves out what they make neutral.

fn fur_by_hand(
    density: f32, hair_length: f32, radius_base: f32, radius_tip: f32, k_diffuse: vec3<f32>, k_specular:
    vec3<f32>, exponent: f32, rho_reflect: f32, rho_transmit: f32, rho_surface: f32, cos_dark: f32,
    cos_lit: f32, overlap: f32, t: vec3<f32>, n: vec3<f32>, v: vec3<f32>, skin: vec3<f32>, l: vec3<f32>,
    light: vec3<f32>
) -> vec3<f32> {
    let cl = dot(t, l);
    let cv = dot(t, v);
    let sl = sqrt(1.0 - cl * cl);
    let sv = sqrt(1.0 - cv * cv);
    let kappa = dot(normalize(cross(t, l)), normalize(cross(t, v)));
    let f_dir = (1.0 + kappa) * 0.5 * rho_reflect + (1.0 - kappa) * 0.5 * rho_transmit;
    let nl = dot(n, l);
    let f_surface = 1.0 + rho_surface * (smoothstep(cos_dark, cos_lit, nl) - 1.0);
    let area = density * hair_length * (radius_base + radius_tip);
    let alpha_v = 1.0 - exp(-area * sv / dot(n, v));
    let alpha_l = 1.0 - exp(-area * sl / nl);
    let psi = k_diffuse * sl + k_specular * pow(max(sl * sv - cl * cv, 0.0), exponent);
    let hair = psi * (f_dir * f_surface * (1.0 - overlap * alpha_l));
    let under = skin * (1.0 - alpha_l);
    return light * (hair * alpha_v + under * (1.0 - alpha_v));
}

fn fur_by_hand_fixed(
    t: vec3<f32>, n: vec3<f32>, v: vec3<f32>, l: vec3<f32>, light: vec3<f32>
) -> vec3<f32> {
    let cl = dot(t, l);
    let cv = dot(t, v);
    let sl = sqrt(1.0 - cl * cl);
    let sv = sqrt(1.0 - cv * cv);
    let nl = dot(n, l);
    let alpha_v = 1.0 - exp(-4.5 * sv / dot(n, v));
    let alpha_l = 1.0 - exp(-4.5 * sl / nl);
    let psi = vec3<f32>(0.45, 0.3, 0.18) * sl + 0.3 * pow(max(sl * sv - cl * cv, 0.0), 40.0);
    let hair = psi * (0.7 * (1.0 - 0.5 * alpha_l));
    let under = vec3<f32>(0.3, 0.2, 0.15) * (1.0 - alpha_l);
    return light * (hair * alpha_v + under * (1.0 - alpha_v));
}
