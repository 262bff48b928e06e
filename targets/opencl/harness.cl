$library

/* One work item is one lane. Word k of lane i lies at k * harness_count + i.
   Both buffers hold unsigned integers, so that every bit pattern survives the transfer.
   OpenCL C 1.2 has no writable globals, hence macros over the kernel's arguments. */
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
                           const uint harness_count$textures)
{
    const uint harness_lane = (uint)get_global_id(0);
    if (harness_lane >= harness_count) {
        return;
    }
$body
}
