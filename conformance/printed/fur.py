"""Misprints of the slides on fake fur."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from conformance.printed.misprint import Drawing, Misprint, N, Pair, value
from conformance.printed.places import Array, direction, over_hemisphere

T = direction(50, 0)
LIGHT = direction(60, 150)
HIGH_LIGHT = direction(30, 150)
VIEWER = direction(0, 0)
LENGTH, BASE, TIP = 1.0, 0.002, 0.001
COAT = {"density": 400.0, "hair_length": LENGTH, "radius_base": BASE, "radius_tip": TIP}
OPTICS: dict[str, Any] = {
    "k_diffuse": [[0.72, 0.46, 0.24]],
    "k_specular": [[0.45, 0.42, 0.38]],
    "exponent": 20.0,
    "rho_reflect": 0.9,
    "rho_transmit": 0.5,
    "rho_surface": 0.8,
    "cos_dark": 0.0,
    "cos_lit": 0.5,
    "overlap": 0.5,
}
SKIN = np.array([[0.55, 0.33, 0.29]])
COMB = np.array([[0.35, -0.9, 0.25]])
"""The coat of the ball is combed this way."""

EXAMPLE = "400 hairs of length 1, radii 0.002 and 0.001; t 50°, 0°"
SHADOW = "rho_surface 0.8; th_min 60°, th_max 90°"


def area(printed: bool) -> Array:
    name = "fur_hair_area_printed" if printed else "fur_hair_area"
    return np.asarray(value(name, hair_length=LENGTH, radius_base=BASE, radius_tip=TIP))


def depth(w: Array, t: Array = T, n: Array = N, printed: bool = False) -> Array:
    coat = {"density": COAT["density"], "hair_area": area(printed)}
    return np.asarray(value("fur_optical_depth", **coat, t=t, n=n, w=w))


def half_area(v: Array, _: Array) -> Pair:
    right, printed = (value("fur_opacity", optical_depth=depth(v, printed=p)) for p in (False, True))
    return right, printed


def surface_attenuation(l: Array, n: Array = N) -> Array:
    cosine = np.sum(n * l, axis=1)
    edges = {key: OPTICS[key] for key in ("rho_surface", "cos_dark", "cos_lit")}
    return np.asarray(value("fur_surface_attenuation", n_dot_l=cosine, **edges))


def attenuation_with(edge0: Array | float, edge1: float, x: Array | float) -> Array:
    step = value("safe_smoothstep", edge0=edge0, edge1=edge1, x=x)
    return np.asarray(1.0 + 0.8 * (step - 1.0))


TH_MIN, TH_MAX = float(np.arccos(0.5)), float(np.pi / 2.0)


def surface_angles(l: Array, _: Array, n: Array = N) -> Pair:
    return surface_attenuation(l, n), attenuation_with(TH_MIN, TH_MAX, np.sum(n * l, axis=1))


def surface_order(l: Array, _: Array) -> Pair:
    return surface_attenuation(l), attenuation_with(l[:, 2], TH_MIN, TH_MAX)


def weights(v: Array, l: Array, part: str) -> Pair:
    view, light = depth(v), depth(l)
    right = value("fur_weights_goldman", depth_view=view, depth_light=light, overlap=0.5)
    printed = value("fur_weights_goldman", depth_view=view, depth_light=view, overlap=0.5)
    return np.broadcast_to(right[part], len(v)), np.broadcast_to(printed[part], len(v))


def shade(
    t: Array,
    n: Array,
    l: Array,
    v: Array,
    half: bool = False,
    view: bool = False,
    sign: bool = False,
    angles: bool = False,
) -> Array:
    """Fake fur in linear RGB with any of the four misprints: all of them are fakefur_shade_printed.

    half    half the hair's area
    view    the opacity along the view where the light's belongs
    sign    the highlight on the cone t.v = t.l
    angles  a cosine compared with angles
    """
    depth_view, depth_light = depth(v, t, n, half), depth(v if view else l, t, n, half)
    w = value("fur_weights_goldman", depth_view=depth_view, depth_light=depth_light, overlap=0.5)
    if sign:
        cosine = value("strand_cosine_kajiya_printed", t=t, l=l, v=v)
        highlight = value("safe_pow", x=cosine, y=OPTICS["exponent"])
    else:
        highlight = value("strand_specular", t=t, l=l, v=v, exponent=OPTICS["exponent"])
    directional = value(
        "fur_directional_attenuation",
        azimuth_cosine=value("strand_azimuth_cosine", t=t, l=l, v=v),
        rho_reflect=OPTICS["rho_reflect"],
        rho_transmit=OPTICS["rho_transmit"],
    )
    surface = surface_angles(l, l, n)[1] if angles else surface_attenuation(l, n)
    sine = value("strand_diffuse", t=t, l=l)
    hair = np.outer(sine, OPTICS["k_diffuse"]) + np.outer(highlight, OPTICS["k_specular"])
    return np.asarray(
        hair * (w["hair"] * directional * surface)[:, None] + w["skin"][:, None] * skin_towards(l, n)
    )


def skin_towards(l: Array, n: Array) -> Array:
    """Lambert's skin with its n.l, (N, 3)."""
    return np.asarray(SKIN * np.maximum(np.sum(n * l, axis=1), 0.0)[:, None])


