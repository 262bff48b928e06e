"""Normal of a fin."""

from typing import Annotated

from shaderlib.constants import TINY_SQUARE
from shaderlib.direction.frame_from_normal import frame_from_normal
from shaderlib.domains import Direction
from shaderlib.lang import Length, dot, inverse_sqrt, max, variant, vec3
from shaderlib.numeric.safe_normalize import safe_normalize, safe_normalize_dot


def fin_normal(edge: Annotated[vec3, Length(1.0e-6, 1.0e6)], n: Direction) -> vec3:
    """Normal of the fin that stands on an edge of the mesh.

    edge        difference of the two vertices of the edge, of any length
    n           surface normal
    returns     unit vector along edge x n
    degenerate  edge = 0: a unit vector perpendicular to n; edge parallel to n: any unit vector
    form        one cross product; its direction is as good as the edge is far from n, about 1e-7 /
                sin(edge, n). Written out, because OpenCL promises its built-in to the longest component only
    source      Lengyel et al. 2001, Real-Time Fur over Arbitrary Surfaces
    """
    across = vec3(
        edge.y * n.z - edge.z * n.y,
        edge.z * n.x - edge.x * n.z,
        edge.x * n.y - edge.y * n.x,
    )
    return safe_normalize(across, frame_from_normal(n).tangent)


@variant("fin_normal")
def fin_normal_dot(edge: Annotated[vec3, Length(1.0e-6, 1.0e6)], n: Direction) -> vec3:
    """Normal of the fin that stands on an edge of ordinary length.

    edge        difference of the two vertices of the edge, of length 1e-6 to 1e6
    n           surface normal
    returns     unit vector along edge x n
    degenerate  edge = 0: a unit vector perpendicular to n; edge parallel to n: any unit vector
    form        fin_normal without the scaling for extreme lengths
    source      Lengyel et al. 2001, Real-Time Fur over Arbitrary Surfaces
    """
    across = vec3(
        edge.y * n.z - edge.z * n.y,
        edge.z * n.x - edge.x * n.z,
        edge.x * n.y - edge.y * n.x,
    )
    return safe_normalize_dot(across, frame_from_normal(n).tangent)


@variant("fin_normal")
def fin_normal_apart(edge: Annotated[vec3, Length(1.0e-6, 1.0e6)], n: Direction) -> vec3:
    """Normal of the fin that stands on an edge well off the surface normal.

    edge        difference of the two vertices of the edge, of length 1e-6 to 1e6
    n           surface normal
    returns     unit vector along edge x n
    degenerate  edge = 0 or parallel to n: the zero vector or a rounded direction
    form        no frame to fall back to
    source      Lengyel et al. 2001, Real-Time Fur over Arbitrary Surfaces
    """
    across = vec3(
        edge.y * n.z - edge.z * n.y,
        edge.z * n.x - edge.x * n.z,
        edge.x * n.y - edge.y * n.x,
    )
    return inverse_sqrt(max(dot(across, across), TINY_SQUARE)) * across
