// The furry bunny as one writes it by hand: shells and fins after Lengyel et al. 2001, lit by fake fur after
// Goldman 1997 with the lecture's misprints put right, by the built-in functions of the language. Guards stand
// where every engine has them: below roots and divisions. What depends on the viewer alone is computed once.
// The masks are the library's whole numbers, so that the same hairs are drawn.

struct FurFrame {
    view_projection: mat4x4<f32>,
    eye: vec3<f32>,
    coat_length: f32,
    force: vec3<f32>,
    s_min: f32,
    hairs: f32,
    thickness: f32,
    opacity: f32,
    authored_layers: f32,
    layers: u32,
    seed: u32,
    light_count: u32,
    fin_threshold: f32,
    rho_surface: f32,
    cos_dark: f32,
    cos_lit: f32,
    fin_opacity: f32,
    light_direction: array<vec4<f32>, 8>,
    light_colour: array<vec4<f32>, 8>,
    shade_coat_density: f32,
    shade_coat_hair_length: f32,
    shade_coat_radius_base: f32,
    shade_coat_radius_tip: f32,
    shade_optics_k_diffuse: vec3<f32>,
    shade_optics_k_specular: vec3<f32>,
    shade_optics_exponent: f32,
    shade_optics_rho_reflect: f32,
    shade_optics_rho_transmit: f32,
    shade_optics_rho_surface: f32,
    shade_optics_cos_dark: f32,
    shade_optics_cos_lit: f32,
    shade_optics_overlap: f32,
    shade_skin: vec3<f32>,
}

@group(0) @binding(0) var<uniform> fur: FurFrame;

struct FurVertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) comb: vec3<f32>,
    @location(3) uv: vec2<f32>,
    @location(4) length_share: f32,
    @location(5) density_share: f32,
}

struct FinVertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) comb: vec3<f32>,
    @location(3) uv: vec2<f32>,
    @location(4) length_share: f32,
    @location(5) density_share: f32,
    @location(6) face_a: vec3<f32>,
    @location(7) face_b: vec3<f32>,
    @location(8) w: f32,
}

struct BasePoint {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec3<f32>,
    @location(3) share: vec2<f32>,
}

struct ShellPoint {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec3<f32>,
    @location(3) share: vec2<f32>,
    @location(4) uv: vec2<f32>,
    @location(5) @interpolate(flat, either) layer: vec2<f32>,   // height, opacity
}

struct FinPoint {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec3<f32>,
    @location(3) share: vec2<f32>,
    @location(4) uv: vec3<f32>,   // along the edge, row of hairs, height
    @location(5) opacity: f32,
}

fn tangent_at(normal: vec3<f32>, comb: vec3<f32>, height: f32) -> vec3<f32> {
    let along = normal + height * (comb + height * fur.force);
    let change = comb + 2.0 * height * fur.force;
    let size = length(along);
    let u = along / size;
    return normalize(u + height / size * (change - u * dot(u, change)));
}

@vertex
fn base_vertex(vertex: FurVertex) -> BasePoint {
    var point: BasePoint;
    point.position = vertex.position;
    point.normal = vertex.normal;
    point.tangent = tangent_at(vertex.normal, vertex.comb, 0.0);
    point.share = vec2<f32>(vertex.length_share, vertex.density_share);
    point.clip = fur.view_projection * vec4<f32>(vertex.position, 1.0);
    return point;
}

@vertex
fn shell_vertex(vertex: FurVertex, @builtin(instance_index) instance: u32) -> ShellPoint {
    let blended = f32(fur.layers - 1u);
    let height = f32(instance + 1u) / blended;
    let along = normalize(vertex.normal + height * (vertex.comb + height * fur.force));
    var point: ShellPoint;
    point.position = vertex.position + fur.coat_length * vertex.length_share * height * along;
    point.normal = vertex.normal;
    point.tangent = tangent_at(vertex.normal, vertex.comb, height);
    point.share = vec2<f32>(vertex.length_share, vertex.density_share);
    point.uv = vertex.uv;
    point.layer = vec2<f32>(height, 1.0 - pow(1.0 - fur.opacity, fur.authored_layers / blended));
    point.clip = fur.view_projection * vec4<f32>(point.position, 1.0);
    return point;
}

@vertex
fn fin_vertex(vertex: FinVertex) -> FinPoint {
    let v = normalize(fur.eye - vertex.position);
    let a = dot(v, vertex.face_a);
    let b = dot(v, vertex.face_b);
    let grazing = min(abs(a), abs(b)) / fur.fin_threshold;
    let along = normalize(vertex.normal + vertex.comb + fur.force);
    var point: FinPoint;
    point.position = vertex.position + fur.coat_length * vertex.length_share * vertex.w * along;
    point.normal = vertex.normal;
    point.tangent = tangent_at(vertex.normal, vertex.comb, vertex.w);
    point.share = vec2<f32>(vertex.length_share, vertex.density_share);
    point.uv = vec3<f32>(vertex.uv, vertex.w);
    point.opacity = fur.fin_opacity * select(clamp(1.0 - grazing, 0.0, 1.0), 1.0, a * b <= 0.0);
    point.clip = fur.view_projection * vec4<f32>(point.position, 1.0);
    return point;
}

