"""Shadow that a body casts on its own coat."""

from shaderlib.domains import Cosine, UnitInterval
from shaderlib.lang import f32, variant
from shaderlib.numeric.safe_smoothstep import safe_smoothstep, safe_smoothstep_ramp, safe_smoothstep_rising


def fur_surface_attenuation(
    n_dot_l: Cosine, rho_surface: UnitInterval, cos_dark: Cosine, cos_lit: Cosine
) -> f32:
    """Attenuation f_surface of hairs on the side that is turned away from the light.

    n_dot_l      cosine between surface normal and light
    rho_surface  strength of the shadow; 0 gives 1 everywhere
    cos_dark     n.l at which the shadow is total
    cos_lit      n.l at which it starts
    returns      1 for n_dot_l >= cos_lit, 1 - rho_surface for n_dot_l <= cos_dark, a smooth step between
    degenerate   cos_dark = cos_lit: a hard step, lit at the edge itself
    form         1 + rho_surface (step - 1): exactly 1 where the step is 1
    source       Goldman 1997, Fake Fur Rendering; the lecture prints smoothstep(n.l, theta_min, theta_max),
                 which has the arguments in another order and angles where cosines belong
    """
    return 1.0 + rho_surface * (safe_smoothstep(cos_dark, cos_lit, n_dot_l) - 1.0)


@variant("fur_surface_attenuation")
def fur_surface_attenuation_rising(
    n_dot_l: Cosine, rho_surface: UnitInterval, cos_dark: Cosine, cos_lit: Cosine
) -> f32:
    """Attenuation f_surface of hairs by the surface below them, for cos_dark < cos_lit.

    n_dot_l      cosine between surface normal and light
    rho_surface  strength of the shadow; 0 gives 1 everywhere
    cos_dark     n.l at which the shadow is total
    cos_lit      n.l at which it starts; above cos_dark
    returns      as fur_surface_attenuation, the same
    degenerate   cos_dark >= cos_lit: a hard step at cos_dark
    form         safe_smoothstep_rising
    source       Goldman 1997, Fake Fur Rendering
    """
    return 1.0 + rho_surface * (safe_smoothstep_rising(cos_dark, cos_lit, n_dot_l) - 1.0)


@variant("fur_surface_attenuation")
def fur_surface_attenuation_ramp(
    n_dot_l: Cosine, rho_surface: UnitInterval, cos_dark: Cosine, cos_lit: Cosine
) -> f32:
    """Attenuation f_surface of hairs by the surface below them, by a straight step, for cos_dark < cos_lit.

    n_dot_l      cosine between surface normal and light
    rho_surface  strength of the shadow; 0 gives 1 everywhere
    cos_dark     n.l at which the shadow is total
    cos_lit      n.l at which it starts; above cos_dark
    returns      as fur_surface_attenuation, within 0.031 rho_surface, with corners
    degenerate   cos_dark >= cos_lit: a hard step at cos_dark
    form         safe_smoothstep_ramp
    source       Goldman 1997, Fake Fur Rendering
    """
    return 1.0 + rho_surface * (safe_smoothstep_ramp(cos_dark, cos_lit, n_dot_l) - 1.0)
