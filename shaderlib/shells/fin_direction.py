"""Direction in which a fin stands on its edge."""

from shaderlib.domains import Direction
from shaderlib.lang import helper, vec3
from shaderlib.numeric.safe_normalize import safe_normalize
from shaderlib.shells.shell_offset import Bend


@helper
def fin_direction(n: Direction, comb: Bend, force: Bend) -> vec3:
    """Direction from the root of a hair to its tip, in place of the normal of fin_position.

    n           surface normal
    comb        direction in which the coat is combed, times its strength
    force       bending force per stiffness
    returns     unit vector; fin_position with w = 1 then meets the outermost shell of shell_offset
    degenerate  n + comb + force = 0: n
    source      derived for this library
    """
    return safe_normalize(n + comb + force, n)