fn pcg3d(given: vec3<u32>) -> vec3<u32> {
    var x = given * 1664525u + 1013904223u;
    x.x += x.y * x.z;
    x.y += x.z * x.x;
    x.z += x.x * x.y;
    x ^= x >> vec3<u32>(16u);
    x.x += x.y * x.z;
    x.y += x.z * x.x;
    x.z += x.x * x.y;
    return x;
}

fn strand_mask(uv: vec2<f32>, height: f32, thickness: f32) -> f32 {
    var place = vec2<u32>(uv * 1048576.0) * u32(fur.hairs);
    place.x += ((place.y >> 20u) & 1u) << 19u;
    let random = pcg3d(vec3<u32>(place >> vec2<u32>(20u), fur.seed)) >> vec3<u32>(17u);
    let tip = 32768u + random.z;
    let widest = u32(thickness * 16384.0);
    let base = (widest * tip) >> 16u;
    let radius = (widest * (tip - min(u32(height * 65536.0), tip))) >> 16u;
    let centre = base + ((random.xy * (32768u - 2u * base)) >> vec2<u32>(15u));
    let away = ((place >> vec2<u32>(5u)) & vec2<u32>(32767u)) - centre;
    return select(0.0, 1.0, away.x * away.x + away.y * away.y < radius * radius);
}

fn fake_fur(
    position: vec3<f32>, n: vec3<f32>, t: vec3<f32>, height: f32, share: vec2<f32>
) -> vec3<f32> {
    let v = normalize(fur.eye - position);
    let cv = dot(t, v);
    let sv = sqrt(max(1.0 - cv * cv, 0.0));
    let area = fur.shade_coat_density * share.y * fur.shade_coat_hair_length * share.x
        * (fur.shade_coat_radius_base + fur.shade_coat_radius_tip);
    let clear_v = exp(-area * sv / max(dot(n, v), 0.0001));
    var radiance = vec3<f32>(0.0);
    for (var k = 0u; k < fur.light_count; k++) {
        let l = fur.light_direction[k].xyz;
        let cl = dot(t, l);
        let sl = sqrt(max(1.0 - cl * cl, 0.0));
        let nl = dot(n, l);
        let kappa = (dot(l, v) - cl * cv) / max(sl * sv, 0.0001);
        let f_dir = mix(fur.shade_optics_rho_transmit, fur.shade_optics_rho_reflect, 0.5 * kappa + 0.5);
        let lit = smoothstep(fur.shade_optics_cos_dark, fur.shade_optics_cos_lit, nl);
        let f_surface = 1.0 + fur.shade_optics_rho_surface * (lit - 1.0);
        let clear_l = exp(-area * sl / max(nl, 0.0001));
        let highlight = pow(max(sl * sv - cl * cv, 0.0), fur.shade_optics_exponent);
        let hair = fur.shade_optics_k_diffuse * sl + fur.shade_optics_k_specular * highlight;
        let weight = f_dir * f_surface * (1.0 - fur.shade_optics_overlap * (1.0 - clear_l)) * (1.0 - clear_v);
        radiance += fur.light_colour[k].xyz * (hair * weight + fur.shade_skin * (clear_l * clear_v));
    }
    let shadow = mix(1.0, fur.s_min, share.x * share.y);
    return mix(shadow, 1.0, height) * radiance;
}

@fragment
fn base_fragment(point: BasePoint) -> @location(0) vec4<f32> {
    let t = normalize(point.tangent);
    return vec4<f32>(fake_fur(point.position, normalize(point.normal), t, 0.0, point.share), 1.0);
}

@fragment
fn shell_fragment(point: ShellPoint) -> @location(0) vec4<f32> {
    let height = point.layer.x;
    let thickness = fur.thickness * sqrt(point.share.y);
    let alpha = point.layer.y * strand_mask(point.uv, height, thickness);
    if (alpha <= 0.0) {
        discard;
    }
    let t = normalize(point.tangent);
    return vec4<f32>(fake_fur(point.position, normalize(point.normal), t, height, point.share), alpha);
}

@fragment
fn fin_fragment(point: FinPoint) -> @location(0) vec4<f32> {
    let height = clamp(point.uv.z, 0.0, 1.0);
    let thickness = fur.thickness * sqrt(point.share.y);
    let row = floor(point.uv.y + 0.5);
    var mask = 0.0;
    for (var k = 0; k < 3; k++) {
        let depth = (row + 0.25 + 0.25 * f32(k)) / floor(fur.hairs);
        mask = max(mask, strand_mask(vec2<f32>(point.uv.x, depth), height, thickness));
    }
    let alpha = point.opacity * height * height * mask;
    if (alpha <= 0.0) {
        discard;
    }
    let t = normalize(point.tangent);
    return vec4<f32>(fake_fur(point.position, normalize(point.normal), t, height, point.share), alpha);
}
