"""Poulin-Fournier lobe: value."""

from shaderlib.constants import TINY_SQUARE
from shaderlib.domains import Direction, Exponent, UnitInterval
from shaderlib.lang import f32, max, min, variant, vec2
from shaderlib.lobes.arc_normal import arc_normal
from shaderlib.lobes.blinn_phong_scale import blinn_phong_scale
from shaderlib.lobes.domains import Spread
from shaderlib.lobes.satin_diffuse import satin_diffuse
from shaderlib.lobes.satin_highlight import satin_highlight, satin_highlight_eight
from shaderlib.lobes.satin_visible import satin_visible

# Height of the steeper direction from which on the highlight, at most 4000 over that height, is finite.
LEAST_HEIGHT = 1.0e-30


def poulin_fournier_value(
    l: Direction, v: Direction, spread: Spread, specular: UnitInterval, exponent: Exponent
) -> f32:
    """Reflectance of satin per steradian, without the cosine: parallel cylinders along x, one bounce.

    l           direction to the light, in the local frame
    v           direction to the viewer, in the local frame
    spread      half angle of each cylinder's arc, in radians: pi / 2 touching half cylinders, toward 0 flat
    specular    share of the light that facets of the cylinders reflect; the rest is diffuse
    exponent    p, sharpness of the facets
    returns     (1 - specular) diffuse + specular highlight, each an integral over the part of the arc that l
                and v both see, over 2 sin(spread) l.z v.z: of (N.l) (N.v) / pi and of blinn_phong_scale(p)
                (N.l) (N.v) (N.h)^p. Reciprocal; albedo at most 1
    degenerate  l.z <= 0, v.z <= 0 or no point of an arc sees both: 0
    form        diffuse part in closed form; highlight by 12 Gauss-Legendre nodes, 4e-6 of its peak off. Its
                integral is at most pitch times the smaller height, by which it is divided first: the product
                of both heights may vanish. The max around 1 - specular changes no value: it keeps compilers
                from interpolating from diffuse to highlight by their difference
    source      Poulin and Fournier 1990, A Model for Anisotropic Reflection; geometry, self-blocking and both
                integrals derived for this library, without the paper's floor between separate cylinders
    """
    edge = arc_normal(spread)
    seen_l = satin_visible(l, spread, edge)
    seen_v = satin_visible(v, spread, edge)
    visible = vec2(max(seen_l.x, seen_v.x), min(seen_l.y, seen_v.y))
    pitch = 2.0 * edge.y
    seen = min(satin_highlight(l, v, visible, exponent) / max(pitch * min(l.z, v.z), TINY_SQUARE), 1.0)
    highlight = blinn_phong_scale(exponent) * seen / max(max(l.z, v.z), LEAST_HEIGHT)
    value = max(1.0 - specular, 0.0) * satin_diffuse(l, v, visible, pitch) + specular * highlight
    return value if l.z > 0.0 and v.z > 0.0 else 0.0


@variant("poulin_fournier_value")
def poulin_fournier_value_eight(
    l: Direction, v: Direction, spread: Spread, specular: UnitInterval, exponent: Exponent
) -> f32:
    """Reflectance of satin per steradian with a coarser highlight: 8 nodes instead of 12.

    l         direction to the light, in the local frame
    v         direction to the viewer, in the local frame
    spread    half angle of each cylinder's arc, in radians
    specular  share of the light that facets of the cylinders reflect; the rest is diffuse
    exponent  p, sharpness of the facets
    returns   as poulin_fournier_value; the highlight is 0.14 percent of its mean (root mean square) and 5e-4
              of its peak off
    form      two thirds of the nodes, within 3.5 instead of 4.5 deviations of the peak
    source    as poulin_fournier_value
    """
    edge = arc_normal(spread)
    seen_l = satin_visible(l, spread, edge)
    seen_v = satin_visible(v, spread, edge)
    visible = vec2(max(seen_l.x, seen_v.x), min(seen_l.y, seen_v.y))
    pitch = 2.0 * edge.y
    seen = min(satin_highlight_eight(l, v, visible, exponent) / max(pitch * min(l.z, v.z), TINY_SQUARE), 1.0)
    highlight = blinn_phong_scale(exponent) * seen / max(max(l.z, v.z), LEAST_HEIGHT)
    value = max(1.0 - specular, 0.0) * satin_diffuse(l, v, visible, pitch) + specular * highlight
    return value if l.z > 0.0 and v.z > 0.0 else 0.0
