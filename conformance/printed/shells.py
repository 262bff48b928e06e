"""Misprints of the slides on shells and fins."""

from __future__ import annotations

import numpy as np

from conformance.printed.misprint import Drawing, Misprint, N, Pair, value
from conformance.printed.places import LAYERS, Array, direction, over_hemisphere, over_layers

FIN = direction(90, 0)
LIGHT = direction(50, 150)
VIEWER = direction(0, 0)
S_MIN = 0.3
COLOURS = {
    "k_diffuse": [[0.5, 0.32, 0.18]],
    "p_diffuse": 2.0,
    "k_specular": [[0.35, 0.34, 0.32]],
    "p_specular": 32.0,
}


def fin(v: Array, _: Array) -> Pair:
    return value("fin_opacity", v=v, n_fin=FIN), value("fin_opacity_surface", v=v, n=N)


def shaded(n: Array, l: Array, v: Array) -> Pair:
    rows = {"n": n, "l": l, "h": value("half_vector", l=l, v=v)}
    return value("shell_shade", **rows, **COLOURS), value("shell_shade_printed", **rows, **COLOURS)


def shell_shade(v: Array, l: Array) -> Pair:
    return shaded(N, l, v)


def shell_ball(n: Array, l: Array) -> Pair:
    """A ball of shells, seen from z, each colour times the light that the body lets through."""
    lit = value("inherited_shadow", n=n, l=l)[:, None]
    right, printed = shaded(n, l, VIEWER)
    return right * lit, printed * lit


def shell_shadow(layer: Array, _: Array) -> Pair:
    d = layer[:, 0]
    heights = (d / (LAYERS - 1.0), d / LAYERS)
    right, printed = (value("shell_shadow", height=height, s_min=S_MIN) for height in heights)
    return right, printed


def identity(exponent: float) -> float:
    """Largest error of 1 - c^(p/2) for (1 - c^2)^(p/2) over cosines in [0, 1]."""
    cosine = np.linspace(0.0, 1.0, 100001)
    n = np.stack([np.zeros_like(cosine), np.sqrt(1.0 - cosine * cosine), cosine], axis=1)
    only = {"k_diffuse": [[1.0] * 3], "k_specular": [[0.0] * 3], "p_diffuse": exponent, "p_specular": 1.0}
    right, printed = (value(name, n=n, l=N, h=N, **only) for name in ("shell_shade", "shell_shade_printed"))
    return float(np.abs(right - printed).max())


MISPRINTS = (
    Misprint(
        key="fin-opacity",
        title="Fin without a normal",
        slide="Shells and Fins",
        printed="max(0, 2 |sin(v, n_surface)| - 1)",
        right="max(0, 2 |cos(v, n_fin)| - 1)",
        effect="The sine to the surface normal is only an upper bound of the cosine to the fin's: fins that "
        "are seen edge-on are drawn opaque.",
        setting="n_fin 90°, 0°",
        over="v",
        places=over_hemisphere(),
        quantity=fin,
        drawing=Drawing("opacity over v", marks=(("n_fin", FIN),)),
    ),
    Misprint(
        key="shell-shade",
        title="Lighting of shells",
        slide="Lighting Shells and Fins",
        printed="k_d (1 - (n.l)^(p_d/2)) + k_s (1 - (n.h)^(p_s/2))",
        right="k_d (1 - (n.l)^2)^(p_d/2) + k_s (1 - (n.h)^2)^(p_s/2)",
        effect="sin^p is (1 - cos^2)^(p/2). As printed a high exponent makes the highlight wider, not "
        "narrower: it covers all but the directions along n.",
        setting="l 50°, 150°; p_d 2, p_s 32; picture: a ball of shells, seen from the front, with n.l",
        over="v",
        places=over_hemisphere(),
        quantity=shell_shade,
        drawing=Drawing("light of colour 1, shown as sRGB", scale=None, ball=shell_ball),
        light=LIGHT,
        functions=("shell_shade_printed",),
    ),
    Misprint(
        key="shell-shadow",
        title="Shadow of shells",
        slide="Lighting Shells and Fins",
        printed="s_min + (1 - s_min) d / d_max with d_max = number of shells",
        right="the same with d_max = number of shells - 1",
        effect="d runs from 0 to the number of shells less one, so the outermost shell never comes out of "
        "the shadow.",
        setting=f"{LAYERS} shells, s_min {S_MIN:g}; picture: the shells as rings, the skin in the middle",
        over="d",
        places=over_layers(),
        quantity=shell_shadow,
        drawing=Drawing("shadow factor over d"),
    ),
)
