#version 450
// One triangle that covers the view; place runs from -1 to 1. Clip space is WebGPU's, with y upwards: a Vulkan
// engine gets the same by a viewport of negative height.
layout(location = 0) out vec2 place;

void main() {
    place = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0;
    gl_Position = vec4(place, 0.0, 1.0);
}
