"""Hermite step that is defined for every order of its edges."""

from typing import Annotated

from shaderlib.constants import SMALLEST_NORMAL
from shaderlib.lang import Interval, abs, clamp, f32, max, min, variant

# Narrowest step of the variants; 2e4 divided by it is still finite.
NARROWEST_STEP = 1.0e-30

# Slope of the straight line through (1/2, 1/2) that stays closest to the step once clamped: 0.0308.
RAMP_SLOPE = 1.26619947  # 3fa212d3
RAMP_START = 0.5 - 0.5 * RAMP_SLOPE


def safe_smoothstep(
    edge0: Annotated[f32, Interval(-1.0e4, 1.0e4)],
    edge1: Annotated[f32, Interval(-1.0e4, 1.0e4)],
    x: Annotated[f32, Interval(-1.0e4, 1.0e4)],
) -> f32:
    """Smooth step from 0 at edge0 to 1 at edge1, in either order.

    edge0       where the result is 0
    edge1       where the result is 1; may lie below edge0, then the step descends
    x           where to evaluate
    returns     s s (3 - 2 s) with s = (x - edge0) / (edge1 - edge0) clamped to [0, 1]
    degenerate  edges equal (closer than 1.2e-38): 0 for x below edge0, 1 at and above it
    form        the way from edge0 is clamped to the width before the division, which therefore cannot
                overflow, and the width is positive by itself, so no compiler meets a division by 0. The
                built-in is undefined for edge0 >= edge1 in GLSL and indeterminate for equal edges in WGSL
    source      GLSL specification, smoothstep; the cases that it leaves open are decided here
    """
    width = edge1 - edge0
    size = max(abs(width), SMALLEST_NORMAL)
    travelled = clamp(x - edge0 if width > 0.0 else edge0 - x, 0.0, size)
    s = min(travelled / size, 1.0)
    hard = 0.0 if x < edge0 else 1.0
    return s * s * (3.0 - 2.0 * s) if abs(width) >= SMALLEST_NORMAL else hard


@variant("safe_smoothstep")
def safe_smoothstep_rising(
    edge0: Annotated[f32, Interval(-1.0e4, 1.0e4)],
    edge1: Annotated[f32, Interval(-1.0e4, 1.0e4)],
    x: Annotated[f32, Interval(-1.0e4, 1.0e4)],
) -> f32:
    """Smooth step from 0 at edge0 to 1 at edge1, for edge0 < edge1.

    edge0       where the result is 0
    edge1       where the result is 1; above edge0
    x           where to evaluate
    returns     s s (3 - 2 s) with s = (x - edge0) / (edge1 - edge0) clamped to [0, 1]
    degenerate  edges equal or descending: a hard step that rises at edge0
    form        one guard for both, in the divisor
    source      GLSL specification, smoothstep
    """
    s = clamp((x - edge0) / max(edge1 - edge0, NARROWEST_STEP), 0.0, 1.0)
    return s * s * (3.0 - 2.0 * s)


@variant("safe_smoothstep")
def safe_smoothstep_ramp(
    edge0: Annotated[f32, Interval(-1.0e4, 1.0e4)],
    edge1: Annotated[f32, Interval(-1.0e4, 1.0e4)],
    x: Annotated[f32, Interval(-1.0e4, 1.0e4)],
) -> f32:
    """Straight step in place of the smooth one, for edge0 < edge1: 0.031 off, with corners.

    edge0       lower edge
    edge1       upper edge; above edge0
    x           where to evaluate
    returns     clamp(1/2 + 1.266 (s - 1/2), 0, 1) with s = (x - edge0) / (edge1 - edge0)
    degenerate  edges equal or descending: a hard step that rises at edge0
    form        steeper than the line between the edges, which is 0.0963 off: its ends lie inside them
    source      fitted for this library
    """
    s = (x - edge0) / max(edge1 - edge0, NARROWEST_STEP)
    return clamp(RAMP_START + RAMP_SLOPE * s, 0.0, 1.0)
