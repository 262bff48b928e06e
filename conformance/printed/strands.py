"""Misprints of the slides on strands."""

from __future__ import annotations

import numpy as np

from conformance.printed.misprint import Drawing, Misprint, N, Pair, value
from conformance.printed.places import Array, direction, over_hemisphere

T = direction(90, 0)
"""A strand that lies in the surface."""
LIGHT = direction(45, 30)
PHONG_LIGHT = direction(50, 150)
EXPONENT = 20.0
RHO = 0.02
DEPTH = 20.0
HEIGHT, COAT = 10.0, 40.0

LIT_STRAND = "t 90°, 0°; l 45°, 30°"


def diffuse_cosine(l: Array, _: Array) -> Pair:
    return value("strand_diffuse", t=T, l=l), np.ones(len(l))


def diffuse_sine(l: Array, _: Array) -> Pair:
    sine = value("strand_diffuse", t=T, l=l)
    return sine, sine / np.maximum(np.abs(l @ T[0]), 1e-12)


def mirrored(n: Array, l: Array) -> Array:
    """The slide's reflection vector."""
    return np.asarray(n - 2.0 * np.sum(n * l, axis=1, keepdims=True) * l)


def phong(v: Array, l: Array) -> Pair:
    def lobe(r: Array) -> Array:
        return np.asarray(value("safe_pow", x=np.sum(v * r, axis=1), y=EXPONENT))

    return lobe(value("mirror", l=l, n=N)), lobe(mirrored(N, l))


def cosine_banks(v: Array, l: Array) -> Pair:
    strand = {"t": T, "l": l, "v": v}
    return value("strand_cosine", **strand), value("strand_cosine_banks_printed", **strand)


def cosine_kajiya(v: Array, l: Array) -> Pair:
    strand = {"t": T, "l": l, "v": v}
    return value("strand_cosine", **strand), value("strand_cosine_kajiya_printed", **strand)


def highlight_banks(v: Array, l: Array) -> Pair:
    right, printed = cosine_banks(v, l)
    return value("safe_pow", x=right, y=EXPONENT), value("safe_pow", x=printed, y=EXPONENT)


def highlight_kajiya(v: Array, l: Array) -> Pair:
    right, printed = cosine_kajiya(v, l)
    return value("safe_pow", x=right, y=EXPONENT), value("safe_pow", x=printed, y=EXPONENT)


def transmittance(path: Array) -> Array:
    extinction = value("coat_extinction", rho=RHO)
    return np.asarray(value("coat_transmittance", extinction=extinction, path=path))


def path_length(l: Array, _: Array) -> Pair:
    slab, banks = (
        value("coat_path_slab", depth=DEPTH, n=N, l=l),
        value("coat_path_banks", depth=DEPTH, t=T, l=l),
    )
    return transmittance(slab), transmittance(banks)


def height_for_depth(l: Array, _: Array) -> Pair:
    above, below = (value("coat_path_slab", depth=depth, n=N, l=l) for depth in (HEIGHT, COAT - HEIGHT))
    return transmittance(below), transmittance(above)


STRAND = (("t", T),)
LIT = (("l", LIGHT), ("t", T))

