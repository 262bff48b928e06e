"""Families of one direction and of two directions."""

from __future__ import annotations

import itertools

import numpy as np

from conformance.cases.family import PAIR, Family, Points, direction
from conformance.cases.stream import (
    AXES,
    F64,
    LADDER,
    Stream,
    neighbour,
    norm,
    normalised_single,
    single,
    tilted,
)

PER_ANGLE = 12


def turned_pair(stream: Stream, sign: float, angles: tuple[float, ...] = LADDER) -> Points:
    """Directions a and, at every angle of the ladder from sign * a, directions b; turned either way."""
    turn = np.repeat(angles, PER_ANGLE)
    a = stream.anchors(len(turn))
    way = np.where(np.arange(len(turn)) % 2 == 0, 1.0, -1.0)
    return {"a": single(a), "b": single(sign * tilted(a, stream.across(a), turn * way))}


def near_parallel(stream: Stream) -> Points:
    return turned_pair(stream, 1.0)


def near_antiparallel(stream: Stream) -> Points:
    return turned_pair(stream, -1.0)


def half_vector_threshold(stream: Stream) -> Points:
    sums = (3, 5, 7, 8, 9, 9.5, 9.8, 9.9, 10, 10.1, 10.2, 10.5, 11, 12, 14, 17, 20, 30)
    angles = tuple(k * 1e-7 for k in sums)
    return turned_pair(stream, -1.0, angles)


def near_orthogonal(stream: Stream) -> Points:
    turn = np.concatenate([np.repeat(LADDER, 5), np.repeat([-x for x in LADDER], 5), np.zeros(30)])
    a = stream.anchors(len(turn))
    return {"a": single(a), "b": single(tilted(stream.across(a), a, turn))}


def same_and_unit(stream: Stream) -> Points:
    """Directions rounded from float64, axes among them, and directions normalised in float32."""
    rounded = single(stream.anchors(150))
    raw = stream.directions(100) * stream.uniform(100, 1e-2, 1e2)[:, None]
    return {"a": np.concatenate([rounded, normalised_single(raw)])}


def equal_directions(stream: Stream) -> Points:
    a = same_and_unit(stream)["a"]
    return {"a": a, "b": a.copy()}


def opposite_directions(stream: Stream) -> Points:
    a = same_and_unit(stream)["a"]
    return {"a": a, "b": -a}


def ulp_neighbours(stream: Stream) -> Points:
    """b is a or -a with one component moved by a few ULPs."""
    cases = list(itertools.product(range(3), (-4, -2, -1, 1, 2, 4), (1.0, -1.0)))
    repeated = cases * 7
    a = single(stream.anchors(len(repeated)))
    b = np.array(a)
    for row, (component, steps, sign) in enumerate(repeated):
        b[row, component] = neighbour(b[row, component], steps)[0]
        b[row] *= np.float32(sign)
    return {"a": a, "b": b}


def normalised_in_float32(stream: Stream) -> Points:
    """Lengths 1e-2 .. 1e2, normalised in float32 arithmetic: near parallel, near opposite, and any."""
    turn = np.repeat(LADDER, PER_ANGLE)
    n = len(turn)
    a = stream.directions(n)
    near = tilted(a, stream.across(a), turn)
    kind = np.arange(n) % 3
    b = np.where((kind == 0)[:, None], near, np.where((kind == 1)[:, None], -near, stream.directions(n)))
    lengths = np.array([1e-2, 3e-2, 0.1, 0.7, 1.0, 3.0, 10.0, 33.0, 100.0])
    size_a, size_b = lengths[stream.below(n, 9)], lengths[stream.below(n, 9)]
    return {"a": normalised_single(a * size_a[:, None]), "b": normalised_single(b * size_b[:, None])}


def parallel_of_other_length(stream: Stream) -> Points:
    """Exactly parallel or opposite vectors, unit to float32 rounding, that are not the same numbers."""
    rows: list[tuple[F64, F64]] = []
    for triple in itertools.product((-2.0, -1.0, 0.0, 1.0, 2.0), repeat=3):
        whole = np.array(triple)
        if np.count_nonzero(whole) < 2:
            continue
        # Multiples of one float32 factor by 1 and 2 are exact, so all these vectors are truly parallel.
        factors = neighbour(np.repeat(single(1.0 / norm(whole)), 7), np.arange(-3, 4))
        vectors = [np.float64(f) * whole for f in factors]
        good = [x for x in vectors if abs(float(norm(x)) - 1.0) < 2.0e-7]
        rows += [(x, sign * y) for x, y in itertools.pairwise(good) for sign in (1.0, -1.0)]
    rows = rows[::3]
    return {"a": single(np.array([x for x, _ in rows])), "b": single(np.array([y for _, y in rows]))}


