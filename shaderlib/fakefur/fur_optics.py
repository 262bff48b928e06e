"""The optical properties of a fur coat."""

from shaderlib.domains import Colour, Cosine, Exponent, UnitInterval
from shaderlib.lang import struct


@struct
class FurOptics:
    """How the hairs of a coat reflect, transmit and shadow.

    k_diffuse     diffuse colour of a hair
    k_specular    colour of the highlight
    exponent      exponent of the highlight
    rho_reflect   share of the light that a hair sends back (light and viewer on one side of it)
    rho_transmit  share of the light that a hair lets through (light behind it)
    rho_surface   strength of the shadow that the body casts on its own coat; 0 for none
    cos_dark      n.l at which that shadow is total
    cos_lit       n.l at which that shadow starts; cos_dark < cos_lit
    overlap       largest share of its light that a hair loses to the hairs above it; 0.5 by default
    """

    k_diffuse: Colour
    k_specular: Colour
    exponent: Exponent
    rho_reflect: UnitInterval
    rho_transmit: UnitInterval
    rho_surface: UnitInterval
    cos_dark: Cosine
    cos_lit: Cosine
    overlap: UnitInterval
