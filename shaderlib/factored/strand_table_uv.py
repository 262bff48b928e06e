"""Cosines of light and viewer with a strand to coordinates of a table."""

from shaderlib.domains import Cosine
from shaderlib.factored.angle_share import angle_share
from shaderlib.lang import vec2


def strand_table_uv(cos_l: Cosine, cos_v: Cosine) -> vec2:
    """Coordinates of a table over the angles of light and viewer with a strand: axes warped by the arc sine.

    cos_l       t.l, cosine between the tangent and the direction to the light
    cos_v       t.v, cosine between the tangent and the direction to the viewer
    returns     (asin(cos_l), asin(cos_v)) / pi + 1/2, in [0, 1]^2. Tables have their ends at the centres of
                their outermost texels: of n by m texels look at (uv * (n - 1, m - 1) + 1/2) / (n, m), as
                strand_cosine_table does
    degenerate  cosines beyond 1 by rounding: the ends of the axes
    form        along an angle the square roots of sines are smooth: the strand cosine in 256 x 256 texels is
                off by 3.8e-5, on axes linear in the cosines by 3.1e-2
    source      Heidrich and Seidel 1998, on linear axes; the warp: this library
    """
    return vec2(angle_share(cos_l), angle_share(cos_v))
