"""Some frame around a normal."""

from shaderlib.direction.frame import Frame
from shaderlib.domains import Direction
from shaderlib.lang import vec3


def frame_from_normal(n: Direction) -> Frame:
    """Right-handed frame around n, by a fixed rule that is continuous on each of the halves z >= 0 and z < 0.

    n        normal
    returns  frame with normal n; the tangent depends on n alone
    form     one division by 1 + |n.z|, never by zero; s is chosen by comparison, because the sign of zero is
             not portable
    source   Duff, Burgess, Christensen, Hery, Kensler, Liani and Villemin 2017, Building an Orthonormal
             Basis, Revisited
    """
    s = 1.0 if n.z >= 0.0 else -1.0
    a = -1.0 / (s + n.z)
    b = n.x * n.y * a
    tangent = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x)
    bitangent = vec3(b, s + n.y * n.y * a, -n.y)
    return Frame(tangent, bitangent, n)