def axis_aligned(stream: Stream) -> Points:
    """Axes with +0 and -0, components 1 to 16 ULPs short of +-1, and equators with a tiny third component."""
    rows: list[list[float]] = []
    circle = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (0.6, 0.8), (-0.8, 0.6), (0.28, -0.96)]
    for axis, pole in itertools.product(range(3), (1.0, -1.0)):
        for zeros in itertools.product((0.0, -0.0), repeat=2):
            rows.append(placed(axis, pole, zeros))
        for ulps, (x, y) in itertools.product((1, 2, 4, 16), circle):
            short = float(neighbour(pole, -ulps if pole > 0 else ulps)[0])
            rest = float(np.sqrt(1.0 - short * short))
            rows.append(placed(axis, short, (x * rest, y * rest)))
    for axis, (x, y) in itertools.product(range(3), circle[3:]):
        for third in (0.0, -0.0, 1e-30, -1e-30, 1e-8, -1e-8, 6e-8, -6e-8):
            rows.append(placed(axis, third, (x, y)))
    return {"d": single(np.array(rows))}


def placed(axis: int, value: float, others: tuple[float, ...]) -> list[float]:
    """A vector with `value` on that axis and the others on the two that follow it cyclically."""
    vector = [0.0, 0.0, 0.0]
    vector[axis], vector[(axis + 1) % 3], vector[(axis + 2) % 3] = value, others[0], others[1]
    return vector


def near_axes(stream: Stream) -> Points:
    """Directions at every angle of the ladder from each coordinate axis."""
    turn = np.repeat(LADDER, 2 * len(AXES))
    axes = AXES[np.arange(len(turn)) % len(AXES)]
    return {"d": single(tilted(axes, stream.across(axes), turn))}


FAMILIES: tuple[Family, ...] = (
    Family(
        "near_parallel",
        PAIR,
        "two directions 4.7e-1 to 1e-7 rad apart, turned either way",
        "1 - dot^2 and plain cross products cancel; a dot of float32 unit vectors exceeds 1",
        near_parallel,
        True,
    ),
    Family(
        "near_antiparallel",
        PAIR,
        "two directions 4.7e-1 to 1e-7 rad from opposite",
        "as near_parallel; l + v is then small and its direction decided by few bits",
        near_antiparallel,
        True,
    ),
    Family(
        "half_vector_threshold",
        PAIR,
        "nearly opposite directions with |l + v| from 3e-7 to 3e-6",
        "half_vector takes its fixed value below |l + v| = 1e-6",
        half_vector_threshold,
        True,
    ),
    Family(
        "near_orthogonal",
        PAIR,
        "two directions 4.7e-1 to 1e-7 rad off a right angle, or on it",
        "the sign of the dot product decides; quotients by it grow without bound",
        near_orthogonal,
        True,
    ),
    Family(
        "equal_directions",
        PAIR,
        "the same three numbers twice",
        "sine 0: 0/0 in kappa, paths and frames",
        equal_directions,
        True,
    ),
    Family(
        "opposite_directions",
        PAIR,
        "a vector and its exact negative",
        "l = -v has no half vector; sine 0",
        opposite_directions,
        True,
    ),
    Family(
        "ulp_neighbours",
        PAIR,
        "b is a or -a with one component moved by 1, 2 or 4 ULPs",
        "the smallest angles that float32 vectors form",
        ulp_neighbours,
        True,
    ),
    Family(
        "normalised_in_float32",
        PAIR,
        "vectors of length 1e-2 to 1e2 normalised in float32 arithmetic",
        "their lengths are off by up to 2e-7, which is more than 1 - cos of most angles of interest",
        normalised_in_float32,
        True,
    ),
    Family(
        "parallel_of_other_length",
        PAIR,
        "exactly parallel unit vectors that differ in their last bits",
        "the sine is 0 although neither a - b nor a + b is",
        parallel_of_other_length,
        True,
    ),
    Family(
        "axis_aligned",
        (direction("d", ".*"),),
        "axes with zeros of both signs, 1 to 16 ULPs off them, equators",
        "n.z = -1 and its neighbours in frames and maps; the sign of zero must not matter",
        axis_aligned,
    ),
    Family(
        "near_axes",
        (direction("d", ".*"),),
        "directions 4.7e-1 to 1e-7 rad from each coordinate axis",
        "poles of local frames, maps and lobes",
        near_axes,
    ),
)
