#version $version
$library

// One fragment is one lane, 1024 to a row. Word k of lane i is a texel of the input, k * rows below its own
// row; the output is four words to a colour attachment. All are unsigned integers, so that every bit pattern
// survives the transfer.
uniform usampler2D harness_words_in;
uniform int harness_rows;
layout(location = 0) out uvec4 harness_words_out[8];

uint load_u32(int k)
{
    ivec2 place = ivec2(gl_FragCoord.xy);
    return texelFetch(harness_words_in, ivec2(place.x, k * harness_rows + place.y), 0).x;
}
int load_i32(int k) { return int(load_u32(k)); }
float load_f32(int k) { return uintBitsToFloat(load_u32(k)); }
bool load_bool(int k) { return load_u32(k) != 0u; }

// Macros, because an output is indexed by constants only.
#define store_u32(k, value) (harness_words_out[(k) / 4][(k) % 4] = (value))
#define store_i32(k, value) store_u32(k, uint(value))
#define store_f32(k, value) store_u32(k, floatBitsToUint(value))
#define store_bool(k, value) store_u32(k, (value) ? 1u : 0u)

void main()
{
    for (int k = 0; k < 8; ++k) {
        harness_words_out[k] = uvec4(0xdeaddeadu);
    }
$body
}
