"""The frame of a combed surface."""

from shaderlib.constants import TINY_SQUARE
from shaderlib.direction.doubled_cross import doubled_cross
from shaderlib.direction.frame import Frame
from shaderlib.direction.frame_from_normal import frame_from_normal
from shaderlib.domains import Direction
from shaderlib.lang import cross, dot, inverse_sqrt, max, variant
from shaderlib.numeric.safe_normalize import safe_normalize_dot


def frame_from_tangent(n: Direction, t: Direction) -> Frame:
    """Right-handed frame with the normal n and, as far as that allows, the tangent t.

    n           normal, kept as it is
    t           wanted tangent; only its part across n counts
    returns     frame with tangent = normalize(t - (t.n) n) and bitangent = n x tangent
    degenerate  t on the line of n, to 1e-18 rad: frame_from_normal(n)
    form        the bitangent first: n x t = (n - t) x (n + t) / 2 keeps its relative accuracy for t close to
                n, where t - (t.n) n cancels; the tangent is then a product of orthogonal unit vectors
    source      Gram-Schmidt; form derived for this library
    """
    bitangent = safe_normalize_dot(doubled_cross(n, t), frame_from_normal(n).bitangent)
    return Frame(cross(bitangent, n), bitangent, n)


@variant("frame_from_tangent")
def frame_from_tangent_apart(n: Direction, t: Direction) -> Frame:
    """Right-handed frame with the normal n and the tangent t, for tangents that are well off the normal.

    n           normal, kept as it is
    t           wanted tangent, from 1e-3 rad off the line of n; only its part across n counts
    returns     frame with tangent = normalize(t - (t.n) n) and bitangent = n x tangent
    degenerate  t on the line of n: tangent and bitangent are zero or rounded directions
    form        n x t as it stands, and no frame to fall back to
    source      Gram-Schmidt
    """
    across = cross(n, t)
    bitangent = inverse_sqrt(max(dot(across, across), TINY_SQUARE)) * across
    return Frame(cross(bitangent, n), bitangent, n)


@variant("frame_from_tangent")
def frame_from_tangent_orthogonal(n: Direction, t: Direction) -> Frame:
    """Right-handed frame of a normal and a tangent that are orthogonal already.

    n           normal, kept as it is
    t           tangent, orthogonal to n; kept as it is
    returns     frame with bitangent = n x t
    degenerate  t not orthogonal to n: tangent off by n.t, bitangent too short
    form        one outer product, nothing normalised
    source      elementary
    """
    return Frame(t, cross(n, t), n)
