$library

/* One work item computes two lanes side by side, as the lanes of a packed vector would be computed.
   harness_take(j) turns to its lane j; in an odd number of lanes the last one is computed twice. */
#define harness_take(j) (harness_lane = min(harness_first + (uint)(j), harness_count - 1u))
#define harness_index(k) ((uint)(k) * harness_count + harness_lane)

#define load_u32(k) (harness_words_in[harness_index(k)])
#define load_i32(k) as_int(load_u32(k))
#define load_f32(k) as_float(load_u32(k))
#define load_bool(k) (load_u32(k) != 0u)

#define store_u32(k, value) (harness_words_out[harness_index(k)] = (uint)(value))
#define store_i32(k, value) store_u32(k, as_uint((int)(value)))
#define store_f32(k, value) store_u32(k, as_uint((float)(value)))
#define store_bool(k, value) store_u32(k, (value) ? 1u : 0u)

__kernel void harness_main(__global const uint *restrict harness_words_in,
                           __global uint *restrict harness_words_out,
                           const uint harness_count)
{
    const uint harness_first = 2u * (uint)get_global_id(0);
    uint harness_lane = harness_first;
    if (harness_first >= harness_count) {
        return;
    }
$body
}
