#version 300 es
// From premultiplied linear samples to pixels: their mean over the background, encoded as sRGB.
precision highp float;
precision highp int;

uniform sampler2D samples;
uniform int side;   // samples along the side of a pixel
uniform vec3 top;   // sRGB colours of the background
uniform vec3 bottom;

out vec4 colour;

vec3 decoded(vec3 x)
{
    vec3 curve = pow((x + 0.055) / 1.055, vec3(2.4));
    return mix(curve, x / 12.92, lessThanEqual(x, vec3(0.04045)));
}

vec3 encoded(vec3 x)
{
    vec3 curve = 1.055 * pow(max(x, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return mix(curve, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 sum = vec4(0.0);
    for (int y = 0; y < side; y++) {
        for (int x = 0; x < side; x++) {
            sum += texelFetch(samples, side * pixel + ivec2(x, y), 0);
        }
    }
    vec4 mean = sum / float(side * side);
    float rows = float(textureSize(samples, 0).y / side);
    float share = 1.0 - (gl_FragCoord.y - 0.5) / max(rows - 1.0, 1.0);   // row 0 is the lowest
    vec3 ground = decoded(mix(top, bottom, share));
    colour = vec4(encoded(clamp(mean.rgb + (1.0 - mean.a) * ground, 0.0, 1.0)), 1.0);
}