MISPRINTS = (
    Misprint(
        key="diffuse-cosine",
        title="Diffuse strand, from the cosine",
        slide="Diffuse Reflection",
        printed="k_d cos(l, l_N) / (|l| |l_N|)",
        right="k_d (l.l_N) / (|l| |l_N|) = k_d sin(t, l)",
        effect="Normalised twice: the cosine of an angle is a normalised product already. What is left is "
        "the constant k_d, no shading at all.",
        setting="t 90°, 0°; k_d = 1",
        over="l",
        places=over_hemisphere(),
        quantity=diffuse_cosine,
        drawing=Drawing("diffuse term over l", marks=STRAND),
    ),
    Misprint(
        key="diffuse-sine",
        title="Diffuse strand, from the sine",
        slide="Diffuse Reflection",
        printed="k_d sin(l, l_T) / (|l| |l_T|)",
        right="k_d sin(t, l)",
        effect="The same slip in the second form gives tan(t, l): endless light from across the strand.",
        setting="t 90°, 0°; k_d = 1",
        over="l",
        places=over_hemisphere(),
        quantity=diffuse_sine,
        drawing=Drawing("diffuse term over l", (0.0, 2.0), STRAND, limit=2.0),
        unbounded=True,
    ),
    Misprint(
        key="reflection-vector",
        title="Reflection vector",
        slide="Specular Reflection",
        printed="r = n - 2 (n.l) l",
        right="r = 2 (n.l) n - l",
        effect="n and l have changed places: r is n mirrored by l. Still a unit vector, so nothing looks "
        "broken but the place of the highlight. It points straight down for light from above.",
        setting="max(0, v.r)^20; l 50°, 150°",
        over="v",
        places=over_hemisphere(),
        quantity=phong,
        drawing=Drawing("Phong's highlight over v", marks=(("l", PHONG_LIGHT),)),
        light=PHONG_LIGHT,
    ),
    Misprint(
        key="strand-cosine-banks",
        title="Strand cosine after Banks",
        slide="Specular Reflection",
        printed="v.r = cos_l cos_v - sin_l sin_v",
        right="v.r = sin_l sin_v - cos_l cos_v",
        effect="The exact negative: -1 on the cone where the highlight belongs.",
        setting=LIT_STRAND,
        over="v",
        places=over_hemisphere(),
        quantity=cosine_banks,
        drawing=Drawing("strand cosine over v", (-1.0, 1.0), LIT),
        light=LIGHT,
        functions=("strand_cosine_banks_printed",),
    ),
    Misprint(
        key="highlight-banks",
        title="Highlight after Banks",
        slide="Specular Reflection",
        printed="max(0, cos_l cos_v - sin_l sin_v)^20",
        right="max(0, sin_l sin_v - cos_l cos_v)^20",
        effect="The highlight is gone; without the max, an even exponent would hide the sign.",
        setting=LIT_STRAND,
        over="v",
        places=over_hemisphere(),
        quantity=highlight_banks,
        drawing=Drawing("highlight over v", marks=LIT),
        light=LIGHT,
        functions=("strand_cosine_banks_printed",),
    ),
    Misprint(
        key="strand-cosine-kajiya",
        title="Strand cosine after Kajiya and Kay",
        slide="Illumination Function",
        printed="cos_l cos_v + sin_l sin_v",
        right="sin_l sin_v - cos_l cos_v",
        effect="Right only where one of l and v points inward: 1 on the cone t.v = t.l in place of "
        "t.v = -t.l.",
        setting=LIT_STRAND,
        over="v",
        places=over_hemisphere(),
        quantity=cosine_kajiya,
        drawing=Drawing("strand cosine over v", (-1.0, 1.0), LIT),
        light=LIGHT,
        functions=("strand_cosine_kajiya_printed",),
    ),
    Misprint(
        key="highlight-kajiya",
        title="Highlight after Kajiya and Kay",
        slide="Illumination Function",
        printed="max(0, cos_l cos_v + sin_l sin_v)^20",
        right="max(0, sin_l sin_v - cos_l cos_v)^20",
        effect="The highlight lies on the cone on the other side of the strand's normal plane: it passes "
        "through the light.",
        setting=LIT_STRAND,
        over="v",
        places=over_hemisphere(),
        quantity=highlight_kajiya,
        drawing=Drawing("highlight over v", marks=LIT),
        light=LIGHT,
        functions=("strand_cosine_kajiya_printed",),
    ),
    Misprint(
        key="coat-path",
        title="Path through a coat",
        slide="Vector Field Shadowing",
        printed="(1 - rho)^(h / sin(t, l))",
        right="(1 - rho)^(h / (n.l))",
        effect="The way through a flat coat depends on n, not on t. The two agree where l lies in the plane "
        "of t and n; light that grazes across the strands is not shadowed enough.",
        setting="t 90°, 0°; rho 0.02, depth h 20",
        over="l",
        places=over_hemisphere(),
        quantity=path_length,
        drawing=Drawing("transmittance over l", marks=STRAND),
    ),
    Misprint(
        key="coat-height",
        title="Height or depth in a coat",
        slide="Vector Field Shadowing",
        printed="h = distance from the surface",
        right="h = depth below the outer boundary of the coat",
        effect="Read as the height above the skin, h puts the roots in the light and the tips in the shadow.",
        setting="rho 0.02; a coat of thickness 40 at height 10, both with the path h / (n.l)",
        over="l",
        places=over_hemisphere(),
        quantity=height_for_depth,
        drawing=Drawing("transmittance over l"),
    ),
)
