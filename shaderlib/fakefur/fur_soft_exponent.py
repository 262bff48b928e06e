"""Exponent of a highlight over disordered hairs."""

from typing import Annotated

from shaderlib.domains import Cosine, Exponent
from shaderlib.lang import Interval, f32


def fur_soft_exponent(
    exponent: Exponent, variance: Annotated[f32, Interval(0.0, 999.0, scale="log")], azimuth_cosine: Cosine
) -> f32:
    """Exponent of the strand highlight averaged over the hairs of a footprint.

    exponent        exponent p of a single hair
    variance        variance of the hair directions, see fur_average
    azimuth_cosine  kappa, cosine of the angle between light and viewer around the hair
    returns         p' = p / (1 + 2 (1 + kappa) p variance), at most p; multiply the highlight by sqrt(p' /
                    p), or it gains energy
    form            a tilt of the tangent moves the sum of the elevations of light and viewer, with variance
                    2 (1 + kappa) per unit: back-lit hairs (kappa = -1) are not softened at all, which no
                    rule without kappa can give. 1 + kappa is exact where it matters
    source          derived for this library and checked against von Mises-Fisher tangents (error of the
                    peak 0.03 at m = 0.95, 0.005 at m = 0.99); Toksvig 2005, Mipmapping Normal Maps, for
                    (n.h)^p
    """
    return exponent / (1.0 + 2.0 * (1.0 + azimuth_cosine) * exponent * variance)
