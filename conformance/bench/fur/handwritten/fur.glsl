// The furry bunny as one writes it by hand: shells and fins after Lengyel et al. 2001, lit by fake fur after
// Goldman 1997 with the lecture's misprints put right, by the built-in functions of the language. Guards stand
// where every engine has them: below roots and divisions. What depends on the viewer alone is computed once.
// The masks are the library's whole numbers, so that the same hairs are drawn.
//
// One of BASE, SHELL, FIN and one of VERTEX, FRAGMENT is defined above; FLOOR leaves the light out.

layout(std140) uniform FurFrame {
    mat4 view_projection;
    vec3 eye;
    float coat_length;
    vec3 force;
    float s_min;
    float hairs;
    float thickness;
    float opacity;
    float authored_layers;
    uint layers;
    uint seed;
    uint light_count;
    float fin_threshold;
    float rho_surface;
    float cos_dark;
    float cos_lit;
    float fin_opacity;
    vec4 light_direction[8];
    vec4 light_colour[8];
#ifndef FLOOR
    float shade_coat_density;
    float shade_coat_hair_length;
    float shade_coat_radius_base;
    float shade_coat_radius_tip;
    vec3 shade_optics_k_diffuse;
    vec3 shade_optics_k_specular;
    float shade_optics_exponent;
    float shade_optics_rho_reflect;
    float shade_optics_rho_transmit;
    float shade_optics_rho_surface;
    float shade_optics_cos_dark;
    float shade_optics_cos_lit;
    float shade_optics_overlap;
    vec3 shade_skin;
#endif
} fur;

#ifdef VERTEX
#define BETWEEN out
#else
#define BETWEEN in
#endif

BETWEEN vec3 at_position;
BETWEEN vec3 at_normal;
BETWEEN vec3 at_tangent;
BETWEEN vec2 at_share;
#ifdef SHELL
BETWEEN vec2 at_uv;
flat BETWEEN vec2 at_layer;   // height, opacity
#endif
#ifdef FIN
BETWEEN vec3 at_uv;   // along the edge, row of hairs, height
BETWEEN float at_opacity;
#endif

#ifdef VERTEX

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 comb;
layout(location = 3) in vec2 uv;
layout(location = 4) in float length_share;
layout(location = 5) in float density_share;
#ifdef FIN
layout(location = 6) in vec3 face_a;
layout(location = 7) in vec3 face_b;
layout(location = 8) in float w;
#endif

vec3 tangent_at(float height)
{
    vec3 along = normal + height * (comb + height * fur.force);
    vec3 change = comb + 2.0 * height * fur.force;
    float size = length(along);
    vec3 u = along / size;
    return normalize(u + height / size * (change - u * dot(u, change)));
}

void main()
{
    at_position = position;
    float height = 0.0;
#ifdef SHELL
    height = float(gl_InstanceID + 1) / float(fur.layers - 1u);
    vec3 along = normalize(normal + height * (comb + height * fur.force));
    at_position += fur.coat_length * length_share * height * along;
    at_uv = uv;
    at_layer = vec2(height, 1.0 - pow(1.0 - fur.opacity, fur.authored_layers / float(fur.layers - 1u)));
#endif
#ifdef FIN
    height = w;
    at_position += fur.coat_length * length_share * w * normalize(normal + comb + fur.force);
    at_uv = vec3(uv, w);
    vec3 v = normalize(fur.eye - position);
    float a = dot(v, face_a);
    float b = dot(v, face_b);
    float grazing = min(abs(a), abs(b)) / fur.fin_threshold;
    at_opacity = fur.fin_opacity * (a * b <= 0.0 ? 1.0 : clamp(1.0 - grazing, 0.0, 1.0));
#endif
    at_normal = normal;
    at_tangent = tangent_at(height);
    at_share = vec2(length_share, density_share);
    gl_Position = fur.view_projection * vec4(at_position, 1.0);
}

#else

layout(location = 0) out vec4 colour;

