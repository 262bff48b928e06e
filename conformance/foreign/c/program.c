// SPDX-License-Identifier: MIT
// Runs functions of the library on the processor: NAME and LANES are arguments, words come from standard input and go
// to standard output, row after row.
#include "opencl_vectors.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "library.inc"

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

struct call {
    const char *name;
    size_t rows_in, rows_out;
    void (*run)(void);
};

#include "calls.inc"

int main(int count, char **arguments) {
    if (count != 3) return 2;
    lanes = strtoul(arguments[2], NULL, 10);
    for (size_t k = 0; k < sizeof calls / sizeof calls[0]; k++) {
        if (strcmp(calls[k].name, arguments[1]) != 0) continue;
        size_t words = calls[k].rows_in * lanes, results = calls[k].rows_out * lanes;
        uint *in = malloc(words * sizeof *in), *out = malloc(results * sizeof *out);
        if (in == NULL || out == NULL || fread(in, sizeof *in, words, stdin) != words) return 3;
        words_in = in;
        words_out = out;
        for (lane = 0; lane < lanes; lane++) calls[k].run();
        return fwrite(out, sizeof *out, results, stdout) == results ? 0 : 4;
    }
    return 5;
}
