"""Part of a row of parallel cylinders that a direction sees."""

from typing import Annotated

from shaderlib.constants import TWO_PI
from shaderlib.domains import Direction
from shaderlib.lang import Interval, abs, helper, max, min, sqrt, vec2
from shaderlib.lobes.domains import Spread
from shaderlib.numeric.turn_of import turn_of
from shaderlib.sampling.unit_circle import unit_circle


@helper
def satin_visible(w: Direction, spread: Spread, edge: Annotated[vec2, Interval(0.0, 1.0)]) -> vec2:
    """Interval of the arc coordinate xi, the angle of the arc's normal from z, that a direction sees.

    w        direction above the surface, in the local frame; cylinders along x
    spread   half angle of each arc, in radians
    edge     (cos(spread), sin(spread))
    returns  (lower, upper) within [-spread, spread]. On the side that w leans to, the arc ends at its own
             horizon or is blocked by the neighbour
    form     with psi the elevation of w in the plane across the cylinders, w leaning to xi > 0: lower = -psi
             and upper = eta - psi, cos(eta) = 1 - 2 sin(spread) sin(psi). Measured from the horizon, both are
             accurate as psi -> 0, where pi / 2 minus an angle is not
    source   Poulin and Fournier 1990, A Model for Anisotropic Reflection; self-blocking derived for this
             library
    """
    turns = turn_of(max(w.z, 0.0), abs(w.y))
    psi = TWO_PI * turns
    elevation = unit_circle(turns)
    rise = 2.0 * edge.y * elevation.y
    rest = 2.0 * (edge.x * edge.x / (1.0 + edge.y) + edge.y * elevation.x * elevation.x / (1.0 + elevation.y))
    eta = TWO_PI * turn_of(sqrt(max(rise * rest, 0.0)), 1.0 - rise)
    lower = -min(psi, spread)
    upper = min(eta - psi, spread) if psi < spread else spread
    return vec2(-upper, -lower) if w.y < 0.0 else vec2(lower, upper)
