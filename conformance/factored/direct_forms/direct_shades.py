"""What factored shades stand for, computed directly: same directions, same scale, same cosine."""

from shaderlib.direction.half_vector import half_vector
from shaderlib.domains import Cosine, Direction, Exponent, UnitInterval
from shaderlib.factored.domains import FactorScale
from shaderlib.lang import f32, max, sqrt, vec3
from shaderlib.lobes.domains import Spread
from shaderlib.lobes.poulin_fournier_value import poulin_fournier_value, poulin_fournier_value_eight
from shaderlib.strand.strand_specular import strand_specular
from shaderlib.strand.strand_specular_half import strand_specular_half


def direct_half(
    l: Direction, v: Direction, scale: FactorScale, diffuse: UnitInterval, exponent: Exponent
) -> vec3:
    """A lobe of the half vector over a constant."""
    lobe = strand_specular_half(vec3(1.0, 0.0, 0.0), half_vector(l, v), exponent)
    return max(l.z, 0.0) * ((diffuse + (1.0 - diffuse) * lobe) * scale)


def direct_strand(
    l: Direction, v: Direction, scale: FactorScale, diffuse: UnitInterval, exponent: Exponent
) -> vec3:
    """A strand's lobe over a constant."""
    lobe = strand_specular(vec3(1.0, 0.0, 0.0), l, v, exponent)
    return max(l.z, 0.0) * ((diffuse + (1.0 - diffuse) * lobe) * scale)


def direct_satin(
    l: Direction, v: Direction, scale: FactorScale, spread: Spread, specular: UnitInterval, exponent: Exponent
) -> vec3:
    """Satin of Poulin and Fournier with 12 nodes."""
    return max(l.z, 0.0) * (poulin_fournier_value(l, v, spread, specular, exponent) * scale)


def direct_satin_eight(
    l: Direction, v: Direction, scale: FactorScale, spread: Spread, specular: UnitInterval, exponent: Exponent
) -> vec3:
    """Satin of Poulin and Fournier with 8 nodes."""
    return max(l.z, 0.0) * (poulin_fournier_value_eight(l, v, spread, specular, exponent) * scale)


def direct_cosine(cos_l: Cosine, cos_v: Cosine) -> f32:
    """The strand cosine of two cosines: a sum of two products."""
    sines = (1.0 - cos_l * cos_l) * (1.0 - cos_v * cos_v)
    return sqrt(max(sines, 0.0)) - cos_l * cos_v
