"""Direction to paraboloid map coordinates."""

from shaderlib.domains import Direction
from shaderlib.lang import max, vec2

# Smallest 1 + w.z divided by: within 1.4e-3 rad of the pole w = (0, 0, -1) coordinates stay below 710.
SMALLEST_DEPTH = 1.0e-6


def parabolic_uv(w: Direction) -> vec2:
    """Texture coordinates of a direction in a paraboloid map around +z.

    w           direction
    returns     w.xy / (2 (1 + w.z)) + 1/2; the half w.z >= 0 fills the disc around (1/2, 1/2) of radius 1/2,
                the other half lies outside
    degenerate  1 + w.z below 1e-6: w.xy 5e5 + 1/2, so the pole w = (0, 0, -1) is at (1/2, 1/2)
    form        for w.z < 0 the depth 1 + w.z is (w.x^2 + w.y^2) / (1 - w.z): the sum itself has lost all
                digits near the pole, and multiplies the rounding of the length of w
    source      Heidrich and Seidel 1998, View-independent Environment Maps
    """
    below = (w.x * w.x + w.y * w.y) / (1.0 + max(-w.z, 0.0))
    depth = 1.0 + w.z if w.z >= 0.0 else below
    return (0.5 / max(depth, SMALLEST_DEPTH)) * w.xy + vec2(0.5)
