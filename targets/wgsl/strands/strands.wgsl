$library

// What both stages share.
struct StrandFrame {
    view_projection: mat4x4<f32>,
    eye: vec3<f32>,
    width: f32,
    tip_share: f32,
    s_min: f32,
    light_count: u32,
    light_direction: array<vec4<f32>, $lights>,
    light_colour: array<vec4<f32>, $lights>,
$material
}

@group(0) @binding(0) var<uniform> hair: StrandFrame;

struct StrandVertex {
    @location(0) position: vec3<f32>,
    @location(1) along: vec3<f32>,   // between the neighbours on the strand, of any length
    @location(2) chord: vec3<f32>,   // the tangent where they coincide
    @location(3) root: vec3<f32>,   // normal of the skin
    @location(4) side: f32,   // -1 or 1
    @location(5) share: f32,   // 0 at the root, 1 at the tip
}

struct StrandPoint {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec3<f32>,
    @location(3) share: f32,
}

// Light that a point of a strand sends to the eye, all lights together.
fn strand_radiance(position: vec3<f32>, n: vec3<f32>, t: vec3<f32>, share: f32) -> vec3<f32> {
    let v = vair_safe_normalize(hair.eye - position, n);
    var radiance = vec3<f32>(0.0);
    for (var k = 0u; k < hair.light_count; k++) {
        let l = hair.light_direction[k].xyz;
        let light = hair.light_colour[k].xyz;
$shading
        radiance += reflected;
    }
    return vair_shell_shadow(clamp(share, 0.0, 1.0), hair.s_min) * radiance;
}

@vertex
fn strand_vertex(vertex: StrandVertex) -> StrandPoint {
    let t = vair_safe_normalize(vertex.along, vertex.chord);
    let v = vair_safe_normalize(hair.eye - vertex.position, vertex.chord);
    let across = vair_safe_normalize(cross(t, v), vertex.root);
    let half_width = 0.5 * hair.width * vair_shell_shadow(1.0 - vertex.share, hair.tip_share);
    var point: StrandPoint;
    point.position = vertex.position + vertex.side * half_width * across;
    point.normal = vertex.root;
    point.tangent = t;
    point.share = vertex.share;
    point.clip = hair.view_projection * vec4<f32>(point.position, 1.0);
    return point;
}

@fragment
fn strand_fragment(point: StrandPoint) -> @location(0) vec4<f32> {
    let n = vair_safe_normalize(point.normal, vec3<f32>(0.0, 0.0, 1.0));
    let t = vair_safe_normalize(point.tangent, n);
    return vec4<f32>(strand_radiance(point.position, n, t, point.share), 1.0);
}
