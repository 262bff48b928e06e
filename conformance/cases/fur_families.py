"""Families for fur: grazing coats, hair shapes, attenuations, lopsided depths, footprints."""

from __future__ import annotations

import itertools

import numpy as np
import numpy.typing as npt

from conformance.cases.family import Family, Points, Role, direction, scalar
from conformance.cases.scalars import decades, grid, joined, with_neighbours
from conformance.cases.stream import F64, LADDER, Stream, single, tilted
from conformance.cases.triples import signs

STEPS = (*LADDER, 0.0)
NEAR_ONE = tuple(1.0 - k * 2.0**-24 for k in (0, 1, 2, 16, 4096))


def grazing_coats(stream: Stream) -> Points:
    """w.n of either sign down to 1e-7 or 0; the hair anywhere, nearly along +-w, or exactly along it."""
    turn = np.repeat(STEPS, 12)
    n, kind = len(turn), (np.arange(len(turn)) % 3)[:, None]
    normal = stream.anchors(n)
    w = tilted(stream.across(normal), normal, turn * signs(n, 1))
    lean = np.array(STEPS)[stream.below(n, len(STEPS))]
    along = signs(n, 3)[:, None] * tilted(w, stream.across(w), lean)
    t = np.where(kind == 0, stream.directions(n), np.where(kind == 1, along, signs(n, 5)[:, None] * w))
    return {"t": single(t), "n": single(normal), "w": single(w)}


def coat_frames(stream: Stream) -> Points:
    """Both directions: along the fibre, grazing the skin, both at once, or in general position."""
    turn = np.repeat(STEPS, 12)
    n = len(turn)
    normal = stream.anchors(n)
    flat = stream.across(normal)
    t = np.where((np.arange(n) % 4 < 2)[:, None], flat, tilted(normal, flat, stream.uniform(n, 0.0, 1.4)))

    def chosen(which: npt.NDArray[np.intp]) -> F64:
        near_hair = signs(n, 2)[:, None] * tilted(t, stream.across(t), turn)
        low = tilted(stream.across(normal), normal, turn * signs(n, 3))
        free = np.where((which == 1)[:, None], low, stream.directions(n))
        return np.where((which == 0)[:, None], near_hair, free)

    which_l, which_v = np.arange(n) % 3, np.arange(n) // 3 % 3
    v = chosen(which_v)
    v = np.where((np.arange(n) % 12 == 0)[:, None], t, v)
    return {"t": single(t), "n": single(normal), "l": single(chosen(which_l)), "v": single(v)}


def coat_products(stream: Stream) -> Points:
    areas = [0.0, 1e-12, 1e-9, 1e-6, 1e-5, 2.2e-4, 1e-3, 1e-2, 0.3, 1.0, 10.0, 1e3]
    densities = [0.0, 1e-30, 1e-10, 1e-6, 1e-3, 0.5, 1.0, 20.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e9]
    ends = grid(density=with_neighbours((1.0, 1e3, 1e6)), hair_area=with_neighbours((1.0, 1e-3)))
    return joined(grid(density=densities, hair_area=areas), ends)


def hair_shapes(stream: Stream) -> Points:
    """Bald, sparse and dense coats of cones, cylinders, needles and hairs without thickness."""
    rows = list(
        itertools.product(
            (0.0, 1e-6, 1.0, 300.0, 1e5),
            (0.0, 1e-3, 0.05, 1.0, 10.0),
            (0.0, 1e-8, 1e-4, 0.01, 0.5),
            (0.0, 1e-8, 0.003, 0.01),
        )
    )
    table = np.array(rows)
    names = ("density", "hair_length", "radius_base", "radius_tip")
    return {name: single(table[:, k]) for k, name in enumerate(names)}


def directional_attenuations(stream: Stream) -> Points:
    kappas = [
        0.0,
        1e-30,
        -1e-7,
        0.5,
        -0.75,
        *with_neighbours((1.0,), (0, -1)),
        *with_neighbours((-1.0,), (0, 1)),
    ]
    rhos = [0.0, 1e-30, 1e-8, 0.3, *NEAR_ONE[:2]]
    return grid(azimuth_cosine=kappas, rho_reflect=rhos, rho_transmit=rhos)


def equal_attenuations(stream: Stream) -> Points:
    rho = single([0.0, 1e-30, 1e-8, 1e-3, 0.1, 0.7, *NEAR_ONE, *stream.uniform(289)])
    kappa = single(stream.uniform(len(rho), -1.0, 1.0))
    return {"azimuth_cosine": kappa, "rho_reflect": rho, "rho_transmit": rho.copy()}


def surface_attenuations(stream: Stream) -> Points:
    rows: list[tuple[float, float, float, float]] = []
    for dark in (-1.0, -0.5, -1e-7, 0.0, 1e-7, 0.3, 0.9999):
        for lit in (*with_neighbours((dark,), (0, 1, 2)), dark + 1e-6, dark + 1e-3, dark + 0.1, 1.0):
            for x in (*with_neighbours((dark, lit), (-1, 0, 1)), 0.5 * (dark + lit)):
                rows += [(x, rho, dark, lit) for rho in (1.0, 1e-8) if abs(x) <= 1.0 and lit <= 1.0]
    table = np.array(rows)
    names = ("n_dot_l", "rho_surface", "cos_dark", "cos_lit")
    return {name: single(table[:, k]) for k, name in enumerate(names)}


