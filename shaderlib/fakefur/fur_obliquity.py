"""Growth of a coat's optical depth with the direction of view."""

from shaderlib.direction.sin_angle import sin_angle, sin_angle_cross, sin_angle_half
from shaderlib.domains import Direction
from shaderlib.lang import dot, f32, max, variant

# Cosine below which a direction counts as grazing. It keeps quotients finite, and it is small enough that
# the depth of any visible coat has reached its limit of 1e9 there.
GRAZING = 1.0e-12


def fur_obliquity(t: Direction, n: Direction, w: Direction) -> f32:
    """Ratio of a coat's optical depth along w to the hair area that stands on a unit of skin.

    t           hair direction
    n           surface normal
    w           direction to the light or to the viewer
    returns     g = sin(w, t) / w.n, in [0, 1e12]: hairs seen end-on hide little, oblique paths meet more
                hairs
    degenerate  w.n <= 0 counts as 1e-12; w = t and w = -t give 0
    form        sine from the sum and the difference of the vectors, see sin_angle; the sharp limit instead
                of a skipped division keeps the coat opaque at the silhouette. The relative error grows like
                1e-7 / w.n
    source      Goldman 1997, Fake Fur Rendering; Romanick 2010, VGP352 week 6, "Fur Opacity"
    """
    return sin_angle(w, t) / max(dot(w, n), GRAZING)


@variant("fur_obliquity")
def fur_obliquity_half(t: Direction, n: Direction, w: Direction) -> f32:
    """Ratio of a coat's optical depth along w to the hair area below it, for w off the hairs.

    t           hair direction
    n           surface normal
    w           direction to the light or to the viewer
    returns     g = sin(w, t) / w.n, in [0, 1e12]
    degenerate  w.n <= 0 counts as 1e-12
    form        fur_obliquity with sin_angle_half
    source      Goldman 1997, Fake Fur Rendering; sin_angle_half
    """
    return sin_angle_half(w, t) / max(dot(w, n), GRAZING)


@variant("fur_obliquity")
def fur_obliquity_cross(t: Direction, n: Direction, w: Direction) -> f32:
    """Ratio of a coat's optical depth along w to the hair area below it, for w off the hairs.

    t           hair direction
    n           surface normal
    w           direction to the light or to the viewer
    returns     g = sin(w, t) / w.n, in [0, 1e12]
    degenerate  w.n <= 0 counts as 1e-12
    form        fur_obliquity with sin_angle_cross
    source      Goldman 1997, Fake Fur Rendering; sin_angle_cross
    """
    return sin_angle_cross(w, t) / max(dot(w, n), GRAZING)
