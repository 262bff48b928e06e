"""Families of three directions, and of directions with an exponent or a shift."""

from __future__ import annotations

import numpy as np

from conformance.cases.family import EXPONENT, TRIPLE, Family, Points, direction, scalar
from conformance.cases.stream import F64, LADDER, Stream, neighbour, single, tilted

EXPONENTS = (1.0, 2.2, 16.0, 100.0, 1e3, 1e4, 1e5)


def triple(t: F64, l: F64, v: F64) -> Points:
    return {"t": single(t), "l": single(l), "v": single(v)}


def signs(n: int, period: int) -> F64:
    """+1 and -1, changing every `period` rows."""
    return np.where((np.arange(n) // period) % 2 == 0, 1.0, -1.0)


def on_cone(stream: Stream, t: F64, cosine: F64, off: F64) -> tuple[F64, F64]:
    """l with t.l = cosine, and v whose elevation is off the mirrored one by the angle `off`."""
    c, s = cosine[:, None], np.sqrt(1.0 - cosine * cosine)[:, None]
    u, w = stream.across(t), stream.across(t)
    return c * t + s * u, tilted(s * w - c * t, s * t + c * w, off)


def axis_triples(stream: Stream) -> Points:
    turn = np.repeat((*LADDER, 0.0), 12)
    n, kind = len(turn), (np.arange(len(turn)) % 3)[:, None]
    t = stream.anchors(n)
    other = np.array((*LADDER, 0.0))[stream.below(n, len(LADDER) + 1)]
    near_l = signs(n, 3)[:, None] * tilted(t, stream.across(t), turn)
    near_v = signs(n, 6)[:, None] * tilted(t, stream.across(t), other)
    l = np.where(kind == 1, stream.directions(n), near_l)
    near_v = np.where(kind == 1, signs(n, 6)[:, None] * tilted(t, stream.across(t), turn), near_v)
    return triple(t, l, np.where(kind == 0, stream.directions(n), near_v))


def cone_triples(stream: Stream) -> Points:
    off = np.repeat((*LADDER, 0.0), 12)
    n = len(off)
    t = stream.anchors(n)
    return triple(t, *on_cone(stream, t, stream.uniform(n, -1.0, 1.0), off * signs(n, 1)))


def cone_axis_triples(stream: Stream) -> Points:
    """l at a small angle from +-t, v at nearly the same from -+t."""
    turn = np.repeat(LADDER, 12)
    n = len(turn)
    ratio = np.array([1.0, 1.01, 0.99, 1.5, 0.7, 1.0 + 1e-4])[np.arange(n) % 6]
    t = stream.anchors(n)
    side = signs(n, 6)[:, None]
    l = side * tilted(t, stream.across(t), turn)
    return triple(t, l, -side * tilted(t, stream.across(t), turn * ratio))


def azimuth_triples(stream: Stream) -> Points:
    """Projections of l and v on the normal plane almost equal, opposite or orthogonal; both oblique."""
    turn = np.repeat((*LADDER, 0.0), 12)
    n, kind = len(turn), (np.arange(len(turn)) % 3)[:, None]
    t = stream.anchors(n)
    u = stream.across(t)
    w = np.cross(t, u)
    start = np.where(kind == 0, u, np.where(kind == 1, -u, w))
    around = tilted(start, np.where(kind == 2, u, w), turn * signs(n, 3))
    c1, c2 = stream.uniform(n, -0.99, 0.99)[:, None], stream.uniform(n, -0.99, 0.99)[:, None]
    return triple(t, c1 * t + np.sqrt(1.0 - c1 * c1) * u, c2 * t + np.sqrt(1.0 - c2 * c2) * around)


def dark_side_triples(stream: Stream) -> Points:
    """Elevations that sum to a right angle: the strand cosine is 0 or just off it."""
    off = np.repeat((*LADDER, 0.0), 12)
    n = len(off)
    t = stream.anchors(n)
    c = stream.uniform(n, 0.0, 1.0)[:, None]
    s = np.sqrt(1.0 - c * c)
    u, w = stream.across(t), stream.across(t)
    side = signs(n, 2)[:, None]
    v = tilted(side * s * t + c * w, c * t - side * s * w, off * signs(n, 1))
    return triple(t, side * c * t + s * u, v)


def half_axis_triples(stream: Stream) -> Points:
    """l and v on either side of +-t, so that their half vector is t to within a small angle."""
    off = np.repeat((*LADDER, 0.0), 12)
    n = len(off)
    t = stream.anchors(n)
    u = stream.across(t)
    opening = stream.uniform(n, 0.05, 1.5)
    side = signs(n, 2)[:, None]
    tilt = tilted(t, u, off)
    return triple(t, side * tilted(t, u, opening), side * tilted(tilt, tilted(-u, t, off), opening))


def grazing_triples(stream: Stream) -> Points:
    """n.l and n.v of either sign down to 1e-7, or 0, or one of them well below the horizon."""
    turn = np.repeat((*LADDER, 0.0), 12)
    n, kind = len(turn), (np.arange(len(turn)) % 4)[:, None]
    normal = stream.anchors(n)
    low_l = tilted(stream.across(normal), normal, turn * signs(n, 1))
    low_v = tilted(stream.across(normal), normal, turn[stream.permutation(n)] * signs(n, 2))
    free = stream.directions(n)
    l = np.where(kind == 1, free, low_l)
    return {"n": single(normal), "l": single(l), "v": single(np.where(kind == 2, free, low_v))}


def flank_exponents() -> tuple[F64, F64]:
    """Exponents, and the angles k / sqrt(exponent) at which the highlight falls from 1 to e^-8."""
    steps = (0.0, 0.01, 0.1, 0.3, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 4.0)
    power = np.repeat(EXPONENTS, 3 * len(steps))
    return power, np.tile(np.repeat(steps, 3), len(EXPONENTS)) / np.sqrt(power)


def highlight_flanks(stream: Stream) -> Points:
    power, off = flank_exponents()
    n = len(power)
    t = stream.anchors(n)
    l, v = on_cone(stream, t, stream.uniform(n, -1.0, 1.0), off * signs(n, 1))
    return {**triple(t, l, v), "exponent": single(power)}


def axis_flanks(stream: Stream) -> Points:
    """The same with l and v near the strand's axis, where naive sines lose the highlight."""
    power, off = flank_exponents()
    n = len(power)
    t = stream.anchors(n)
    base = np.array([1e-1, 1e-2, 1e-3, 1e-4])[np.arange(n) % 4]
    side = signs(n, 4)[:, None]
    l = side * tilted(t, stream.across(t), base)
    return {**triple(t, l, -side * tilted(t, stream.across(t), base + off)), "exponent": single(power)}


def half_flanks(stream: Stream) -> Points:
    power, off = flank_exponents()
    t = stream.anchors(len(power))
    h = tilted(stream.across(t), t, off * signs(len(power), 1))
    return {"t": single(t), "h": single(h), "exponent": single(power)}


def cancelled_shift(stream: Stream) -> Points:
    """t + shift n short or zero: t nearly along -+n, shift about +-1."""
    turn = np.repeat((*LADDER, 0.0), 12)
    n = len(turn)
    normal = stream.anchors(n)
    ulps = np.array([0, 0, 0, 1, -1, 16, -16, 1 << 12, -(1 << 12), 0, 0, 0])
    shift = neighbour(np.ones(n), ulps[np.arange(n) % 12])
    side = signs(n, 1)
    t = -side[:, None] * tilted(normal, stream.across(normal), turn)
    return {"t": single(t), "n": single(normal), "shift": (shift * side).astype(np.float32)}


FLANK = (*TRIPLE, scalar("exponent", EXPONENT))

FAMILIES: tuple[Family, ...] = (
    Family(
        "axis_triples",
        TRIPLE,
        "l, v or both 4.7e-1 to 1e-7 rad from +-t, or along it",
        "sines vanish, kappa becomes 0/0",
        axis_triples,
    ),
    Family(
        "cone_triples",
        TRIPLE,
        "v 4.7e-1 to 1e-7 rad off the highlight cone t.v = -t.l, or on it",
        "the strand cosine is 1 minus a square: its distance from 1 is what a large exponent sees",
        cone_triples,
    ),
    Family(
        "cone_axis_triples",
        TRIPLE,
        "both near the cone and near the strand's axis",
        "where 1 - dot^2 inside the sines spoils the highlight",
        cone_axis_triples,
    ),
    Family(
        "azimuth_triples",
        TRIPLE,
        "azimuths of l and v almost equal, opposite or at a right angle",
        "kappa at +-1 must not leave [-1, 1]; at 0 only its absolute error counts",
        azimuth_triples,
    ),
    Family(
        "dark_side_triples",
        TRIPLE,
        "strand cosine 0, or off it by 4.7e-1 to 1e-7",
        "the base of the power changes sign",
        dark_side_triples,
    ),
    Family(
        "half_axis_triples",
        TRIPLE,
        "half vector along t, or 4.7e-1 to 1e-7 rad off it",
        "sin(t, h) vanishes; smoothstep of t.h meets its ends",
        half_axis_triples,
    ),
    Family(
        "grazing_triples",
        (direction("n"), direction("l"), direction("v")),
        "n.l and n.v down to 1e-7 on either side of 0, or 0, or negative",
        "quotients by n.l or n.v, sign decisions",
        grazing_triples,
    ),
    Family(
        "highlight_flanks",
        FLANK,
        "off the cone by k / sqrt(exponent), k from 0 to 4",
        "the flank of the highlight, where the value is most sensitive",
        highlight_flanks,
    ),
    Family(
        "axis_flanks",
        FLANK,
        "the same with l and v 1e-1 to 1e-4 rad from the axis",
        "halo at the pole of combed fur",
        axis_flanks,
    ),
    Family(
        "half_flanks",
        (direction("t"), direction("h"), scalar("exponent", EXPONENT)),
        "t.h about k / sqrt(exponent), k from 0 to 4",
        "the flank of the half-vector highlight",
        half_flanks,
    ),
    Family(
        "cancelled_shift",
        (direction("t"), direction("n"), scalar("shift", r"shift$")),
        "t + shift n short or zero",
        "normalisation of a sum that cancels",
        cancelled_shift,
    ),
)
