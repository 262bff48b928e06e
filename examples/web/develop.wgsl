// From premultiplied linear samples to pixels: their mean over the background, encoded as sRGB.

struct Development {
    top: vec3<f32>,   // sRGB colours of the background
    side: u32,        // samples along the side of a pixel
    bottom: vec3<f32>,
}

@group(0) @binding(0) var samples: texture_2d<f32>;
@group(0) @binding(1) var<uniform> development: Development;

fn decoded(x: vec3<f32>) -> vec3<f32> {
    let curve = pow((x + 0.055) / 1.055, vec3<f32>(2.4));
    return select(curve, x / 12.92, x <= vec3<f32>(0.04045));
}

fn encoded(x: vec3<f32>) -> vec3<f32> {
    let curve = 1.055 * pow(max(x, vec3<f32>(0.0031308)), vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(curve, 12.92 * x, x <= vec3<f32>(0.0031308));
}

// One triangle that covers the picture.
@vertex
fn develop_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4<f32>(4.0 * corner - 1.0, 0.0, 1.0);
}

@fragment
fn develop_fragment(@builtin(position) place: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<u32>(place.xy);
    var sum = vec4<f32>(0.0);
    for (var y = 0u; y < development.side; y++) {
        for (var x = 0u; x < development.side; x++) {
            sum += textureLoad(samples, development.side * pixel + vec2<u32>(x, y), 0);
        }
    }
    let mean = sum / f32(development.side * development.side);
    let rows = f32(textureDimensions(samples).y / development.side);
    let share = (place.y - 0.5) / max(rows - 1.0, 1.0);
    let ground = decoded(mix(development.top, development.bottom, share));
    return vec4<f32>(encoded(clamp(mean.rgb + (1.0 - mean.a) * ground, vec3<f32>(0.0), vec3<f32>(1.0))), 1.0);
}
