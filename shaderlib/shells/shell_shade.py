"""Light reflected by a shell texel whose hairs stand along the normal."""

from typing import Annotated

from shaderlib.domains import Colour, Direction, Exponent, ExponentFrom8, ExponentFrom16
from shaderlib.lang import Interval, clamp, dot, f32, printed, variant, vec3
from shaderlib.numeric.pow_one_minus import pow_one_minus, pow_one_minus_cubic8, pow_one_minus_from4
from shaderlib.numeric.safe_pow import safe_pow
from shaderlib.shells.shell_sine_power import shell_sine_power

# Exponents for which the rounding of a squared cosine does not show near the hair.
ExponentFrom2 = Annotated[f32, Interval(2.0, 1.0e5, scale="log")]


def shell_shade(
    n: Direction,
    l: Direction,
    h: Direction,
    k_diffuse: Colour,
    p_diffuse: Exponent,
    k_specular: Colour,
    p_specular: Exponent,
) -> vec3:
    """Reflectance of a shell by hairs that stand along the surface normal.

    n           surface normal, which is the hair direction
    l           direction to the light
    h           half vector of light and viewer, see half_vector
    k_diffuse   diffuse colour
    p_diffuse   diffuse exponent; 1 is Kajiya and Kay's
    k_specular  colour of the highlight
    p_specular  exponent of the highlight
    returns     k_diffuse sin(n, l)^p_diffuse + k_specular sin(n, h)^p_specular; even in n.l, so it lights
                the coat from inside the body too: multiply by inherited_shadow or fur_surface_attenuation
    degenerate  l or h along n: sine 0, power 0; an exponent of 0: 1 everywhere
    form        see shell_sine_power
    source      Romanick 2010, VGP352 week 6, "Lighting Shells and Fins"; Kajiya and Kay 1989
    """
    return k_diffuse * shell_sine_power(n, l, p_diffuse) + k_specular * shell_sine_power(n, h, p_specular)


@variant("shell_shade")
def shell_shade_cosine(
    n: Direction,
    l: Direction,
    h: Direction,
    k_diffuse: Colour,
    p_diffuse: ExponentFrom2,
    k_specular: Colour,
    p_specular: ExponentFrom2,
) -> vec3:
    """Reflectance of a shell from two cosines, for exponents of 2 and more.

    n           surface normal, which is the hair direction
    l           direction to the light
    h           half vector of light and viewer
    k_diffuse   diffuse colour
    p_diffuse   diffuse exponent, at least 2; at exponent 1 the error near n = l would be 5e-4
    k_specular  colour of the highlight
    p_specular  exponent of the highlight, at least 2
    returns     k_diffuse sin(n, l)^p_diffuse + k_specular sin(n, h)^p_specular
    form        (1 - cos^2)^(p/2) by pow_one_minus: no sine, and as good as shell_shade for large exponents
    source      Romanick 2010, VGP352 week 6, "Lighting Shells and Fins", its identity put right
    """
    cos_l = dot(n, l)
    cos_h = dot(n, h)
    diffuse = pow_one_minus(cos_l * cos_l, 0.5 * p_diffuse)
    specular = pow_one_minus(cos_h * cos_h, 0.5 * p_specular)
    return k_diffuse * diffuse + k_specular * specular


@variant("shell_shade")
def shell_shade_from4(
    n: Direction,
    l: Direction,
    h: Direction,
    k_diffuse: Colour,
    p_diffuse: ExponentFrom8,
    k_specular: Colour,
    p_specular: ExponentFrom8,
) -> vec3:
    """Reflectance of a shell from two cosines, for exponents of 8 and more, without logarithms.

    n           surface normal, which is the hair direction
    l           direction to the light
    h           half vector of light and viewer
    k_diffuse   diffuse colour
    p_diffuse   diffuse exponent, at least 8
    k_specular  colour of the highlight
    p_specular  exponent of the highlight, at least 8
    returns     k_diffuse sin(n, l)^p_diffuse + k_specular sin(n, h)^p_specular
    form        shell_shade_cosine with pow_one_minus_from4
    source      Romanick 2010, VGP352 week 6; pow_one_minus_from4
    """
    cos_l = dot(n, l)
    cos_h = dot(n, h)
    diffuse = pow_one_minus_from4(cos_l * cos_l, 0.5 * p_diffuse)
    specular = pow_one_minus_from4(cos_h * cos_h, 0.5 * p_specular)
    return k_diffuse * diffuse + k_specular * specular


@variant("shell_shade")
def shell_shade_cubic8(
    n: Direction,
    l: Direction,
    h: Direction,
    k_diffuse: Colour,
    p_diffuse: ExponentFrom16,
    k_specular: Colour,
    p_specular: ExponentFrom16,
) -> vec3:
    """Reflectance of a shell from two cosines, for exponents of 16 and more, by polynomials.

    n           surface normal, which is the hair direction
    l           direction to the light
    h           half vector of light and viewer
    k_diffuse   diffuse colour
    p_diffuse   diffuse exponent, at least 16
    k_specular  colour of the highlight
    p_specular  exponent of the highlight, at least 16
    returns     k_diffuse sin(n, l)^p_diffuse + k_specular sin(n, h)^p_specular
    form        shell_shade_cosine with pow_one_minus_cubic8
    source      Romanick 2010, VGP352 week 6; pow_one_minus_cubic8
    """
    cos_l = dot(n, l)
    cos_h = dot(n, h)
    diffuse = pow_one_minus_cubic8(cos_l * cos_l, 0.5 * p_diffuse)
    specular = pow_one_minus_cubic8(cos_h * cos_h, 0.5 * p_specular)
    return k_diffuse * diffuse + k_specular * specular


@printed("shell_shade")
def shell_shade_printed(
    n: Direction,
    l: Direction,
    h: Direction,
    k_diffuse: Colour,
    p_diffuse: Exponent,
    k_specular: Colour,
    p_specular: Exponent,
) -> vec3:
    """Reflectance of a shell as the lecture prints it, with 1 - cos^(p/2) for (1 - cos^2)^(p/2).

    n           surface normal
    l           direction to the light
    h           half vector of light and viewer
    k_diffuse   diffuse colour
    p_diffuse   diffuse exponent
    k_specular  colour of the highlight
    p_specular  exponent of the highlight
    returns     k_diffuse (1 - (n.l)^(p_diffuse/2)) + k_specular (1 - (n.h)^(p_specular/2))
    degenerate  the power of a negative cosine counts as 0; cosines are limited to 1
    form        to the letter; off by 0.25 at exponents 2 and 4, by more than 0.99 from 32 on
    source      Romanick 2010, VGP352 week 6, "Lighting Shells and Fins"
    """
    diffuse = 1.0 - safe_pow(clamp(dot(n, l), -1.0, 1.0), 0.5 * p_diffuse)
    specular = 1.0 - safe_pow(clamp(dot(n, h), -1.0, 1.0), 0.5 * p_specular)
    return k_diffuse * diffuse + k_specular * specular
