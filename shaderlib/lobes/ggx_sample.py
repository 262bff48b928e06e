"""GGX lobe: sampler."""

from shaderlib.direction.mirror import mirror
from shaderlib.domains import Direction
from shaderlib.lang import dot, max, normalize, sqrt, vec3
from shaderlib.lobes.domains import Roughness, UniformPair
from shaderlib.sampling.unit_circle import unit_circle

# Makes the normal horizontal where nothing else decides it: for v straight from below. Its square is an
# ordinary float, and it is far below the rounding of any other normal. It is added away from 0, so that the
# normal cannot vanish.
TINY_SLOPE = 1.0e-18


def ggx_sample(u: UniformPair, v: Direction, alpha_x: Roughness, alpha_y: Roughness) -> vec3:
    """Direction to the light, drawn with density ggx_pdf: v mirrored about a visible normal.

    u           pair of uniform numbers in [0, 1); u.y = 0 is the middle of the visible normals
    v           direction to the viewer, in the local frame
    alpha_x     width along the tangent
    alpha_y     width along the bitangent
    returns     unit vector, possibly below the horizon. The weight value l.z / pdf is at most 1:
                l.z (v.z + S(v)) / (l.z S(v) + v.z S(l)), S = ggx_stretch
    degenerate  v.z <= 0: the normals visible from there; straight from below, l = -v
    form        in the space where the surface is a hemisphere, visible normals are a uniform spherical cap
                plus the view direction V. Written with a = u.y (1 + V.z): sine sqrt(a (2 - a)) and height (1
                - u.y) (1 + V.z), so nothing cancels and the height is never 0. The result is a unit vector up
                to rounding, of which r (3 - r.r) / 2 leaves the square
    source      Dupuy and Benyoub 2023, Sampling Visible GGX Normals with Spherical Caps
    """
    w = normalize(vec3(alpha_x * v.x, alpha_y * v.y, v.z))
    below = (w.x * w.x + w.y * w.y) / (1.0 + max(-w.z, 0.0))
    depth = 1.0 + w.z if w.z >= 0.0 else below
    a = u.y * depth
    cap = sqrt(max(a * (2.0 - a), 0.0)) * unit_circle(u.x)
    slope = alpha_x * (cap.x + w.x)
    x = slope + TINY_SLOPE if slope >= 0.0 else slope - TINY_SLOPE
    y = alpha_y * (cap.y + w.y)
    h = normalize(vec3(x, y, (1.0 - u.y) * depth))
    r = mirror(v, h)
    return (1.5 - 0.5 * dot(r, r)) * r