def lopsided_depths(stream: Stream) -> Points:
    """Totals 1e-10 to 1e9, shared 1 : 10^k either way, and the switches of exponentials."""
    rows: list[tuple[float, float]] = []
    for total in decades(-10, 9, ("1", "3")):
        rows += [(total, total * 10.0**-k) for k in (0, 1, 2, 4, 7, 12)]
        rows += [(total * 10.0**-k, total) for k in (1, 2, 4, 7, 12)]
    switches = with_neighbours((0.3, 0.35, 0.6, 0.7, 16.0, 80.0, 87.0, 88.0, 1e9))
    rows += [(x, y) for x in switches for y in (0.0, 1e-8) if x + y <= 1e9]
    table = np.array(rows)
    return {"depth_view": single(table[:, 0]), "depth_light": single(table[:, 1])}


def footprints(stream: Stream) -> Points:
    """Mean tangents of length 0, tiny, about the floor 1e-3, and within ULPs of 1 on either side."""
    lengths = [1e-30, 1e-20, 1e-7, 9.9e-4, 1e-3, 1.01e-3, 0.01, 0.3, 0.9, 0.99, 0.999, 1.0 - 1e-5, 1.0 - 1e-6]
    lengths += [1.0 - k * 2.0**-24 for k in (0, 1, 2, 3, 4, 8, 64)]
    size = np.repeat(lengths, 12)
    mean = stream.anchors(len(size)) * size[:, None]
    zeros = np.array(list(itertools.product((0.0, -0.0), repeat=3)))
    return {"tangent_mean": single(np.concatenate([mean, zeros]))}


def soft_exponents(stream: Stream) -> Points:
    powers = [0.0, 1e-30, 1e-3, 1.0, 5.0, 200.0, 1e4, 1e5]
    variances = [0.0, 1e-30, 6e-8, 1e-4, 0.05, 1.0, 999.0]
    kappas = [*with_neighbours((-1.0,), (0, 1)), -0.5, 0.0, 1e-30, 1.0]
    return grid(exponent=powers, variance=variances, azimuth_cosine=kappas)


ANY_W = direction("w", "^[wlv]$")

FAMILIES: tuple[Family, ...] = (
    Family(
        "grazing_coats",
        (direction("t"), direction("n"), ANY_W),
        "w.n down to 1e-7 on either side of 0, or 0; hair anywhere, near w, or along w",
        "sin / (w.n) is 0/0 or unbounded; bald skin must stay bald",
        grazing_coats,
    ),
    Family(
        "coat_frames",
        (direction("t"), direction("n"), direction("l"), direction("v")),
        "l and v along the fibre, grazing the skin, both, or free; hair flat or leaning",
        "kappa undefined and depth unbounded in one point",
        coat_frames,
    ),
    Family(
        "coat_products",
        (scalar("density"), scalar("hair_area")),
        "density * hair_area from 0 over 1e-42 to 1e12",
        "products that vanish or leave the clamp at 1e9",
        coat_products,
    ),
    Family(
        "hair_shapes",
        (scalar("density"), scalar("hair_length"), scalar("radius_base"), scalar("radius_tip")),
        "bald to dense, cones, cylinders, needles",
        "zero area in every way it can come about",
        hair_shapes,
    ),
    Family(
        "directional_attenuations",
        (scalar("azimuth_cosine"), scalar("rho_reflect"), scalar("rho_transmit")),
        "kappa -1, 0, 1 and next to them; rho 0, 1e-8, 1 - 2^-24, 1",
        "the value must stay between the two rho",
        directional_attenuations,
    ),
    Family(
        "equal_attenuations",
        (scalar("azimuth_cosine"), scalar("rho_reflect"), scalar("rho_transmit")),
        "rho_reflect = rho_transmit, any kappa",
        "the value is rho, bit for bit",
        equal_attenuations,
    ),
    Family(
        "surface_attenuations",
        (scalar("n_dot_l"), scalar("rho_surface"), scalar("cos_dark"), scalar("cos_lit")),
        "cos_dark = cos_lit, 1 or 2 ULPs apart, or apart; n.l on the edges and next to them",
        "a step, and a division by the difference of the edges",
        surface_attenuations,
    ),
    Family(
        "lopsided_depths",
        (scalar("depth_view"), scalar("depth_light")),
        "optical depths 1e-10 to 1e9, shared between view and light up to 1 : 1e12",
        "the ratio of large depths decides after both exponentials have died",
        lopsided_depths,
    ),
    Family(
        "footprints",
        (Role("tangent_mean", "vec3", False, "^tangent_mean$"),),
        "mean tangents of length 0, 1e-30, about 1e-3, and within ULPs of 1",
        "1 - |mean| cancels; the zero vector has no direction",
        footprints,
    ),
    Family(
        "soft_exponents",
        (scalar("exponent"), scalar("variance"), scalar("azimuth_cosine")),
        "exponent 0 to 1e5, variance 0 to 999, kappa about -1 and 1",
        "1 + kappa cancels; exponent 0 divides 0 by 0 in sqrt(p' / p)",
        soft_exponents,
    ),
)
