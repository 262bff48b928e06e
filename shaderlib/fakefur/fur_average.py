"""Average hair direction of a footprint."""

from typing import Annotated

from shaderlib.domains import Direction
from shaderlib.lang import Interval, Length, clamp, f32, length, struct, vec3
from shaderlib.numeric.safe_normalize import safe_normalize

# Shortest mean that is told apart from complete disorder; the variance is 999 there.
SHORTEST_MEAN = 1.0e-3


@struct
class FurAverage:
    """Average direction of the hairs in a footprint, and how far single hairs stray from it.

    tangent   mean hair direction
    variance  variance of a hair direction about the mean along each perpendicular axis, in radian squared
    """

    tangent: Direction
    variance: Annotated[f32, Interval(0.0, 999.0)]


def fur_average(tangent_mean: Annotated[vec3, Length(0.0, 1.0)]) -> FurAverage:
    """Average hair geometry of a footprint from the mean of its unit hair directions.

    tangent_mean  mean of unit vectors, as the filtered (mip mapped) tangent map gives it; length in [0, 1]
    returns       tangent = tangent_mean / m and variance = (1 - m) / m, with m = |tangent_mean| in [1e-3,
                  1]
    degenerate    tangent_mean = 0: tangent (0, 0, 1), variance 999
    form          the length is clamped to [1e-3, 1], so filtering noise above 1 gives variance 0
    source        a von Mises-Fisher distribution of tangents has this mean length; Toksvig 2005, Mipmapping
                  Normal Maps, uses the same measure. See fur_soft_exponent
    """
    m = clamp(length(tangent_mean), SHORTEST_MEAN, 1.0)
    return FurAverage(safe_normalize(tangent_mean, vec3(0.0, 0.0, 1.0)), (1.0 - m) / m)
