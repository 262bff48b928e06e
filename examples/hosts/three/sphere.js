// Draws a brushed sphere with three.js. The library is GLSL ES 3.00 without a #version: a ShaderMaterial with
// glslVersion GLSL3 takes it before the shader that calls it.
import * as THREE from "three";

const LIBRARY = "../../../targets/glsl/include/vair-es300.glsl";
const SIDE = 256;

async function text(address) {
    const answer = await fetch(address);
    if (!answer.ok) throw new Error(`${address}: ${answer.status}`);
    return answer.text();
}

const [library, vertex, fragment] = await Promise.all([LIBRARY, "sphere.vert", "sphere.frag"].map(text));
const material = new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: vertex,
    fragmentShader: library + fragment,
    uniforms: { exponent: { value: 24 } },
});
const scene = new THREE.Scene();
scene.add(new THREE.Mesh(new THREE.SphereGeometry(1, 192, 96), material));
const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 4);
camera.position.z = 2;

const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
renderer.setSize(SIDE, SIDE);
document.body.append(renderer.domElement);
renderer.render(scene, camera);
document.documentElement.dataset.drawn = "yes";
