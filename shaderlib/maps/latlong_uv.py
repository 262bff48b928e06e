"""Direction to latitude-longitude map coordinates."""

from shaderlib.domains import Direction
from shaderlib.lang import length, vec2
from shaderlib.numeric.turn_of import turn_of


def latlong_uv(w: Direction) -> vec2:
    """Texture coordinates of a direction in a latitude-longitude map with y up.

    w           direction
    returns     (1/2 + atan2(w.x, -w.z) / (2 pi), atan2(length(w.xz), w.y) / pi), in [0, 1]^2: v = 0 at the
                top, u = 1/2 toward -z, u growing toward +x
    degenerate  poles, w.x = w.z = 0: u = 1/2; seam, w.x = 0 and w.z > 0: u = 1
    form        turn_of measures angles as shares of a turn, with a value at the origin and for every zero;
                the built-in atan2 has neither, and WGSL promises it to 4096 ulp. acos(w.y) would lose half of
                the digits at the poles
    source      usual equirectangular map
    """
    return vec2(0.5 + turn_of(w.x, -w.z), 2.0 * turn_of(length(vec2(w.x, w.z)), w.y))
