"""Normal of a fin."""

from typing import Annotated

from shaderlib.direction.frame_from_normal import frame_from_normal
from shaderlib.domains import Direction
from shaderlib.lang import Length, vec3
from shaderlib.numeric.safe_normalize import safe_normalize


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
