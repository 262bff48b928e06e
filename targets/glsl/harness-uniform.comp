#version $version
$library

// The input is a uniform block, read at an index that is the same for every invocation: one invocation
// walks over all lanes. Word k of lane i lies at k * harness_count + i, four words to an element.
layout(local_size_x = 64) in;
layout(std140, binding = 0) uniform HarnessWordsIn { uvec4 harness_words_in[1024]; };
layout(std430, binding = 1) writeonly buffer HarnessWordsOut { uint harness_words_out[]; };
uniform uint harness_count;
uint harness_lane;

uint harness_index(int k) { return uint(k) * harness_count + harness_lane; }

uint load_u32(int k)
{
    uint i = harness_index(k);
    return harness_words_in[i / 4u][i % 4u];
}
int load_i32(int k) { return int(load_u32(k)); }
float load_f32(int k) { return uintBitsToFloat(load_u32(k)); }
bool load_bool(int k) { return load_u32(k) != 0u; }

void store_u32(int k, uint value) { harness_words_out[harness_index(k)] = value; }
void store_i32(int k, int value) { store_u32(k, uint(value)); }
void store_f32(int k, float value) { store_u32(k, floatBitsToUint(value)); }
void store_bool(int k, bool value) { store_u32(k, value ? 1u : 0u); }

void main()
{
    if (gl_GlobalInvocationID.x > 0u) {
        return;
    }
    for (harness_lane = 0u; harness_lane < harness_count; ++harness_lane) {
$body
    }
}
