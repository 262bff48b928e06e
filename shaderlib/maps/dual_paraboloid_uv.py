"""Direction to dual-paraboloid map coordinates."""

from shaderlib.domains import Direction
from shaderlib.lang import abs, clamp, vec2
from shaderlib.maps.domains import Border
from shaderlib.maps.dual_paraboloid import DualParaboloid


def dual_paraboloid_uv(w: Direction, border: Border) -> DualParaboloid:
    """Place of a direction in a dual-paraboloid map: two discs, around +z and around -z.

    w        direction
    border   half side of each square in units of the disc radius, at least 1; 1.2 leaves a rim for filtering
    returns  uv = w.xy / (2 border (1 + |w.z|)) + 1/2, in [0, 1]; back = 1 for w.z < 0, else 0
    form     1 + |w.z| is never below 1, and the half is chosen by comparison: the sign of a zero is not
             portable. One division; the clamp only removes a last bit at the edge
    source   Heidrich and Seidel 1998, View-independent Environment Maps; border: Blythe 1999
    """
    k = 0.5 / (border * (1.0 + abs(w.z)))
    uv = clamp(k * w.xy + vec2(0.5), vec2(0.0), vec2(1.0))
    return DualParaboloid(uv, 1.0 if w.z < 0.0 else 0.0)
