$library

// What all stages share; fur.json lists every member with its offset.
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
    light_direction: array<vec4<f32>, $lights>,
    light_colour: array<vec4<f32>, $lights>,
$material
}

@group(0) @binding(0) var<uniform> fur: FurFrame;

struct FurVertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) comb: vec3<f32>,
    @location(3) uv: vec2<f32>,
    @location(4) length_share: f32,
    @location(5) density_share: f32,
    @location(6) lit: vec4<f32>,   //? shadowed
}

struct FinVertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) comb: vec3<f32>,
    @location(3) uv: vec2<f32>,   // along the edge; row of hairs
    @location(4) length_share: f32,
    @location(5) density_share: f32,
    @location(6) face_a: vec3<f32>,
    @location(7) face_b: vec3<f32>,
    @location(8) w: f32,   // 0 at the skin, 1 at the tips
    @location(9) lit: vec4<f32>,   //? shadowed
}

struct BasePoint {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec3<f32>,
    @location(3) share: vec2<f32>,
    @location(4) lit: vec4<f32>,   // shares of lights that arrive   //? shadowed
}

struct ShellPoint {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec3<f32>,
    @location(3) share: vec2<f32>,
    @location(4) uv: vec2<f32>,
    @location(5) @interpolate(flat, either) layer: vec2<f32>,   // height, opacity
    @location(6) lit: vec4<f32>,   // shares of lights that arrive   //? shadowed
}

struct FinPoint {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec3<f32>,
    @location(3) share: vec2<f32>,
    @location(4) uv: vec3<f32>,   // along the edge, row of hairs, height
    @location(5) opacity: f32,
    @location(6) lit: vec4<f32>,   // shares of lights that arrive   //? shadowed
}

// Light that a point of the coat sends to the eye, all lights together. The shading function is written
// out, with what all lights share before the loop.
// The first three lights have shadows of their own, all others share the fourth.   //? shadowed
fn fur_radiance(
    position: vec3<f32>, n: vec3<f32>, t: vec3<f32>, height: f32, length_share: f32, density_share: f32   //? open
    position: vec3<f32>, n: vec3<f32>, t: vec3<f32>, height: f32, length_share: f32, density_share: f32,   //? shadowed
    lit: vec4<f32>   //? shadowed
) -> vec3<f32> {
    let v = vair_safe_normalize_dot(fur.eye - position, n);
$before
    var radiance = vec3<f32>(0.0);
    if (fur.light_count > 0u) {
        // Tested at the end: drivers that run on the CPU compute one light too many for a test at the start.
        var k = 0u;
        loop {
            let l = fur.light_direction[k].xyz;
            let light = fur.light_colour[k].xyz;   //? open
            let light = lit[min(k, 3u)] * fur.light_colour[k].xyz;   //? shadowed
$each
            continuing {
                k++;
                break if k >= fur.light_count;
            }
        }
    }
    return vair_coat_shadow(height, fur.s_min, density_share * length_share) * radiance;   //? painted
    return vair_shell_shadow(height, fur.s_min) * radiance;   //? whole
}

@vertex
fn base_vertex(vertex: FurVertex) -> BasePoint {
    var point: BasePoint;
    point.position = vertex.position;
    point.normal = vertex.normal;
    point.tangent = vair_shell_tangent(vertex.normal, 0.0, vertex.comb, fur.force);
    point.share = vec2<f32>(vertex.length_share, vertex.density_share);
    point.lit = vertex.lit;   //? shadowed
    point.clip = fur.view_projection * vec4<f32>(vertex.position, 1.0);
    return point;
}

@fragment
fn base_fragment(point: BasePoint) -> @location(0) vec4<f32> {
    let n = vair_safe_normalize_dot(point.normal, vec3<f32>(0.0, 0.0, 1.0));
    let t = vair_safe_normalize_dot(point.tangent, n);
    let radiance = fur_radiance(point.position, n, t, 0.0, point.share.x, point.share.y);   //? open
    let radiance = fur_radiance(point.position, n, t, 0.0, point.share.x, point.share.y, point.lit);   //? shadowed
    return vec4<f32>(radiance, 1.0);
}

