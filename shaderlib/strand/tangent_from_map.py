"""Tangent of a brushed surface from a texture."""

from shaderlib.constants import TINY_SQUARE
from shaderlib.direction.frame_from_tangent import (
    frame_from_tangent,
    frame_from_tangent_apart,
    frame_from_tangent_orthogonal,
)
from shaderlib.domains import Direction, MapTangent
from shaderlib.lang import dot, inverse_sqrt, max, variant, vec2, vec3
from shaderlib.numeric.safe_normalize import SCALE_UP


def tangent_from_map(n: Direction, t: Direction, map_tangent: MapTangent) -> vec3:
    """Per-pixel strand tangent of a brushed surface.

    n            surface normal
    t            tangent of the surface, along the first texture coordinate
    map_tangent  texel of a tangent map, decoded to [-1, 1] per component, in the frame (T, n x T, n) with
                 T = normalize(t - (t.n) n)
    returns      the texel's direction in the surface, a unit vector orthogonal to n
    degenerate   texel without x and y: T; t along n: as frame_from_tangent
    form         Gram-Schmidt of m = x T + y B + z n against n leaves x T + y B, so z is never added and
                 subtracted again. T and B are orthogonal unit vectors: the two coordinates are normalised
                 instead of the sum, with one exact power of two against vanishing squares
    source       Isidoro and Brennan 2002, Per-Pixel Strand Based Anisotropic Lighting
    """
    frame = frame_from_tangent(n, t)
    texel = SCALE_UP * vec2(map_tangent.x, map_tangent.y)
    squared = dot(texel, texel)
    unit = inverse_sqrt(max(squared, TINY_SQUARE)) * texel if squared > TINY_SQUARE else vec2(1.0, 0.0)
    return unit.x * frame.tangent + unit.y * frame.bitangent


@variant("tangent_from_map")
def tangent_from_map_apart(n: Direction, t: Direction, map_tangent: MapTangent) -> vec3:
    """Per-pixel strand tangent of a brushed surface, for tangents that are well off the normal.

    n            surface normal
    t            tangent of the surface, along the first texture coordinate; from 1e-3 rad off the line of n
    map_tangent  texel of a tangent map, decoded to [-1, 1] per component, as tangent_from_map
    returns      the texel's direction in the surface, a unit vector orthogonal to n
    degenerate   texel without x and y: T; t along n: the zero vector or a rounded direction
    form         tangent_from_map over frame_from_tangent_apart
    source       Isidoro and Brennan 2002, Per-Pixel Strand Based Anisotropic Lighting
    """
    frame = frame_from_tangent_apart(n, t)
    texel = SCALE_UP * vec2(map_tangent.x, map_tangent.y)
    squared = dot(texel, texel)
    unit = inverse_sqrt(max(squared, TINY_SQUARE)) * texel if squared > TINY_SQUARE else vec2(1.0, 0.0)
    return unit.x * frame.tangent + unit.y * frame.bitangent


@variant("tangent_from_map")
def tangent_from_map_orthogonal(n: Direction, t: Direction, map_tangent: MapTangent) -> vec3:
    """Per-pixel strand tangent of a brushed surface, for tangents that are orthogonal to the normal already.

    n            surface normal
    t            tangent of the surface, along the first texture coordinate; orthogonal to n
    map_tangent  texel of a tangent map, decoded to [-1, 1] per component, as tangent_from_map
    returns      the texel's direction in the surface, a unit vector orthogonal to n
    degenerate   texel without x and y: t; t not orthogonal to n: off by n.t
    form         tangent_from_map over frame_from_tangent_orthogonal
    source       Isidoro and Brennan 2002, Per-Pixel Strand Based Anisotropic Lighting
    """
    frame = frame_from_tangent_orthogonal(n, t)
    texel = SCALE_UP * vec2(map_tangent.x, map_tangent.y)
    squared = dot(texel, texel)
    unit = inverse_sqrt(max(squared, TINY_SQUARE)) * texel if squared > TINY_SQUARE else vec2(1.0, 0.0)
    return unit.x * frame.tangent + unit.y * frame.bitangent
