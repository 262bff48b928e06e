"""Families for lobes: grazing and opposite directions, flanks, vanishing densities, extreme parameters."""

from __future__ import annotations

import itertools

import mpmath
import numpy as np

from conformance.cases.family import EXPONENT, Family, Points, Role, direction, scalar
from conformance.cases.scalars import grid, with_neighbours
from conformance.cases.stream import F64, LADDER, Stream, normalised, single, tilted
from conformance.cases.triples import signs

STEPS = (*LADDER, 0.0)
UP = np.array([0.0, 0.0, 1.0])
FIBRE = np.array([1.0, 0.0, 0.0])
ROUGHNESS = (1e-4, 1e-3, 3e-3, 0.01, 0.05, 0.1, 0.3, 0.7, 1.0)
POWERS = (0.0, 0.01, 1.0, 10.0, 1e3, 1e5)


def upper(stream: Stream, n: int) -> F64:
    """n directions above the horizon; some along the normal or in a coordinate plane."""
    w = stream.directions(n)
    w[:, 2] = np.abs(w[:, 2])
    rows = np.arange(n)
    w[rows % 7 == 0] = UP
    w[rows % 7 == 1, 1] = 0.0
    w[rows % 7 == 2, 0] = 0.0
    return normalised(w + 1e-3 * UP)


def low(stream: Stream, turn: F64, sign: F64) -> F64:
    """Directions `turn` radians above (sign 1) or below the horizon."""
    flat = stream.directions(len(turn))
    flat[:, 2] = 0.0
    flat = normalised(flat)
    return tilted(flat, np.broadcast_to(UP, flat.shape), turn * sign)


def mirrored(v: F64, h: F64) -> F64:
    """v reflected about h."""
    return np.asarray(2.0 * np.sum(v * h, axis=1, keepdims=True) * h - v)


def grazing_lobes(stream: Stream) -> Points:
    """l, v or both 4.7e-1 to 1e-7 rad above the horizon, on it, and l below it."""
    turn = np.repeat(STEPS, 14)
    n, kind = len(turn), (np.arange(len(turn)) % 4)[:, None]
    other = np.array(LADDER)[stream.below(n, len(LADDER))]
    plus = np.ones(n)
    v_low, v_same = low(stream, other, plus), low(stream, np.where(turn > 0.0, turn, 1e-7), plus)
    l = np.where(kind == 0, low(stream, turn, plus), low(stream, turn, signs(n, 2)))
    v = np.where(kind == 1, upper(stream, n), np.where(kind == 2, v_low, v_same))
    # one in four: l is v carried over to the other side, the direction of the mirror at grazing
    l = np.where(kind == 3, v * np.array([-1.0, -1.0, 1.0]), l)
    return {"l": single(l), "v": single(v)}


def opposite_lobes(stream: Stream) -> Points:
    """l from 4.7e-1 to 1e-7 rad off -v, and -v itself: no half vector."""
    turn = np.repeat(STEPS, 12)
    v = upper(stream, len(turn))
    return {"l": single(-tilted(v, stream.across(v), turn)), "v": single(v)}


def level_half_vectors(stream: Stream) -> Points:
    """l.z about -v.z: the half vector lies in the surface or just above or below it."""
    turn = np.repeat(STEPS, 12)
    n = len(turn)
    v = upper(stream, n)
    flipped = v * np.array([1.0, 1.0, -1.0])
    around = np.where((np.arange(n) % 3 == 0)[:, None], flipped, v * np.array([-1.0, 1.0, -1.0]))
    return {"l": single(tilted(around, stream.across(around), turn * signs(n, 1))), "v": single(v)}


def phong_flanks(stream: Stream) -> Points:
    """l off the mirror direction of v by k / sqrt(exponent), k from 0 to 4, and at a right angle to it."""
    steps = (0.0, 0.01, 0.1, 0.5, 1.0, 2.0, 4.0)
    power = np.repeat((0.0, 0.5, 1.0, 10.0, 100.0, 1e4, 1e5), 6 * len(steps))
    off = np.tile(np.repeat(steps, 6), 7) / np.sqrt(np.maximum(power, 1.0))
    v = upper(stream, len(power))
    r = v * np.array([-1.0, -1.0, 1.0])
    side = stream.across(r)
    l = np.where((np.arange(len(power)) % 6 == 5)[:, None], tilted(side, r, off), tilted(r, side, off))
    return {"l": single(l), "v": single(v), "exponent": single(power)}


def sloped_pairs(stream: Stream, steps: tuple[float, ...], widths: F64) -> Points:
    """l mirrored about half vectors whose slopes are k times the widths (N, 2)."""
    n = len(widths)
    k = np.array(steps)[np.arange(n) % len(steps)]
    turn = stream.directions(n)
    turn[:, 2] = 0.0
    slope = normalised(turn)[:, :2] * widths * k[:, None]
    h = normalised(np.concatenate([slope, np.ones((n, 1))], axis=1))
    v = upper(stream, n)
    return {"l": single(normalised(mirrored(v, h))), "v": single(v)}


