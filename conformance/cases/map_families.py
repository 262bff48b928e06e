"""Families for maps: equators, poles, seams and creases with signed zeros, borders, densities."""

from __future__ import annotations

import itertools

import numpy as np

from conformance.cases.family import Family, Points, Role, direction, scalar
from conformance.cases.scalars import decades, grid, joined, with_neighbours
from conformance.cases.stream import LADDER, Stream, normalised, single

TINY = (0.0, -0.0, 1e-30, -1e-30, 1e-12, -1e-12, 6e-8, -6e-8, 1e-5, -1e-5, 1e-3, -1e-3)
CIRCLE = ((1.0, 0.0), (0.6, 0.8), (0.28, 0.96), (0.8, 0.6), (1.0, 1.0), (1.0, 1e-6))
SIGNS = tuple(itertools.product((1.0, -1.0), repeat=2))
GRID = 2.0**-24


def map_equators(stream: Stream) -> Points:
    """One component 0, -0 or tiny, for every axis, around the whole circle of the other two."""
    rows: list[list[float]] = []
    for axis, value, (x, y), (sx, sy) in itertools.product(range(3), TINY, CIRCLE, SIGNS):
        vector = [0.0, 0.0, 0.0]
        vector[axis], vector[(axis + 1) % 3], vector[(axis + 2) % 3] = value, sx * x, sy * y
        rows.append(vector)
    return {"w": single(normalised(np.array(rows[::2])))}


def map_poles(stream: Stream) -> Points:
    """Two components 0, -0 or tiny, for every axis and both ends."""
    rows: list[list[float]] = []
    for axis, end, first, second in itertools.product(range(3), (1.0, -1.0), TINY, TINY):
        vector = [0.0, 0.0, 0.0]
        vector[axis], vector[(axis + 1) % 3], vector[(axis + 2) % 3] = end, first, second
        rows.append(vector)
    return {"w": single(normalised(np.array(rows)))}


def latlong_seam(stream: Stream) -> Points:
    """w.x zero or tiny with w.z > 0 (the seam) and w.z < 0 (the middle), from pole to pole."""
    heights = [0.0, -0.0, *LADDER[::3], 0.7, 0.99, 0.9999, 1.0 - 1e-7]
    heights += [-y for y in heights if y > 0.0]
    rows = [
        [x, y, side * np.sqrt((1.0 - y) * (1.0 + y))]
        for y, x, side in itertools.product(heights, TINY[:10], (1.0, -1.0))
    ]
    return {"w": single(normalised(np.array(rows)))}


def octahedron_edges(stream: Stream) -> Points:
    """|p.x| + |p.y| = 1 and within ULPs, axes, corners and borders of the square."""
    rows: list[tuple[float, float]] = []
    for share, (sx, sy), k in itertools.product((0.0, 1e-6, 0.25, 0.5, 0.9, 1.0), SIGNS, (-2, -1, 0, 1, 2)):
        rows.append((0.5 + sx * share / 2.0, 0.5 + sy * (1.0 - share) / 2.0 + k * GRID))
    for along, across in itertools.product((0.0, 0.1, 0.25, 0.5, 0.75, 1.0), (-2, -1, 0, 1, 2)):
        rows += [(along, 0.5 + across * GRID), (0.5 + across * GRID, along)]
    ends = (0.0, GRID, 1.0 - GRID, 1.0)
    inner = itertools.product(ends, (0.3, 0.5, 0.7))
    rows += [(x, y) for x in ends for y in ends]
    rows += [pair for x, y in inner for pair in ((x, y), (y, x))]
    return {"uv": single(np.clip(np.array(rows), 0.0, 1.0))}


def paraboloid_borders(stream: Stream) -> Points:
    """Texels in the centre, about the rim of the disc, and in the border; both faces."""
    rows: list[tuple[float, float, float, float]] = []
    for border, (x, y), radius in itertools.product(
        (1.0, 1.2, 2.0), CIRCLE[:4], (0.0, 1e-6, 0.5, 1.0 - 1e-7, 1.0, 1.0 + 1e-7, 1.1, 1.4)
    ):
        for (sx, sy), back in itertools.product(SIGNS, (0.0, 1.0)):
            rows.append(
                (0.5 + sx * x * radius / border / 2.0, 0.5 + sy * y * radius / border / 2.0, back, border)
            )
    table = np.array(rows)
    return {
        "uv": single(np.clip(table[:, :2], 0.0, 1.0)),
        "back": single(table[:, 2]),
        "border": single(table[:, 3]),
    }


