// The sphere is a mesh of three.js; its normals go along.
out vec3 at;

void main() {
    at = normalMatrix * normal;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