@vertex
fn shell_vertex(vertex: FurVertex, @builtin(instance_index) instance: u32) -> ShellPoint {
    // Instances run from the inner to the outer shells; layer 0 is the base.
    let layer = instance + 1u;
    let height = vair_shell_height(layer, fur.layers);
    let blended = f32(fur.layers) - 1.0;
    var point: ShellPoint;
    point.position = vair_shell_offset(
        vertex.position, vertex.normal, fur.coat_length * vertex.length_share, height, vertex.comb, fur.force
    );
    point.normal = vertex.normal;
    point.tangent = vair_shell_tangent(vertex.normal, height, vertex.comb, fur.force);
    point.share = vec2<f32>(vertex.length_share, vertex.density_share);
    point.lit = vertex.lit;   //? shadowed
    point.uv = vertex.uv;
    point.layer = vec2<f32>(
        height, vair_shell_alpha_resample(fur.opacity, fur.authored_layers, blended)
    );
    point.clip = fur.view_projection * vec4<f32>(point.position, 1.0);
    return point;
}

@fragment
fn shell_fragment(point: ShellPoint) -> @location(0) vec4<f32> {
    let height = point.layer.x;
    let thickness = vair_thinned(fur.thickness, point.share.y);   //? painted
    let thickness = fur.thickness;   //? whole
    let alpha = point.layer.y
        * vair_shell_strand_mask(point.uv, height, fur.hairs, thickness, fur.seed);
    if (alpha <= 0.0) {
        discard;
    }
    let n = vair_safe_normalize_dot(point.normal, vec3<f32>(0.0, 0.0, 1.0));
    let t = vair_safe_normalize_dot(point.tangent, n);
    let radiance = fur_radiance(point.position, n, t, height, point.share.x, point.share.y);   //? open
    let radiance = fur_radiance(point.position, n, t, height, point.share.x, point.share.y, point.lit);   //? shadowed
    return vec4<f32>(radiance, alpha);
}

@vertex
fn fin_vertex(vertex: FinVertex) -> FinPoint {
    let direction = vair_fin_direction(vertex.normal, vertex.comb, fur.force);
    let v = vair_safe_normalize(fur.eye - vertex.position, vertex.normal);
    var point: FinPoint;
    point.position = vair_fin_position(
        vertex.position, direction, vertex.w, fur.coat_length * vertex.length_share
    );
    point.normal = vertex.normal;
    point.tangent = vair_shell_tangent(vertex.normal, vertex.w, vertex.comb, fur.force);
    point.share = vec2<f32>(vertex.length_share, vertex.density_share);
    point.lit = vertex.lit;   //? shadowed
    point.uv = vec3<f32>(vertex.uv, vertex.w);
    point.opacity = fur.fin_opacity
        * vair_fin_opacity_silhouette(dot(v, vertex.face_a), dot(v, vertex.face_b), fur.fin_threshold);
    // w says which end of the hair this is; the homogeneous coordinate of a position is 1.
    point.clip = fur.view_projection * vec4<f32>(point.position, 1.0);
    return point;
}

@fragment
fn fin_fragment(point: FinPoint) -> @location(0) vec4<f32> {
    let height = clamp(point.uv.z, 0.0, 1.0);
    let thickness = vair_thinned(fur.thickness, point.share.y);   //? painted
    let thickness = fur.thickness;   //? whole
    let mask = vair_fin_strand_mask(
        point.uv.x, floor(point.uv.y + 0.5), height, fur.hairs, thickness, fur.seed
    );
    let alpha = vair_fin_alpha(point.opacity, height, mask);
    if (alpha <= 0.0) {
        discard;
    }
    let n = vair_safe_normalize_dot(point.normal, vec3<f32>(0.0, 0.0, 1.0));
    let t = vair_safe_normalize_dot(point.tangent, n);
    let radiance = fur_radiance(point.position, n, t, height, point.share.x, point.share.y);   //? open
    let radiance = fur_radiance(point.position, n, t, height, point.share.x, point.share.y, point.lit);   //? shadowed
    return vec4<f32>(radiance, alpha);
}
