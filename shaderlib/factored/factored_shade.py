"""Factored reflectance: products of textures of one direction each."""

from shaderlib.direction.half_vector import half_vector
from shaderlib.domains import Direction
from shaderlib.factored.across_share import across_share
from shaderlib.factored.angle_table_lookup import angle_table_lookup
from shaderlib.factored.domains import AngleTable, FactorMap, FactorScale
from shaderlib.factored.strand_table_uv import strand_table_uv
from shaderlib.lang import lookup, max, vec2, vec3
from shaderlib.maps.parabolic_uv import parabolic_uv


def factored_shade(p: FactorMap, q: FactorMap, l: Direction, v: Direction, scale: FactorScale) -> vec3:
    """Light from one direction that a factored reflectance sends to the viewer, for light of 1.

    p           factor of the directions to light and viewer, over parabolic_uv
    q           factor of the half vector, over parabolic_uv
    l           direction to the light, in the local frame: x tangent, y bitangent, z normal
    v           direction to the viewer, in the local frame
    scale       what the product is multiplied by, per channel
    returns     scale p(v) q(h) p(l) max(l.z, 0), linear RGB
    degenerate  l.z <= 0: 0. v.z <= 0, which an interpolated normal may cause: the edge of p goes on, and
                nothing jumps. l = -v: the half vector is half_vector's, and the value is 0 unless v.z < 0
    form        two lookups in p and one in q; they need no levels where a texel is smaller than the highlight
    source      McCool, Ang and Ahmad 2001, Homomorphic Factorization of BRDFs for High-Performance Rendering
    """
    sides = lookup(p, parabolic_uv(v)).xyz * lookup(p, parabolic_uv(l)).xyz
    product = sides * lookup(q, parabolic_uv(half_vector(l, v))).xyz
    return max(l.z, 0.0) * (scale * product)


def factored_strand_shade(
    p: FactorMap, q: FactorMap, r: AngleTable, l: Direction, v: Direction, scale: FactorScale
) -> vec3:
    """Light from one direction that a reflectance in four factors sends to the viewer, for light of 1.

    p           factor of the directions to light and viewer, over parabolic_uv
    q           factor of the half vector, over parabolic_uv
    r           factor of the cosines with the tangent, over strand_table_uv, its ends at texel centres
    l           direction to the light, in the local frame: x tangent, y bitangent, z normal
    v           direction to the viewer, in the local frame
    scale       what the product is multiplied by, per channel
    returns     scale p(v) q(h) p(l) r(t.l, t.v) max(l.z, 0), linear RGB
    degenerate  as factored_shade
    form        a strand's highlight is a function of t.l and t.v and of no other single direction: without
                r it cannot be fitted better than to 11 percent, however many texels p and q have
    source      McCool, Ang and Ahmad 2001; the factor r: this library
    """
    return angle_table_lookup(r, strand_table_uv(l.x, v.x)).xyz * factored_shade(p, q, l, v, scale)


def factored_satin_shade(
    p: FactorMap, q: FactorMap, r: AngleTable, l: Direction, v: Direction, scale: FactorScale
) -> vec3:
    """Light from one direction that cloth in four factors sends to the viewer, for light of 1.

    p           factor of the directions to light and viewer, over parabolic_uv
    q           factor of the half vector, over parabolic_uv
    r           factor of the angles of light and viewer about the tangent, atan2(w.y, w.z) / pi + 1/2, its
                ends at texel centres
    l           direction to the light, in the local frame: x tangent, y bitangent, z normal
    v           direction to the viewer, in the local frame
    scale       what the product is multiplied by, per channel
    returns     scale p(v) q(h) p(l) r(angles) max(l.z, 0), linear RGB
    degenerate  as factored_shade; light or viewer along the tangent: the middle of r's axis
    form        parallel threads hide part of each other from light and viewer, how much is a function of both
                angles about them: with r the fit to poulin_fournier_value errs by 8 percent instead of 22
    source      McCool, Ang and Ahmad 2001; the factor r: this library
    """
    turned = angle_table_lookup(r, vec2(across_share(l), across_share(v))).xyz
    return turned * factored_shade(p, q, l, v, scale)