def roughness_pairs(stream: Stream, repeats: int) -> F64:
    """All pairs of roughness, ratios up to 1 : 10000."""
    return np.tile(np.array(list(itertools.product(ROUGHNESS, repeat=2))), (repeats, 1))


def roughness_flanks(stream: Stream) -> Points:
    alpha = roughness_pairs(stream, 5)
    points = sloped_pairs(stream, (0.0, 0.1, 0.5, 1.0, 2.0, 4.0), alpha)
    return points | {"alpha_x": single(alpha[:, 0]), "alpha_y": single(alpha[:, 1])}


def exponent_flanks(stream: Stream) -> Points:
    power = np.tile(np.array(list(itertools.product(POWERS, repeat=2))), (10, 1))
    widths = np.sqrt(2.0 / (power + 2.0))
    points = sloped_pairs(stream, (0.0, 0.1, 0.5, 1.0, 2.0, 4.0, 7.0), widths)
    return points | {"exponent_x": single(power[:, 0]), "exponent_y": single(power[:, 1])}


def vanishing_roughness(stream: Stream) -> Points:
    """Gaussian slopes of 7 to 14 widths: densities from 1e-18 over 1e-30 and 1e-38 to 0."""
    alpha = roughness_pairs(stream, 5)
    points = sloped_pairs(stream, (7.0, 8.0, 8.3, 8.94427, 9.2, 9.4, 10.0, 14.0), alpha)
    return points | {"alpha_x": single(alpha[:, 0]), "alpha_y": single(alpha[:, 1])}


def vanishing_powers(stream: Stream) -> Points:
    """Cosines 2^-k about the mirror direction raised to about 100 / k: densities about 2^-100."""
    k = np.array([1.0, 2.0, 4.0, 0.5, 0.25, 0.0625, 2.0**-8])[np.arange(252) % 7]
    times = np.array([0.9, 0.99, 1.0, 1.01, 1.2, 1.26, 1.3, 1.5, 2.0])[np.arange(252) % 9]
    cosine = {x: float(mpmath.mpf(2) ** -x) for x in sorted(set(k.tolist()))}
    c = np.array([cosine[x] for x in k.tolist()])
    half = np.sqrt((1.0 - c) / (1.0 + c))
    v = upper(stream, len(k))
    r = v * np.array([-1.0, -1.0, 1.0])
    return {
        "l": single(tilted(r, stream.across(r), 2.0 * half)),
        "v": single(v),
        "exponent": single(np.minimum(100.0 * times / k, 1e5)),
    }


def lobe_corners(stream: Stream) -> Points:
    """Corners and edges of the square against grazing and upright views."""
    ends = (0.0, 2.0**-24, 0.25, 0.5, 1.0 - 1e-6, 1.0 - 2.0**-24)
    pairs = np.array(list(itertools.product(ends, repeat=2)))
    u = np.tile(pairs, (9, 1))
    n = len(u)
    turn = np.array(LADDER)[np.arange(n) % len(LADDER)]
    v = np.where((np.arange(n) % 2 == 0)[:, None], upper(stream, n), low(stream, turn, np.ones(n)))
    return {"u": single(u), "v": single(v)}


def fibre_lobes(stream: Stream) -> Points:
    """l and v 4.7e-1 to 1e-7 rad from +-x or along it, on the same and on the opposite side."""
    turn = np.repeat(STEPS, 12)
    n = len(turn)
    x = np.broadcast_to(FIBRE, (n, 3)) * signs(n, 2)[:, None]
    ratio = np.array([1.0, 1.0 + 1e-4, 0.7, 1.5])[np.arange(n) % 4]
    v = tilted(x, stream.across(x), turn)
    l = -tilted(x, stream.across(x), turn * ratio) * signs(n, 4)[:, None]
    free = (np.arange(n) % 5 == 4)[:, None]
    return {"l": single(np.where(free, stream.directions(n), l)), "v": single(v)}


def satin_arcs(stream: Stream) -> Points:
    """Profile angles on and beside the blocking threshold pi/2 - spread; leaning along and across."""
    rows: list[tuple[F64, F64, float, float]] = []
    for text, specular, (sl, sv) in itertools.product(
        ("0.001", "0.1", "0.6", "1.2", "1.5", "1.57"), (0.0, 0.5, 1.0), ((1, 1), (1, -1))
    ):
        spread = mpmath.mpf(text)
        for off in ("0", "1e-6", "-1e-6", "0.1", "-0.1", "0.3"):
            phi = min(max(mpmath.pi / 2 - spread + mpmath.mpf(off), mpmath.mpf(0)), mpmath.mpf("1.5707"))
            other = phi * mpmath.mpf("0.9")
            l, v = (np.array([0.0, float(mpmath.sin(a)), float(mpmath.cos(a))]) for a in (phi, other))
            rows.append((l * np.array([1, sl, 1]), v * np.array([1, sv, 1]), float(spread), specular))
    lean = np.array([0.0, 0.5, -0.9])[np.arange(len(rows)) % 3][:, None] * FIBRE
    l = normalised(np.array([row[0] for row in rows]) + lean)
    v = normalised(np.array([row[1] for row in rows]) - 0.3 * lean)
    spread_column, specular_column = (np.array([row[k] for row in rows]) for k in (2, 3))
    return {
        "l": single(l),
        "v": single(v),
        "spread": single(spread_column),
        "specular": single(specular_column),
    }


