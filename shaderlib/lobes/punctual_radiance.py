"""Light from a point or a direction reflected by a lobe."""

from typing import Annotated

from shaderlib.constants import PI
from shaderlib.domains import Cosine
from shaderlib.lang import Interval, max, vec3


def punctual_radiance(
    brdf: Annotated[vec3, Interval(0.0, 1.0e8, scale="log")],
    light: Annotated[vec3, Interval(0.0, 1.0e8, scale="log")],
    n_dot_l: Cosine,
) -> vec3:
    """Radiance that a surface reflects from a point or directional light.

    brdf     reflectance of the surface per steradian, as the value functions of lobes return it
    light    colour and brightness of the light: the radiance of a white Lambert surface that faces it
    n_dot_l  cosine between normal and light
    returns  pi brdf light max(n_dot_l, 0)
    form     the factor pi makes a light of brightness 1 show a Lambert surface in its own colour
    source   Hoffman 2010, Crafting Physically Motivated Shading Models for Game Development
    """
    return (PI * max(n_dot_l, 0.0)) * (brdf * light)
