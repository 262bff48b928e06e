// A sphere that is brushed along its circles of latitude, under one light. The library stands before this text.
uniform float exponent;
in vec3 at;
out vec4 pixel;

void main() {
    vec3 n = normalize(at);
    vec3 t = vec3(n.z, 0.0, -n.x) / max(length(n.xz), 1e-6);
    vec3 l = normalize(vec3(0.5, 0.6, 0.8));
    vec3 v = vec3(0.0, 0.0, 1.0);
    vec3 shade = vair_banks_shade(t, n, l, v, vec3(0.5, 0.3, 0.2), vec3(0.5), exponent);
    pixel = vec4(sqrt(shade), 1.0);
}
