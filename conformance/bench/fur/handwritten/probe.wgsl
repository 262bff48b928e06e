// A fragment as a square of one pixel: all its corners have the same values.
struct ProbeVertex {
    @location(0) place: vec2<f32>,
    @location(1) position: vec3<f32>,
    @location(2) normal: vec3<f32>,
    @location(3) tangent: vec3<f32>,
    @location(4) share: vec2<f32>,
    @location(5) uv: vec2<f32>,
    @location(6) layer: vec2<f32>,
}

@vertex
fn probe_vertex(vertex: ProbeVertex) -> ShellPoint {
    var point: ShellPoint;
    point.position = vertex.position;
    point.normal = vertex.normal;
    point.tangent = vertex.tangent;
    point.share = vertex.share;
    point.uv = vertex.uv;
    point.layer = vertex.layer;
    point.clip = vec4<f32>(vertex.place, 0.0, 1.0);
    return point;
}
