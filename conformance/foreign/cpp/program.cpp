// SPDX-License-Identifier: MIT
// Runs functions of the library on the processor: NAME and LANES are arguments, words come from standard input and go
// to standard output, row after row.
#include "opencl_vectors.hpp"

#include <cstdio>
#include <cstdlib>
#include <vector>

namespace library {
#include "library.inc"
}

static const uint *words_in;
static uint *words_out;
static size_t lanes, lane;

#define load_u32(k) (words_in[(size_t)(k) * lanes + lane])
#define load_i32(k) as_int(load_u32(k))
#define load_f32(k) as_float(load_u32(k))
#define load_bool(k) (load_u32(k) != 0u)
#define store_u32(k, value) (words_out[(size_t)(k) * lanes + lane] = (uint)(value))
#define store_i32(k, value) store_u32(k, as_uint((int)(value)))
#define store_f32(k, value) store_u32(k, as_uint((float)(value)))
#define store_bool(k, value) store_u32(k, (value) ? 1u : 0u)

namespace library {
#include "calls.inc"
}

int main(int count, char **arguments) {
    if (count != 3) return 2;
    lanes = strtoul(arguments[2], nullptr, 10);
    for (const library::Call &call : library::calls) {
        if (strcmp(call.name, arguments[1]) != 0) continue;
        std::vector<uint> in(call.rows_in * lanes), out(call.rows_out * lanes);
        if (fread(in.data(), sizeof(uint), in.size(), stdin) != in.size()) return 3;
        words_in = in.data();
        words_out = out.data();
        for (lane = 0; lane < lanes; lane++) call.run();
        return fwrite(out.data(), sizeof(uint), out.size(), stdout) == out.size() ? 0 : 4;
    }
    return 5;
}
