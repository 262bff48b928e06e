"""Families of numbers: powers, exponentials, steps, coats, lengths and words."""

from __future__ import annotations

import itertools
from collections.abc import Iterable

import numpy as np

from conformance.cases.family import EXPONENT, Family, Points, Role, direction, scalar
from conformance.cases.stream import LADDER, Stream, neighbour, single, tilted

EXPONENTS = (0.0, 1e-30, 1e-3, 0.5, 1.0, 2.0, 2.2, 5.0, 16.0, 64.0, 100.0, 1e3, 2e3, 1e4, 1e5)
ARGUMENT = r"^x$|^optical_depth$|^depth_(view|light)$"


def decades(low: int, high: int, mantissas: Iterable[str] = ("1", "2.2", "4.7")) -> list[float]:
    """m * 10^k for k in [low, high), read from decimal text."""
    return [float(f"{m}e{k}") for k in range(low, high) for m in mantissas]


def with_neighbours(values: Iterable[float], steps: Iterable[int] = (-2, -1, 0, 1, 2)) -> list[float]:
    """Each value and the float32 numbers next to it."""
    return [float(neighbour(x, k)[0]) for x in values for k in steps]


def grid(**columns: Iterable[float]) -> Points:
    """Every combination of the columns' values."""
    rows = np.array(list(itertools.product(*columns.values())))
    return {name: single(rows[:, k]) for k, name in enumerate(columns)}


def joined(*tables: Points) -> Points:
    """Tables of the same roles, one after the other."""
    return {role: np.concatenate([table[role] for table in tables]) for role in tables[0]}


def exponents(stream: Stream) -> Points:
    spread = decades(-3, 5, ("1", "1.5", "2.2", "3.3", "4.7", "6.8", "8.2", "9.99"))
    integers = [float(k) for k in range(3, 65)]
    return {"exponent": single(with_neighbours(EXPONENTS) + spread + integers)}


def powers(stream: Stream) -> Points:
    bases = [0.0, -0.0, -1e-30, -1e-7, -1.0, 1e-30, 1e-7, 1e-3, 0.25, 0.5, 0.9, 1.0]
    bases += [1.0 - k * 2.0**-24 for k in (1, 2, 3, 16, 256, 4096, 65536)]
    above = grid(x=[*with_neighbours((1.0,), (1, 2)), 1.5, 2.0, 10.0], y=[y for y in EXPONENTS if y <= 16.0])
    return joined(grid(x=bases, y=EXPONENTS), above)


def defect_powers(stream: Stream) -> Points:
    small = [0.0, 1e-30, 1e-20, 1e-12, 1e-10, 1e-8, 2.0**-24, 1e-7, 1e-6, 1e-4, 1e-3, 1e-2, 0.1, 0.5]
    ends = [*with_neighbours((0.15, 1.0), (-1, 0, 1)), 1.5, float(neighbour(2.0, -1)[0]), 2.0]
    flank = [
        (k / p, p) for p in EXPONENTS if p >= 1.0 for k in (0.01, 0.1, 0.5, 1.0, 2.0, 5.0, 20.0) if k < p
    ]
    table = np.array(flank)
    return joined(grid(q=small + ends, p=EXPONENTS), {"q": single(table[:, 0]), "p": single(table[:, 1])})


def exponential_arguments(stream: Stream) -> Points:
    switches = (
        0.1,
        0.2,
        0.25,
        0.3,
        0.5,
        0.6,
        1.0,
        2.0,
        10.0,
        15.0,
        16.0,
        17.0,
        80.0,
        87.0,
        88.0,
        88.72284,
        89.0,
    )
    beyond = (100.0, 104.0, 126.0, 150.0, 1e3, 1e4, 1e5, 1e6, 1e9, 1e18, 1e30)
    return {
        "x": single([0.0, *decades(-30, 2, ("1", "2.2", "4.7", "7.1")), *with_neighbours(switches), *beyond])
    }


def bessel_arguments(stream: Stream) -> Points:
    switches = (3.75, 7.0, 7.75, 8.0, 12.0, 15.0, 16.0, 100.0, 500.0)
    linear = [0.25 * k for k in range(65)]
    positive = [0.0, *decades(-10, 5), 1e5, *with_neighbours(switches), *linear]
    return {"x": single(positive + [-x for x in positive if x > 0.0])}


def depth_pairs(stream: Stream) -> Points:
    depths = [0.0, 1e-30, 1e-8, 1e-4, 1e-2, 0.3, 1.0, 3.0, 6.24, 20.0, 88.0, 100.0, 500.0, 1e4, 1e6, 1e9]
    return grid(depth_view=depths, depth_light=depths)


