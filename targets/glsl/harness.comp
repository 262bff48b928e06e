#version $version
$library

// One invocation is one lane. Word k of lane i lies at k * harness_count + i.
// Both buffers hold unsigned integers, so that every bit pattern survives the transfer.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer HarnessWordsIn { uint harness_words_in[]; };
layout(std430, binding = 1) writeonly buffer HarnessWordsOut { uint harness_words_out[]; };
uniform uint harness_count;
$textures

uint harness_index(int k) { return uint(k) * harness_count + gl_GlobalInvocationID.x; }

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
    if (gl_GlobalInvocationID.x >= harness_count) {
        return;
    }
$body
}