def library_shade(name: str, t: Array, n: Array, l: Array, v: Array) -> Array:
    rows = {"t": t, "n": n, "l": l, "v": v, "light": np.ones((1, 3)), "skin": skin_towards(l, n)}
    return np.asarray(value(name, coat=COAT, optics=OPTICS, **rows))


def whole(v: Array, l: Array) -> Pair:
    return library_shade("fakefur_shade", T, N, l, v), library_shade("fakefur_shade_printed", T, N, l, v)


def alone(v: Array, l: Array, misprint: str) -> Pair:
    return shade(T, N, l, v), shade(T, N, l, v, **{misprint: True})


def furry_ball(n: Array, l: Array) -> Pair:
    """A ball of combed fur, seen from z."""
    t = value("safe_normalize", x=COMB - np.sum(COMB * n, axis=1, keepdims=True) * n + 0.7 * n, fallback=n)
    right, printed = (
        library_shade(name, t, n, l, VIEWER) for name in ("fakefur_shade", "fakefur_shade_printed")
    )
    return right, printed


LIT = (("l", HIGH_LIGHT), ("t", T))

MISPRINTS = (
    Misprint(
        key="self-shadow-angles",
        title="Surface shadow, a cosine compared with angles",
        slide="Self-Shadowing",
        printed="1 + rho (smoothstep(th_min, th_max, n.l) - 1)",
        right="1 + rho (smoothstep(cos th_max, cos th_min, n.l) - 1)",
        effect="The slide compares n.l with angles. A th_min above 1 radian, 57°, is never reached: "
        "the whole body is in total shadow.",
        setting=SHADOW,
        over="l",
        places=over_hemisphere(),
        quantity=surface_angles,
        drawing=Drawing("f_surface over l"),
        functions=("fakefur_shade_printed",),
    ),
    Misprint(
        key="self-shadow-order",
        title="Surface shadow, the order of arguments",
        slide="Self-Shadowing",
        printed="1 + rho (smoothstep(n.l, th_min, th_max) - 1)",
        right="1 + rho (smoothstep(cos th_max, cos th_min, n.l) - 1)",
        effect="Taken to the letter, in the order (edge0, edge1, x) of the shading languages, the step is "
        "always 1: no shadow anywhere.",
        setting=SHADOW,
        over="l",
        places=over_hemisphere(),
        quantity=surface_order,
        drawing=Drawing("f_surface over l"),
    ),
    Misprint(
        key="hair-area",
        title="Area of a hair",
        slide="Fur Opacity",
        printed="a_h = l_hair (r_base + r_top) / 2",
        right="a_h = l_hair (r_base + r_top)",
        effect="A truncated cone shows a trapezoid with sides 2 r_base and 2 r_top; the slide has half of "
        "it, which is right only if r is a diameter. Half the depth: the coat is too thin.",
        setting=EXAMPLE,
        over="v",
        places=over_hemisphere(),
        quantity=half_area,
        drawing=Drawing("opacity over v", marks=(("t", T),)),
        functions=("fur_hair_area_printed",),
    ),
    Misprint(
        key="alpha-hair",
        title="One opacity throughout: weight of the hair",
        slide="Putting It All Together",
        printed="alpha(v) (1 - alpha(v) / 2)",
        right="alpha(v) (1 - alpha(l) / 2)",
        effect="Hair shadows hair along the light; the slide takes the opacity along the view for both.",
        setting=f"{EXAMPLE}; l 30°, 150°",
        over="v",
        places=over_hemisphere(),
        quantity=partial(weights, part="hair"),
        drawing=Drawing("weight of the hair over v", marks=LIT),
        light=HIGH_LIGHT,
        functions=("fakefur_shade_printed",),
    ),
    Misprint(
        key="alpha-skin",
        title="One opacity throughout: weight of the skin",
        slide="Putting It All Together",
        printed="(1 - alpha(v))^2",
        right="(1 - alpha(v)) (1 - alpha(l))",
        effect="Light reaches the skin along l and leaves it along v. With v for both, skin that is seen "
        "well is lit well, wherever the light may be.",
        setting=f"{EXAMPLE}; l 30°, 150°",
        over="v",
        places=over_hemisphere(),
        quantity=partial(weights, part="skin"),
        drawing=Drawing("weight of the skin over v", marks=LIT),
        light=HIGH_LIGHT,
        functions=("fakefur_shade_printed",),
    ),
    Misprint(
        key="fakefur",
        title="Fake fur, all four together",
        slide="Putting It All Together",
        printed="fakefur_shade_printed",
        right="fakefur_shade",
        effect="Half the area, alpha(v) throughout, the highlight's sign, and a cosine compared with angles.",
        setting=f"{EXAMPLE}; l 60°, 150°; {SHADOW}; exponent 20; brown hair, light of "
        "colour 1; picture: a ball of combed fur, seen from the front",
        over="v",
        places=over_hemisphere(),
        quantity=whole,
        drawing=Drawing("light of colour 1, shown as sRGB", scale=None, ball=furry_ball),
        light=LIGHT,
        functions=("fakefur_shade_printed", "fur_hair_area_printed", "strand_cosine_kajiya_printed"),
        parts=(
            ("half the area of a hair", partial(alone, misprint="half")),
            ("alpha(v) throughout", partial(alone, misprint="view")),
            ("cos cos + sin sin in the highlight", partial(alone, misprint="sign")),
            ("a cosine compared with angles", partial(alone, misprint="angles")),
        ),
    ),
)
