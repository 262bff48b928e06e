#version 330
// A fragment as a square of one pixel: all its corners have the same values.
layout(location = 0) in vec2 place;
layout(location = 1) in vec3 position;
layout(location = 2) in vec3 normal;
layout(location = 3) in vec3 tangent;
layout(location = 4) in vec2 share;
layout(location = 5) in vec2 uv;
layout(location = 6) in vec2 layer;

out vec3 at_position;
out vec3 at_normal;
out vec3 at_tangent;
out vec2 at_share;
out vec2 at_uv;
flat out vec2 at_layer;

void main()
{
    at_position = position;
    at_normal = normal;
    at_tangent = tangent;
    at_share = share;
    at_uv = uv;
    at_layer = layer;
    gl_Position = vec4(place, 0.0, 1.0);
}