def densities(stream: Stream) -> Points:
    """Densities from 0 over 1e-38 to 1e30, and products with samples and texels about 1e-30 and 1."""
    wide = [0.0, 1.2e-38, 1e-35, 1e-30, 1e-20, 1e-8, 1e-3, 1.0, 1e3, 1e8, 1e30]
    return joined(
        grid(
            pdf=wide, samples=[1.0, 40.0, 1e6], texel_solid_angle=[1e-9, 1e-4, 1.0], lod_bias=[0.0, -2.0, 1.5]
        ),
        grid(pdf=with_neighbours((1e-30, 1.0, 4.0)), samples=[1.0], texel_solid_angle=[1.0], lod_bias=[0.0]),
    )


def strategies(stream: Stream) -> Points:
    """Two densities equal, of any ratio, zero, one of them zero; squares that leave float32."""
    wide = [0.0, 1.2e-38, 1e-30, 1e-20, 1e-10, 1.0, 1e10, 1.9e19, 1e30]
    return grid(samples_a=[1.0, 40.0], pdf_a=wide, samples_b=[1.0, 1e4], pdf_b=wide)


def map_sizes(stream: Stream) -> Points:
    """Rows from pole to pole in maps of 1 to 16384 texels."""
    rows = [0.0, GRID, 1e-4, 1.0 / 32.0, 0.25, 0.5, 0.75, 31.0 / 32.0, 1.0 - 1e-4, 1.0 - GRID, 1.0]
    sizes = [1.0, 2.0, 16.0, 255.0, 4096.0, 16384.0]
    return grid(v=rows, width=sizes, height=sizes[:4])


def paraboloid_heights(stream: Stream) -> Points:
    """z of a direction from -1 to 1, both signs of zero."""
    heights = [0.0, -0.0, *decades(-7, 0, ("1", "3")), *with_neighbours((1.0,), (-2, -1, 0))]
    signed = [*heights, *(-x for x in heights if x != 0.0)]
    return grid(z=signed, width=[16.0, 256.0, 4096.0], height=[16.0, 256.0], border=[1.0, 1.2])


SQUARE = Role("uv", "vec2", False, "^uv$")
FAMILIES: tuple[Family, ...] = (
    Family(
        "map_equators",
        (direction("w"),),
        "one component 0, -0 or 1e-30 to 1e-3, around the circle",
        "the hemisphere is chosen by a sign; the sign of zero must not matter",
        map_equators,
    ),
    Family(
        "map_poles",
        (direction("w"),),
        "two components 0, -0 or 1e-30 to 1e-3, both ends of every axis",
        "atan2(0, 0), folds that meet, 1 + z = 0",
        map_poles,
    ),
    Family(
        "latlong_seam",
        (direction("w"),),
        "w.x 0, -0 or tiny before and behind, from pole to pole",
        "the seam lies where the sign of w.x changes",
        latlong_seam,
    ),
    Family(
        "octahedron_edges",
        (SQUARE,),
        "creases, axes, corners and borders of the square, within 2 steps of 2^-24",
        "folding by sign(0) maps one half to the wrong side",
        octahedron_edges,
    ),
    Family(
        "paraboloid_borders",
        (SQUARE, scalar("back"), scalar("border")),
        "centre, rim and border texels of both faces",
        "z changes sign across the rim",
        paraboloid_borders,
    ),
    Family(
        "densities",
        (scalar("pdf"), scalar("samples"), scalar("texel_solid_angle"), scalar("lod_bias")),
        "density 0, at and below 1e-30, up to 1e30",
        "the logarithm of 0; products that vanish or overflow",
        densities,
    ),
    Family(
        "strategies",
        (scalar("samples_a"), scalar("pdf_a"), scalar("samples_b"), scalar("pdf_b")),
        "densities 0 to 1e30, equal and of any ratio",
        "0/0; squares overflow from 1.8e19 and vanish below 1e-19",
        strategies,
    ),
    Family(
        "map_sizes",
        (scalar("v"), scalar("width"), scalar("height")),
        "rows 0 to 1, maps of 1 to 16384 texels",
        "sin(pi v) at the poles",
        map_sizes,
    ),
    Family(
        "paraboloid_heights",
        (scalar("z"), scalar("width"), scalar("height"), scalar("border")),
        "z from -1 to 1, both zeros",
        "|z|, not z",
        paraboloid_heights,
    ),
)
