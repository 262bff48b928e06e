// A sphere that is brushed along its circles of latitude, under one light. The library stands before this text.
struct Sample {
    @builtin(position) position: vec4<f32>,
    @location(0) place: vec2<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Sample {
    let place = vec2<f32>(f32((index << 1u) & 2u), f32(index & 2u)) * 2.0 - 1.0;
    return Sample(vec4<f32>(place, 0.0, 1.0), place);
}

@fragment
fn fragment(seen: Sample) -> @location(0) vec4<f32> {
    let inside = 1.0 - dot(seen.place, seen.place);
    let n = vec3<f32>(seen.place, sqrt(max(inside, 0.0)));
    let t = vec3<f32>(n.z, 0.0, -n.x) / max(length(n.xz), 1e-6);
    let l = normalize(vec3<f32>(0.5, 0.6, 0.8));
    let v = vec3<f32>(0.0, 0.0, 1.0);
    let shade = vair_banks_shade(t, n, l, v, vec3<f32>(0.5, 0.3, 0.2), vec3<f32>(0.5), 24.0);
    return vec4<f32>(select(vec3<f32>(0.0), sqrt(shade), inside > 0.0), 1.0);
}