def smoothstep_edges(stream: Stream) -> Points:
    rows: list[tuple[float, float, float]] = []
    for low in (0.0, 1.0, -1.0, 0.5, 0.1, -0.3, 1e-3, 30.0):
        highs = [*with_neighbours((low,)), low + 0.5, low - 0.5, low + 1e-3, -low]
        for high in highs:
            inside = 0.5 * (low + high)
            rows += [(low, high, x) for x in (*with_neighbours((low, high), (-1, 0, 1)), inside)]
    table = np.array(rows)
    return {"edge0": single(table[:, 0]), "edge1": single(table[:, 1]), "x": single(table[:, 2])}


def reflectances(stream: Stream) -> Points:
    near_one = [1.0 - k * 2.0**-24 for k in (0, 1, 2, 3, 4, 8, 16, 256, 4096, 65536, 1 << 20, 1 << 22)]
    spread = [float(x) for x in stream.uniform(80)]
    return {
        "rho": single([0.0, *decades(-30, 0), *with_neighbours((0.02, 0.15, 0.25, 0.5)), *near_one, *spread])
    }


def coat_depths(stream: Stream) -> Points:
    """Depths against directions that are parallel, nearly so, or nearly orthogonal."""
    depths = np.array([0.0, 1e-30, 1e-8, 1e-3, 1.0, 1e3, 1e6])
    turn = np.repeat((*LADDER, 0.0), 14)
    n = len(turn)
    a = stream.anchors(n)
    u = stream.across(a)
    row = np.arange(n)
    side = np.where((row // 2) % 2 == 0, 1.0, -1.0)
    parallel = side[:, None] * tilted(a, u, turn)
    orthogonal = tilted(u, a, turn * side)
    b = np.where((row % 2 == 0)[:, None], parallel, orthogonal)
    return {"depth": single(depths[(row // 2) % len(depths)]), "a": single(a), "b": single(b)}


def transmittances(stream: Stream) -> Points:
    values = [0.0, 1e-30, 1e-18, 1e-8, 1e-3, 0.02, 0.5, 1.0, 9.0, 80.0, 81.0, 88.0, 1e3, 1e9, 1e18]
    products = with_neighbours((79.0, 80.0, 81.0, 87.0))
    return joined(grid(extinction=values, path=values), grid(extinction=[1.0], path=products))


def vector_lengths(stream: Stream) -> Points:
    """Lengths 1e-30 .. 1e30 along an axis, in any direction, with components of unequal size; zeros."""
    rows = []
    for k in range(-30, 31):
        size = float(f"1e{k}")
        axis = np.zeros(3)
        axis[k % 3] = size * (1.0 if k % 2 else -1.0)
        rows += [axis, *(stream.directions(2) * size * 0.999999), np.array([0.6e-4, -0.8, 0.6]) * size]
    zeros = [np.array(signs) for signs in itertools.product((0.0, -0.0), repeat=3)]
    return {"x": single(np.array(rows + zeros))}


def map_tangents(stream: Stream) -> Points:
    """Decoded samples of a tangent map: along n, zero, with tiny tangential part, and any."""
    small = (0.0, -0.0, 1e-30, 1e-12, -1e-7, 1e-4, 0.1)
    rows = [list(xyz) for xyz in itertools.product(small, small[2:], (1.0, -1.0, 0.0, 0.5))]
    rows += [[0.0, 0.0, z] for z in (0.0, 1.0, -1.0, 0.5, 1e-30)]
    rows += [[x, y, z] for x, y, z in itertools.product((-1.0, 0.0, 1.0), repeat=3)]
    rows += stream.uniform(150, -1.0, 1.0).reshape(-1, 3).tolist()
    return {"map_tangent": single(np.array(rows))}


def unit_squares(stream: Stream) -> Points:
    """Corners, edges, centre lines of [0, 1)^2 and the numbers next to them on the 2^-24 grid."""
    step = 2.0**-24
    lines = [x + k * step for x in (0.25, 0.5, 0.75) for k in (-1, 0, 1)]
    values = [0.0, step, *lines, 1.0 - 2.0 * step, 1.0 - step, 0.125, 0.9]
    rows = np.array(list(itertools.product(values, repeat=2)))
    return {"u": single(rows)}


def words(stream: Stream) -> Points:
    """Powers of two and their neighbours, the largest words, and random ones."""
    powers_of_two = [1 << k for k in range(32)]
    near = {(p + d) % (1 << 32) for p in powers_of_two for d in (-1, 0, 1)} | {
        0,
        0xFFFFFF00,
        0xFFFFFF7F,
        0xFFFFFF80,
    }
    listed = np.array(sorted(near), dtype=np.uint32)
    return {"word": np.concatenate([listed, stream.words(130)])}


def sequence_indices(stream: Stream) -> Points:
    """i < n with n from 1 to 2^20: first, last and middle index."""
    rows: list[tuple[int, int]] = []
    small = (1, 2, 3, 5, 7, 16, 40, 41, 47, 55, 64, 100, 1000, 1023, 1025, 4096)
    for n in (*small, 65535, 65537, 10**6, (1 << 20) - 1):
        rows += [(i % n, n) for i in (0, 1, n // 3, n // 2, n - 2, n - 1)]
    rows += [(i, 1 << 20) for i in (0, 1, 4095, 4096, (1 << 20) - 1)]
    many = np.asarray(stream.uniform(100) * 2.0**20, dtype=np.uint32) + np.uint32(1)
    chosen = np.asarray(stream.uniform(100) * many, dtype=np.uint32)
    table = np.concatenate([np.array(rows, dtype=np.uint32), np.stack([chosen, many], axis=-1)])
    return {"i": table[:, 0].copy(), "n": table[:, 1].copy()}


COAT = (scalar("depth"), direction("a", "^[tn]$"), direction("b", "^[lvw]$"))

FAMILIES: tuple[Family, ...] = (
    Family(
        "exponents",
        (scalar("exponent", EXPONENT),),
        "0 to 1e5: usual values, powers of ten, integers, ULPs",
        "exponent 0 is 1 everywhere; a large one multiplies the error of the logarithm",
        exponents,
    ),
    Family(
        "powers",
        (scalar("x"), scalar("y")),
        "bases 0, -0, negative, tiny, about 1; exponents 0 to 1e5",
        "0^0 and powers of negative numbers are undefined in every target",
        powers,
    ),
    Family(
        "defect_powers",
        (scalar("q"), scalar("p", optional=True)),
        "q from 0 over 1e-30 to 2, and about k / p",
        "1 - q rounds q away; the step at q = 1",
        defect_powers,
    ),
    Family(
        "exponential_arguments",
        (scalar("x", ARGUMENT),),
        "0, 1e-30 to 1e30, ULPs about usual switches",
        "1 - e^-x cancels; e^-88 is a denormal",
        exponential_arguments,
    ),
    Family(
        "bessel_arguments",
        (scalar("x"),),
        "-1e5 to 1e5, ULPs about the usual switches of series",
        "published approximations jump where they change form",
        bessel_arguments,
    ),
    Family(
        "depth_pairs",
        (scalar("depth_view"), scalar("depth_light")),
        "optical depths 0 to 1e9, all combinations",
        "the slab's weight depends on the ratio of depths long after both exponentials have died",
        depth_pairs,
    ),
    Family(
        "smoothstep_edges",
        (
            scalar("edge0", "^(edge0|cos_dark)$"),
            scalar("edge1", "^(edge1|cos_lit)$"),
            scalar("x", "^(x|n_dot_l)$"),
        ),
        "edges equal, 1 or 2 ULPs apart, reversed; x on them and next to them",
        "undefined in GLSL and OpenCL for edge0 >= edge1",
        smoothstep_edges,
    ),
    Family(
        "reflectances",
        (scalar("rho", r"^rho(_|$)"),),
        "0, 1e-30 to 1, k 2^-24 short of 1",
        "log(1 - rho) rounds small rho away and diverges at 1",
        reflectances,
    ),
    Family(
        "coat_depths",
        COAT,
        "depths 0 to 1e6 against sines and cosines from 1e-7, 0 included",
        "0/0 and quotients that overflow",
        coat_depths,
    ),
    Family(
        "transmittances",
        (scalar("extinction"), scalar("path")),
        "0 to 1e18 each, products about 80",
        "0 * infinity; the clamp before the exponential",
        transmittances,
    ),
    Family(
        "vector_lengths",
        (Role("x", "vec3", False, "^(x|edge|tangent_mean|comb|force|position)$"),),
        "lengths 1e-30 to 1e30, zeros of both signs",
        "squares of components overflow above 1.8e19 and vanish below 1e-19",
        vector_lengths,
    ),
    Family(
        "map_tangents",
        (Role("map_tangent", "vec3", False, "^map_tangent$"),),
        "samples along the normal, zero, with a tiny tangential part, and any",
        "nothing is left after flattening",
        map_tangents,
    ),
    Family(
        "unit_squares",
        (Role("u", "vec2", False, "^uv?$"),),
        "corners and centre lines of [0, 1)^2 and next to them",
        "u = (0, 0) is the first Hammersley point; folds of maps lie on centre lines",
        unit_squares,
    ),
    Family(
        "words",
        (scalar("word", "^(i|x|bits|seed)$", type_="u32"),),
        "powers of two +-1, the largest words, random",
        "carries, and conversions to float that round up to 1",
        words,
    ),
    Family(
        "sequence_indices",
        (scalar("i", type_="u32"), scalar("n", type_="u32")),
        "first, middle and last of n points",
        "i / n in fixed point",
        sequence_indices,
    ),
)
