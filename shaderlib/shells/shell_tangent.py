"""Direction of the hair on a shell."""

from shaderlib.constants import TINY_SQUARE
from shaderlib.domains import Direction, UnitInterval
from shaderlib.lang import dot, helper, inverse_sqrt, max, vec3
from shaderlib.numeric.safe_normalize import safe_normalize
from shaderlib.shells.shell_offset import Bend


@helper
def shell_tangent(n: Direction, height: UnitInterval, comb: Bend, force: Bend) -> vec3:
    """Tangent of a combed and bent hair where it passes a shell, root to tip.

    n           surface normal
    height      height of the shell as a share of the length, see shell_height
    comb        direction in which the coat is combed, times its strength
    force       bending force per stiffness
    returns     unit vector along the curve on which shell_offset moves as the height grows
    degenerate  n + height comb + height^2 force = 0: the way that changes, comb + 2 height force;
                the curve stops there: n
    form        with a = n + height comb + height^2 force and u = a / |a|, the curve is height u and its
                derivative u + height (a' - u (u.a')) / |a|
    source      derived for this library
    """
    a = n + height * (comb + height * force)
    change = comb + 2.0 * height * force
    shrink = inverse_sqrt(max(dot(a, a), TINY_SQUARE))
    u = a * shrink
    return safe_normalize(u + height * shrink * (change - u * dot(u, change)), n)
