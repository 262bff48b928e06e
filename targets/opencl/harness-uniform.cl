$library

/* The input is in constant memory, read at an index that is the same for every work item: one work item
   walks over all lanes. Word k of lane i lies at k * harness_count + i. */
#define harness_index(k) ((uint)(k) * harness_count + harness_lane)

#define load_u32(k) (harness_words_in[harness_index(k)])
#define load_i32(k) as_int(load_u32(k))
#define load_f32(k) as_float(load_u32(k))
#define load_bool(k) (load_u32(k) != 0u)

#define store_u32(k, value) (harness_words_out[harness_index(k)] = (uint)(value))
#define store_i32(k, value) store_u32(k, as_uint((int)(value)))
#define store_f32(k, value) store_u32(k, as_uint((float)(value)))
#define store_bool(k, value) store_u32(k, (value) ? 1u : 0u)

__kernel void harness_main(__constant uint *harness_words_in,
                           __global uint *harness_words_out,
                           const uint harness_count)
{
    if (get_global_id(0) > 0) {
        return;
    }
    for (uint harness_lane = 0u; harness_lane < harness_count; ++harness_lane) {
$body
    }
}
