#version $version
$library

// One invocation computes two lanes side by side, as the lanes of a packed vector would be computed.
// harness_take(j) turns to its lane j; in an odd number of lanes the last one is computed twice.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer HarnessWordsIn { uint harness_words_in[]; };
layout(std430, binding = 1) writeonly buffer HarnessWordsOut { uint harness_words_out[]; };
uniform uint harness_count;
uint harness_lane;

void harness_take(uint j) { harness_lane = min(2u * gl_GlobalInvocationID.x + j, harness_count - 1u); }
uint harness_index(int k) { return uint(k) * harness_count + harness_lane; }

uint load_u32(int k) { return harness_words_in[harness_index(k)]; }
int load_i32(int k) { return int(load_u32(k)); }
float load_f32(int k) { return uintBitsToFloat(load_u32(k)); }
bool load_bool(int k) { return load_u32(k) != 0u; }

void store_u32(int k, uint value) { harness_words_out[harness_index(k)] = value; }
void store_i32(int k, int value) { store_u32(k, uint(value)); }
void store_f32(int k, float value) { store_u32(k, floatBitsToUint(value)); }
void store_bool(int k, bool value) { store_u32(k, value ? 1u : 0u); }

void main()
{
    if (2u * gl_GlobalInvocationID.x >= harness_count) {
        return;
    }
$body
}