uvec3 pcg3d(uvec3 x)
{
    x = x * 1664525u + 1013904223u;
    x.x += x.y * x.z;
    x.y += x.z * x.x;
    x.z += x.x * x.y;
    x ^= x >> 16u;
    x.x += x.y * x.z;
    x.y += x.z * x.x;
    x.z += x.x * x.y;
    return x;
}

float strand_mask(vec2 uv, float height, float thickness)
{
    uvec2 place = uvec2(uv * 1048576.0) * uint(fur.hairs);
    place.x += ((place.y >> 20u) & 1u) << 19u;
    uvec3 random = pcg3d(uvec3(place >> 20u, fur.seed)) >> 17u;
    uint tip = 32768u + random.z;
    uint widest = uint(thickness * 16384.0);
    uint base = (widest * tip) >> 16u;
    uint radius = (widest * (tip - min(uint(height * 65536.0), tip))) >> 16u;
    uvec2 centre = base + ((random.xy * (32768u - 2u * base)) >> 15u);
    uvec2 away = ((place >> 5u) & 32767u) - centre;
    return away.x * away.x + away.y * away.y < radius * radius ? 1.0 : 0.0;
}

#ifndef FLOOR
vec3 fake_fur(vec3 n, vec3 t, float height)
{
    vec3 v = normalize(fur.eye - at_position);
    float cv = dot(t, v);
    float sv = sqrt(max(1.0 - cv * cv, 0.0));
    float area = fur.shade_coat_density * at_share.y * fur.shade_coat_hair_length * at_share.x
        * (fur.shade_coat_radius_base + fur.shade_coat_radius_tip);
    float clear_v = exp(-area * sv / max(dot(n, v), 0.0001));
    vec3 radiance = vec3(0.0);
    for (uint k = 0u; k < fur.light_count; k++) {
        vec3 l = fur.light_direction[k].xyz;
        float cl = dot(t, l);
        float sl = sqrt(max(1.0 - cl * cl, 0.0));
        float nl = dot(n, l);
        float kappa = (dot(l, v) - cl * cv) / max(sl * sv, 0.0001);
        float f_dir = mix(fur.shade_optics_rho_transmit, fur.shade_optics_rho_reflect, 0.5 * kappa + 0.5);
        float lit = smoothstep(fur.shade_optics_cos_dark, fur.shade_optics_cos_lit, nl);
        float f_surface = 1.0 + fur.shade_optics_rho_surface * (lit - 1.0);
        float clear_l = exp(-area * sl / max(nl, 0.0001));
        float highlight = pow(max(sl * sv - cl * cv, 0.0), fur.shade_optics_exponent);
        vec3 hair = fur.shade_optics_k_diffuse * sl + fur.shade_optics_k_specular * highlight;
        float weight = f_dir * f_surface * (1.0 - fur.shade_optics_overlap * (1.0 - clear_l)) * (1.0 - clear_v);
        radiance += fur.light_colour[k].xyz * (hair * weight + fur.shade_skin * (clear_l * clear_v));
    }
    float shadow = mix(1.0, fur.s_min, at_share.x * at_share.y);
    return mix(shadow, 1.0, height) * radiance;
}
#endif

void main()
{
#ifdef BASE
    float height = 0.0;
    float alpha = 1.0;
#endif
#ifdef SHELL
    float height = at_layer.x;
    float thickness = fur.thickness * sqrt(at_share.y);
    float alpha = at_layer.y * strand_mask(at_uv, height, thickness);
#endif
#ifdef FIN
    float height = clamp(at_uv.z, 0.0, 1.0);
    float thickness = fur.thickness * sqrt(at_share.y);
    float row = floor(at_uv.y + 0.5);
    float mask = 0.0;
    for (int k = 0; k < 3; k++) {
        float depth = (row + 0.25 + 0.25 * float(k)) / floor(fur.hairs);
        mask = max(mask, strand_mask(vec2(at_uv.x, depth), height, thickness));
    }
    float alpha = at_opacity * height * height * mask;
#endif
    if (alpha <= 0.0) {
        discard;
    }
#ifdef FLOOR
    colour = vec4(0.5, 0.4, 0.3, alpha);
#else
    colour = vec4(fake_fur(normalize(at_normal), normalize(at_tangent), height), alpha);
#endif
}

#endif
