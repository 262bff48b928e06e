$library

// One invocation is one lane. Word k of lane i lies at k * harness_count + i.
// Both buffers hold unsigned integers, so that every bit pattern survives the transfer.
@group(0) @binding(0) var<storage, read> harness_words_in: array<u32>;
@group(0) @binding(1) var<storage, read_write> harness_words_out: array<u32>;
@group(0) @binding(2) var<uniform> harness_count: u32;
var<private> harness_lane: u32;
$textures

fn harness_index(k: u32) -> u32 { return k * harness_count + harness_lane; }

fn load_u32(k: u32) -> u32 { return harness_words_in[harness_index(k)]; }
fn load_i32(k: u32) -> i32 { return bitcast<i32>(load_u32(k)); }
fn load_f32(k: u32) -> f32 { return bitcast<f32>(load_u32(k)); }
fn load_bool(k: u32) -> bool { return load_u32(k) != 0u; }

fn store_u32(k: u32, value: u32) { harness_words_out[harness_index(k)] = value; }
fn store_i32(k: u32, value: i32) { store_u32(k, bitcast<u32>(value)); }
fn store_f32(k: u32, value: f32) { store_u32(k, bitcast<u32>(value)); }
fn store_bool(k: u32, value: bool) { store_u32(k, select(0u, 1u, value)); }

@compute @workgroup_size(64)
fn harness_main(@builtin(global_invocation_id) harness_id: vec3<u32>) {
    harness_lane = harness_id.x;
    if (harness_lane >= harness_count) {
        return;
    }
$body
}
