"""Direction to octahedral map coordinates."""

from shaderlib.domains import Direction
from shaderlib.lang import abs, clamp, max, vec2
from shaderlib.maps.octahedral_fold import octahedral_fold


def octahedral_encode(w: Direction) -> vec2:
    """Texture coordinates of a direction in an octahedral map.

    w        direction
    returns  point of [0, 1]^2; w = (0, 0, 1) is the centre, (0, 0, -1) the corner (1, 1)
    form     with p = w.xy / (|x| + |y| + |z|) the lower half folds to (1 - |p.yx|) s(p), which is
             (w.xy + s |z|) / (|x| + |y| + |z|): no subtraction from 1, one division for both halves
    source   Meyer, Suessmuth, Sussner, Stamminger and Greiner 2010, On Floating-Point Normal Vectors
    """
    p = octahedral_fold(w.xy, max(-w.z, 0.0))
    k = 0.5 / (abs(w.x) + abs(w.y) + abs(w.z))
    return clamp(k * p + vec2(0.5), vec2(0.0), vec2(1.0))
