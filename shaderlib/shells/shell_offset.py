"""Position of a shell vertex."""

from typing import Annotated

from shaderlib.domains import Direction, UnitInterval
from shaderlib.lang import Interval, Length, f32, variant, vec3
from shaderlib.numeric.safe_normalize import safe_normalize, safe_normalize_dot, safe_normalize_nonzero

# A position, in scene units.
Position = Annotated[vec3, Interval(-1.0e3, 1.0e3)]

# Length of a coat, in scene units.
CoatLength = Annotated[f32, Interval(0.0, 1.0e2, scale="log")]

# Displacement of the hair tips, relative to the length of the hair.
Bend = Annotated[vec3, Length(0.0, 4.0)]


def shell_offset(
    position: Position, n: Direction, coat_length: CoatLength, height: UnitInterval, comb: Bend, force: Bend
) -> vec3:
    """Position of a vertex on the shell at a height above the skin, with combed and bent hairs.

    position     vertex on the skin, in scene units
    n            surface normal
    coat_length  length of the hairs, in scene units
    height       height of the shell as a share of the length, see shell_height
    comb         direction in which the coat is combed, times its strength (1 leans the tips by 45 degrees)
    force        bending force (gravity, wind) per stiffness; grows with the square of the height
    returns      position + coat_length height unit(n + height comb + height^2 force), never farther away
                 than coat_length
    degenerate   n + height comb + height^2 force = 0: along n
    form         the direction is normalised, so hairs bend but do not stretch
    source       Lengyel et al. 2001, Real-Time Fur over Arbitrary Surfaces
    """
    along = n + height * (comb + height * force)
    return position + coat_length * height * safe_normalize(along, n)


@variant("shell_offset")
def shell_offset_dot(
    position: Position, n: Direction, coat_length: CoatLength, height: UnitInterval, comb: Bend, force: Bend
) -> vec3:
    """Position of a vertex on the shell at a height above the skin, with hairs of ordinary bends.

    position     vertex on the skin, in scene units
    n            surface normal
    coat_length  length of the hairs, in scene units
    height       height of the shell as a share of the length, see shell_height
    comb         direction in which the coat is combed, times its strength
    force        bending force per stiffness; grows with the square of the height
    returns      position + coat_length height unit(n + height comb + height^2 force)
    degenerate   n + height comb + height^2 force = 0, to 3e-19: along n
    form         shell_offset with safe_normalize_dot
    source       Lengyel et al. 2001, Real-Time Fur over Arbitrary Surfaces
    """
    along = n + height * (comb + height * force)
    return position + coat_length * height * safe_normalize_dot(along, n)


@variant("shell_offset")
def shell_offset_nonzero(
    position: Position, n: Direction, coat_length: CoatLength, height: UnitInterval, comb: Bend, force: Bend
) -> vec3:
    """Position of a vertex on the shell at a height above the skin, with hairs that keep a direction.

    position     vertex on the skin, in scene units
    n            surface normal
    coat_length  length of the hairs, in scene units
    height       height of the shell as a share of the length, see shell_height
    comb         direction in which the coat is combed, times its strength
    force        bending force per stiffness; grows with the square of the height
    returns      position + coat_length height unit(n + height comb + height^2 force)
    degenerate   n + height comb + height^2 force = 0: the vertex stays
    form         shell_offset with safe_normalize_nonzero
    source       Lengyel et al. 2001, Real-Time Fur over Arbitrary Surfaces
    """
    along = n + height * (comb + height * force)
    return position + coat_length * height * safe_normalize_nonzero(along, n)
