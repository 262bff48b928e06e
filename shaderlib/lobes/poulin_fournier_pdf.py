"""Poulin-Fournier lobe: density."""

from shaderlib.constants import INV_PI
from shaderlib.domains import Direction, Exponent, UnitInterval
from shaderlib.lang import f32, max
from shaderlib.lobes.domains import Spread
from shaderlib.lobes.half_jacobian import half_jacobian
from shaderlib.lobes.half_sum import half_sum
from shaderlib.lobes.satin_facet_density import satin_facet_density


def poulin_fournier_pdf(
    l: Direction, v: Direction, spread: Spread, specular: UnitInterval, exponent: Exponent
) -> f32:
    """Density with which poulin_fournier_sample draws l, per steradian.

    l         direction to the light, in the local frame
    v         direction to the viewer, in the local frame
    spread    half angle of each cylinder's arc, in radians
    specular  share of the samples that mirror v about a facet; the rest is cosine-distributed
    exponent  p, sharpness of the facets
    returns   (1 - specular) max(l.z, 0) / pi + specular density(h) / (4 |v.h|); integrates to 1 over the
              sphere, below the horizon included
    form      satin_facet_density and half_jacobian, from half_sum
    source    derived for this library
    """
    g = half_sum(l, v)
    facets = satin_facet_density(g, spread, exponent) * half_jacobian(g)
    return (1.0 - specular) * (INV_PI * max(l.z, 0.0)) + specular * facets
