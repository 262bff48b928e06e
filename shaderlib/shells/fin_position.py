"""Position of a fin vertex."""

from shaderlib.domains import Direction, UnitInterval
from shaderlib.lang import vec3
from shaderlib.shells.shell_offset import CoatLength, Position


def fin_position(position: Position, n: Direction, w: UnitInterval, coat_length: CoatLength) -> vec3:
    """Position of a fin vertex: an edge of the mesh is drawn as a quad, once with w = 0 and once with w =
    1.

    position     vertex of the edge, in scene units
    n            surface normal at that vertex
    w            0 at the skin, 1 at the top of the coat; also the fin texture's second coordinate
    coat_length  length of the hairs, in scene units
    returns      position + w coat_length n
    form         w is an attribute of its own: as homogeneous coordinate, 0 would send the vertex to
                 infinity
    source       Romanick 2010, VGP352 week 6, "Shells and Fins"; Lengyel et al. 2001
    """
    return position + w * coat_length * n
