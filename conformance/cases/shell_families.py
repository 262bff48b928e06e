"""Families for shells and fins: layer counts, thin and slanted layers, cancelling combs, fins edge-on."""

from __future__ import annotations

import itertools

import numpy as np

from conformance.cases.family import Family, Points, Role, direction, scalar
from conformance.cases.scalars import decades, grid, joined, with_neighbours
from conformance.cases.stream import LADDER, Stream, single, tilted
from conformance.cases.triples import signs

STEPS = (*LADDER, 0.0)
ALPHAS = (0.0, 1e-30, 1e-8, 1e-4, 0.1, 0.5, 0.9, 1.0 - 2.0**-12, 1.0 - 2.0**-24, 1.0)


def layer_counts(stream: Stream) -> Points:
    """Bottom, top and middle layer; counts whose reciprocal is inexact; one layer."""
    counts = (
        1,
        2,
        3,
        4,
        5,
        8,
        16,
        32,
        41,
        42,
        47,
        48,
        55,
        56,
        61,
        64,
        94,
        97,
        100,
        110,
        119,
        128,
        255,
        256,
        257,
    )
    rows: list[tuple[int, int]] = []
    for layers in (*counts, 1000, 1023, 1025, 4096, 65535, 65536, (1 << 20) - 1, 1 << 20, (1 << 24) - 1):
        last = layers - 1
        rows += [(k, layers) for k in (0, 1, last // 3, last // 2, max(last - 1, 0), last) if k <= last]
        rows += [(layers, layers), (layers + 7, layers)]
    table = np.array(rows, dtype=np.uint32)
    return {"layer": table[:, 0].copy(), "layers": table[:, 1].copy()}


def shadow_falloffs(stream: Stream) -> Points:
    heights = [0.0, 1e-30, 1e-7, 1.0 / 3.0, 0.5, 0.7, *with_neighbours((1.0,), (-2, -1, 0))]
    lowest = [0.0, 1e-30, 1e-8, 0.3, 0.8, *with_neighbours((1.0,), (-2, -1, 0)), *stream.uniform(20)]
    return grid(height=heights, s_min=lowest)


def thin_layers(stream: Stream) -> Points:
    counts = [1.0, 2.0, 7.0, 15.0, 31.0, 64.0, 1000.0]
    return joined(
        grid(alpha=ALPHAS, authored=counts, drawn=counts),
        grid(alpha=ALPHAS, authored=[16.0], drawn=[0.0, 0.5, 1e4]),
    )


def slanted_layers(stream: Stream) -> Points:
    cosines = [0.0, 1e-30, 1e-7, 9.9e-6, *with_neighbours((1e-5,), (-1, 0, 1)), 1e-4, 1e-3, 0.03, 0.5, 1.0]
    return grid(alpha=ALPHAS, n_dot_v=cosines + [-x for x in cosines if x > 0.0])


def combed_shells(stream: Stream) -> Points:
    """n + height comb + height^2 force zero, short, or dominated by the force."""
    turn = np.repeat(STEPS, 14)
    n = len(turn)
    normal = stream.anchors(n)
    height = np.array([1.0, 0.5, 0.25, 0.0, 1e-3, 1.0, 0.75])[np.arange(n) % 7]
    against = -tilted(normal, stream.across(normal), turn)
    share = np.array([0.0, 0.5, 1.0])[np.arange(n) % 3]
    safe = np.where(height > 0.0, height, 1.0)
    comb = against * ((1.0 - share) / safe)[:, None]
    force = against * (share / safe**2)[:, None]
    blown = (np.arange(n) % 9 == 8)[:, None]
    force = np.where(blown, 1e3 * stream.directions(n), force)
    return {"n": single(normal), "height": single(height), "comb": single(comb), "force": single(force)}


def shell_lights(stream: Stream) -> Points:
    """Light or half vector along the normal, near it, or at a right angle; exponents 0 to 1e5."""
    turn = np.repeat(STEPS, 14)
    n = len(turn)
    normal = stream.anchors(n)
    along = signs(n, 2)[:, None] * tilted(normal, stream.across(normal), turn)
    across = tilted(stream.across(normal), normal, turn * signs(n, 3))
    d = np.where((np.arange(n) % 2 == 0)[:, None], along, across)
    p = np.array([0.0, 1e-3, 0.5, 1.0, 8.0, 100.0, 1e5])[np.arange(n) % 7]
    return {"n": single(normal), "d": single(d), "p": single(p)}


def fin_edges(stream: Stream) -> Points:
    """Edges of length 1e-6 to 1e6, along the normal, near it, or across it; exact axes among them."""
    turn = np.repeat(STEPS, 12)
    n = len(turn)
    normal = stream.anchors(n)
    size = np.array([1e-6, 1e-3, 0.1, 1.0, 30.0, 1e6])[np.arange(n) % 6]
    along = signs(n, 2)[:, None] * tilted(normal, stream.across(normal), turn)
    across = tilted(stream.across(normal), normal, turn)
    edge = np.where((np.arange(n) % 4 < 3)[:, None], along, across) * size[:, None]
    return {"edge": single(edge), "n": single(normal)}


def fins_edge_on(stream: Stream) -> Points:
    """|v.n_fin| about 0 (edge-on), 1/2 (where the fin appears) and 1 (seen in full)."""
    turn = np.repeat(STEPS, 12)
    n, kind = len(turn), (np.arange(len(turn)) % 3)[:, None]
    fin = stream.anchors(n)
    u = stream.across(fin)
    middle = 0.5 * fin + np.sqrt(0.75) * u
    turned = tilted(middle, np.sqrt(0.75) * fin - 0.5 * u, turn * signs(n, 3))
    v = np.where(kind == 0, tilted(u, fin, turn), np.where(kind == 1, turned, tilted(fin, u, turn)))
    return {"v": single(v * signs(n, 6)[:, None]), "n": single(fin)}


def silhouettes(stream: Stream) -> Points:
    facings = [0.0, 1e-30, 1e-20, 1e-7, 9.9e-7, 1e-6, 1e-3, 0.125, 0.25, 1.0]
    signed = [*facings, *(-x for x in facings if x > 0.0)]
    some = signed[::2]
    return joined(
        grid(facing_a=signed, facing_b=some, threshold=[0.25, 1e-6]),
        grid(facing_a=some, facing_b=some, threshold=[0.0, 1e-30, 1.0]),
    )


def strand_mask_cells(stream: Stream) -> Points:
    """Cell corners and centres, the root and the tip, strands of no and of full thickness."""
    places = (0.0, 2.0**-24, 0.25, 0.5, 0.99)
    rows = list(
        itertools.product(places, places, (0.0, 0.5, 1.0 - 2.0**-24, 1.0), (1.0, 4.0, 64.0), (0.0, 0.5, 1.0))
    )
    table = np.array(rows)
    return {
        "uv": single(table[:, :2]),
        "height": single(table[:, 2]),
        "density": single(table[:, 3]),
        "thickness": single(table[:, 4]),
    }


def layer_compositing(stream: Stream) -> Points:
    """Alpha 0, 1 and next to them, with colours from 0 over 1e-30 to 1e4."""
    alphas = [*with_neighbours((0.5, 1.0), (-1, 0)), 0.0, 1e-30, 1e-8, *decades(-3, 0, ("1", "3"))]
    rows = [alpha for alpha in alphas for _ in range(20)]
    scale = np.array([0.0, 1e-30, 1e-4, 1.0, 1.0])[np.arange(len(rows)) % 5]
    under = stream.uniform(3 * len(rows)).reshape(-1, 3) * scale[:, None]
    over = stream.uniform(3 * len(rows)).reshape(-1, 3) * scale[::-1][:, None]
    return {"under": single(under), "over": single(over), "alpha": single(rows)}


def colour(name: str) -> Role:
    """A vec3 of free components."""
    return Role(name, "vec3", False, f"^{name}$")


FAMILIES: tuple[Family, ...] = (
    Family(
        "layer_counts",
        (scalar("layer", type_="u32"), scalar("layers", type_="u32")),
        "first, middle, top and beyond; one layer; counts with inexact reciprocals",
        "x / x may miss 1 by 2.5 ULP on every target",
        layer_counts,
    ),
    Family(
        "shadow_falloffs",
        (scalar("height"), scalar("s_min")),
        "heights 0 and 1 and next to them, any floor",
        "both ends are exact under either rounding",
        shadow_falloffs,
    ),
    Family(
        "thin_layers",
        (scalar("alpha"), scalar("authored"), scalar("drawn")),
        "opacities from 1e-30 to 1, layer counts 1 to 1000",
        "1 - (1 - alpha)^k cancels for thin layers; alpha = 1 stays 1",
        thin_layers,
    ),
    Family(
        "slanted_layers",
        (scalar("alpha"), scalar("n_dot_v")),
        "|n.v| from 0 over 1e-5 to 1, both signs",
        "the exponent 1 / |n.v| grows to 1e5",
        slanted_layers,
    ),
    Family(
        "combed_shells",
        (direction("n"), scalar("height"), colour("comb"), colour("force")),
        "comb and force against the normal, to zero or nearly",
        "normalisation of a sum that cancels",
        combed_shells,
    ),
    Family(
        "shell_lights",
        (direction("n"), direction("d", "^[lh]$"), scalar("p", "^p_(diffuse|specular)$")),
        "light or half vector along the normal, across it, or 4.7e-1 to 1e-7 off; exponents 0 to 1e5",
        "sine 0 and exponent 0; powers of a sine next to 1",
        shell_lights,
    ),
    Family(
        "fin_edges",
        (colour("edge"), direction("n")),
        "edges of length 1e-6 to 1e6 along the normal, near it and across it",
        "the cross product vanishes or is rounding",
        fin_edges,
    ),
    Family(
        "fins_edge_on",
        (direction("v"), direction("n", "^n(_fin)?$")),
        "|v.n| about 0, 1/2 and 1",
        "where a fin is edge-on, where it appears, where it is full",
        fins_edge_on,
    ),
    Family(
        "silhouettes",
        (scalar("facing_a"), scalar("facing_b"), scalar("threshold")),
        "facings 0 to 1 of both signs, thresholds 0 to 1",
        "the product of tiny facings underflows; the sign change must be continuous",
        silhouettes,
    ),
    Family(
        "strand_mask_cells",
        (Role("uv", "vec2", False, "^uv$"), scalar("height"), scalar("density"), scalar("thickness")),
        "corners of hash cells, roots and tips, no and full thickness",
        "floor() at cell borders; a tip of no width",
        strand_mask_cells,
    ),
    Family(
        "layer_compositing",
        (colour("under"), colour("over"), scalar("alpha")),
        "alpha 0, 1 and next to them; dark and bright colours",
        "alpha 0 and 1 keep one colour unchanged",
        layer_compositing,
    ),
)