def satin_strategies(stream: Stream) -> Points:
    """u.x about 1 - specular, specular 0 and 1."""
    shares = [0.0, 1e-7, 0.25, 0.5, 0.75, 1.0 - 2.0**-24, 1.0]
    rows = [
        (x, y, s)
        for s in shares
        for x in (0.0, *with_neighbours((1.0 - s,), (-2, -1, 0, 1, 2)), 0.5, 1.0 - 2.0**-24)
        for y in (0.0, 0.3, 0.5, 1.0 - 2.0**-24)
    ]
    table = np.array(rows)
    return {"u": single(np.clip(table[:, :2], 0.0, 1.0 - 2.0**-24)), "specular": single(table[:, 2])}


def lobe_exponents(stream: Stream) -> Points:
    table = grid(exponent_x=[*POWERS, 2.2, 64.0, 1e4], exponent_y=[*POWERS, 2.2, 64.0, 1e4])
    return {name: np.tile(values, 3) for name, values in table.items()}


LV = (direction("l"), direction("v"))
ALPHA = (scalar("alpha_x"), scalar("alpha_y"))
SQUARE = Role("u", "vec2", False, "^u$")
LOBE_EXPONENT = scalar("exponent", EXPONENT)

FAMILIES: tuple[Family, ...] = (
    Family(
        "grazing_lobes",
        LV,
        "l and v 4.7e-1 to 1e-7 rad from the horizon, on it, l below",
        "quotients by n.l and n.v; the value ends at the horizon",
        grazing_lobes,
    ),
    Family(
        "opposite_lobes",
        LV,
        "l within 4.7e-1 to 1e-7 rad of -v, or -v",
        "no half vector; 1 / |v.h|",
        opposite_lobes,
    ),
    Family(
        "level_half_vectors",
        LV,
        "l.z about -v.z",
        "whether the half vector points up",
        level_half_vectors,
    ),
    Family(
        "phong_flanks",
        (*LV, LOBE_EXPONENT),
        "off the mirror direction by k / sqrt(exponent), k 0 to 4; at a right angle to it",
        "the flank of the lobe and the place where it ends",
        phong_flanks,
    ),
    Family(
        "roughness_flanks",
        (*LV, *ALPHA),
        "slopes of k alpha, k 0 to 4, alpha 1e-4 to 1, every ratio",
        "1 - (h.z)^2 cancels for small alpha",
        roughness_flanks,
    ),
    Family(
        "exponent_flanks",
        (*LV, scalar("exponent_x"), scalar("exponent_y")),
        "slopes of k widths, exponents 0 to 1e5, every ratio",
        "the exponent is a quotient that is 0/0 at the peak",
        exponent_flanks,
    ),
    Family(
        "vanishing_roughness",
        (*LV, *ALPHA),
        "slopes of 7 to 14 alpha: densities about and below 1e-30",
        "0 * infinity, denormals, quotients by a density",
        vanishing_roughness,
    ),
    Family(
        "vanishing_powers",
        (*LV, LOBE_EXPONENT),
        "powers of a cosine about 2^-100",
        "densities at and below 1e-30",
        vanishing_powers,
    ),
    Family(
        "lobe_corners",
        (SQUARE, direction("v")),
        "corners of the square, u.x = 1 - 2^-24; upright and grazing views",
        "(0, 0) is the peak; log(1 - u) at the other end",
        lobe_corners,
    ),
    Family(
        "fibre_lobes",
        LV,
        "l and v 4.7e-1 to 1e-7 rad from +-x, or along it",
        "no azimuth; the width of the lobe vanishes",
        fibre_lobes,
    ),
    Family(
        "satin_arcs",
        (*LV, scalar("spread"), scalar("specular")),
        "profile angles about pi/2 - spread, spread 0.001 to 1.57, specular 0 to 1",
        "where the neighbour begins to block, with a root of zero",
        satin_arcs,
    ),
    Family(
        "satin_strategies",
        (SQUARE, scalar("specular")),
        "u.x within 2 ULPs of 1 - specular, specular 0 and 1",
        "division by the share of a strategy that is never chosen",
        satin_strategies,
    ),
    Family(
        "lobe_exponents",
        (scalar("exponent_x"), scalar("exponent_y")),
        "exponents 0 to 1e5, every pair",
        "ratios of 1 : 1e7 between the axes",
        lobe_exponents,
    ),
)
