"""Float64 lobes around a fibre along x: the strand lobe, and Poulin and Fournier's parallel cylinders.

Elevations are measured from the plane orthogonal to x.
"""

from collections.abc import Callable

import numpy as np

from conformance.reference.exact import Array, mirror, power_of_one_minus, real, stack, unit
from conformance.reference.lobes_half import (
    TINY,
    blinn_phong_scale,
    cosine_direction,
    lit,
    upper_half,
)

NODES = 40
"""Gauss-Legendre nodes over nine widths of the lobe on either side: a relative error of 4e-11."""
WIDTHS = 9.0


def elevation(w: Array) -> tuple[Array, Array]:
    """Sine and cosine of the elevation of w above the plane orthogonal to x."""
    w = unit(w)
    return w[..., 0], np.hypot(w[..., 1], w[..., 2])


def strand_defect(l: Array, v: Array) -> Array:
    """1 - cos(theta_l + theta_v)."""
    (cl, sl), (cv, sv) = elevation(l), elevation(v)
    return ((sl - sv) ** 2 + (cl + cv) ** 2) / 2.0


def strand_blend(v: Array, exponent: Array) -> Array:
    """Share b of the part of the density that is proportional to c^m."""
    cv, sv = elevation(v)
    p = real(exponent)
    along = np.abs(cv) ** (p + 2.0) / (p + 1.0)
    return along / (sv * np.sqrt(2.0 * np.pi / (p + 1.5)) + along)


def bell_defect(y: Array, m: Array) -> Array:
    """1 - (1 - y^2)^(1/m) for 0 <= y <= 1."""
    inside = y < 1.0
    y = np.where(inside, y, 0.5)
    return np.where(inside, -np.expm1((np.log1p(-y) + np.log1p(y)) / m), 1.0)


def strand_value(l: Array, v: Array, exponent: Array) -> Array:
    """max(0, cos(theta_l + theta_v))^p, dark side 0 also for p = 0; unnormalised, on the whole sphere."""
    q = strand_defect(l, v)
    return np.where(q < 1.0, power_of_one_minus(q, exponent), 0.0)


def strand_pdf(l: Array, v: Array, exponent: Array) -> Array:
    """Density of |delta|, H, spread over both signs of delta and the azimuth: H / (2 pi W)."""
    (cl, sl), (cv, sv) = elevation(l), elevation(v)
    q, m, b = strand_defect(l, v), real(exponent) + 1.0, strand_blend(v, exponent)
    inside = q < 1.0
    q = np.where(inside, q, 0.5)
    c, s = 1.0 - q, cl * sv + sl * cv
    y = np.sqrt(-np.expm1(m * np.log1p(-q)))
    # |sin delta| / y tends to sqrt(2 / m) at the peak, where both vanish
    bell = np.where(y > 0.0, np.sqrt(q * (2.0 - q)) / np.where(y > 0.0, y, 1.0), np.sqrt(2.0 / m))
    sine = np.sqrt(q * (2.0 - q))
    density = m * np.exp((m - 1.0) * np.log1p(-q)) * (b * sine + (1.0 - b) / 2.0 * bell)
    width = sl + np.maximum(0.0, c * sv - cv * s)
    return np.where(inside, density / (2.0 * np.pi * np.maximum(width, TINY)), 0.0)


def strand_sides(u: Array, v: Array, exponent: Array) -> tuple[Array, Array, Array, Array, Array]:
    """cos and sin of |delta|, cosines of theta_l for delta > 0 and delta < 0, and the share of delta > 0."""
    cv, sv = elevation(v)
    x, m, b = real(u)[..., 0], real(exponent) + 1.0, strand_blend(v, exponent)
    # b y^2 + (1 - b) y = x, solved for y without cancellation
    root = (1.0 - b) + np.sqrt((1.0 - b) ** 2 + 4.0 * b * x)
    y = np.where(x > 0.0, 2.0 * x / np.where(root > 0.0, root, 1.0), 0.0)
    q = bell_defect(y, m)
    c, s = 1.0 - q, np.sqrt(q * (2.0 - q))
    plus, minus = np.maximum(0.0, c * sv + s * cv), np.maximum(0.0, c * sv - s * cv)
    both = plus + minus
    return c, s, plus, minus, np.where(both > 0.0, plus / np.where(both > 0.0, both, 1.0), 1.0)


def strand_sample(u: Array, v: Array, exponent: Array) -> Array:
    """|delta| by its exact inverse, then its sign in proportion to cos theta_l, then the azimuth."""
    cv, sv = elevation(v)
    c, s, plus, minus, share = strand_sides(u, v, exponent)
    y = real(u)[..., 1]
    positive = y < share
    turn = np.where(
        positive, y / np.where(share > 0.0, share, 1.0), (y - share) / np.where(share < 1.0, 1.0 - share, 1.0)
    )
    side, radius = np.where(positive, 1.0, -1.0), np.where(positive, plus, minus)
    phi = 2.0 * np.pi * turn
    return unit(stack(side * s * sv - c * cv, radius * np.cos(phi), radius * np.sin(phi)))


def grazing_angle(w: Array) -> tuple[Array, Array]:
    """Angle gamma of w above the surface in the profile plane, and the side (1 for w.y >= 0) that it comes
    from."""
    return np.arctan2(w[..., 2], np.abs(w[..., 1])), np.where(w[..., 1] >= 0.0, 1.0, -1.0)


def visible_arc(gamma: Array, side: Array, spread: Array) -> tuple[Array, Array]:
    """The part [a, b] of an arc of half-angle `spread` that a direction gamma above the surface sees.

    Arcs of radius 1 stand side by side at pitch d = 2 sin(spread). The far end is the arc's own horizon,
    -gamma on the side +1; the near end is cut by the neighbour where gamma < spread: phi + asin(d cos phi -
    1) for the profile angle phi = pi / 2 - gamma, written as -gamma + 2 asin sqrt(d sin(gamma) / 2), which
    keeps tiny angles.
    """
    pitch = 2.0 * np.sin(spread)
    far = np.minimum(spread, gamma)
    shadow = 2.0 * np.arcsin(np.sqrt(np.clip(pitch * np.sin(gamma) / 2.0, 0.0, 1.0))) - gamma
    near = np.where(gamma < spread, np.minimum(spread, shadow), spread)
    return np.where(side > 0.0, -far, -near), np.where(side > 0.0, near, far)


def facing(xi: Array, gamma: Array, side: Array) -> Array:
    """Cosine between the facet at arc angle xi and the direction, over that direction's length in the
    profile."""
    return np.sin(gamma + side * xi)


def poulin_fournier_value(l: Array, v: Array, spread: Array, specular: Array, exponent: Array) -> Array:
    """(1 - specular) f_d + specular f_s for parallel cylinders, both integrals over the arc by fine
    quadrature."""
    bright = lit(l, v) > 0.0
    up = np.array([0.0, 0.0, 1.0])
    l, v = (np.where(bright[..., None], unit(w), up) for w in (l, v))
    half_angle, p = real(spread), real(exponent)
    (gamma_l, side_l), (gamma_v, side_v) = grazing_angle(l), grazing_angle(v)
    (low_l, high_l), (low_v, high_v) = (
        visible_arc(gamma_l, side_l, half_angle), visible_arc(gamma_v, side_v, half_angle)
    )  # fmt: skip
    a = np.maximum(low_l, low_v)
    b = np.maximum(np.minimum(high_l, high_v), a)
    slant = 2.0 * np.sin(half_angle) * np.sin(gamma_l) * np.sin(gamma_v)
    nodes, weights = np.polynomial.legendre.leggauss(NODES)

    def over_arc(low: Array, high: Array, bell: Callable[[Array], Array]) -> Array:
        xi = ((low + high) / 2.0)[..., None] + ((high - low) / 2.0)[..., None] * nodes
        both = facing(xi, gamma_l[..., None], side_l[..., None]) * facing(
            xi, gamma_v[..., None], side_v[..., None]
        )
        return np.asarray(
            (high - low) / 2.0 * np.sum(bell(xi) * both * weights, axis=-1) / slant, dtype=np.float64
        )

    diffuse = over_arc(a, b, np.ones_like) / np.pi
    h, _ = upper_half(l, v)
    across = power_of_one_minus(h[..., 0] ** 2, p / 2.0)
    phi_h = np.arctan2(h[..., 1], h[..., 2])[..., None]
    reach = np.minimum(np.pi / 2.0, WIDTHS / np.sqrt(p + 1.0))
    low, high = np.clip(phi_h[..., 0] - reach, a, b), np.clip(phi_h[..., 0] + reach, a, b)

    def bell(xi: Array) -> Array:
        """cos^p of the angle from the half vector; 1 - cos x = 2 sin^2(x / 2)."""
        return power_of_one_minus(2.0 * np.sin((xi - phi_h) / 2.0) ** 2, p[..., None])

    shiny = blinn_phong_scale(p) * across * over_arc(low, high, bell)
    return np.where(bright, (1.0 - real(specular)) * diffuse + real(specular) * shiny, 0.0)


def poulin_fournier_pdf(l: Array, v: Array, spread: Array, specular: Array, exponent: Array) -> Array:
    """A cosine lobe and a half-vector lobe over the facets, in the proportion of `specular`."""
    h, vh = upper_half(l, v)
    m, half_angle = real(exponent) + 1.0, real(spread)
    cosine = np.hypot(h[..., 1], h[..., 2])
    sine = np.abs(h[..., 0])
    logarithm = np.log(np.where(cosine > 0.0, cosine, 1.0))
    steep = sine**2 < 0.5
    logarithm = np.where(steep, 0.5 * np.log1p(-np.where(steep, sine**2, 0.0)), logarithm)
    y = np.sqrt(-np.expm1(m * logarithm))
    bell = np.where(y > 0.0, sine / np.where(y > 0.0, y, 1.0), np.sqrt(2.0 / m))
    # H / cos eta = m cos^(m - 2) |sin eta| / (2 y)
    elevation_density = m * np.exp((m - 2.0) * logarithm) * bell / 2.0
    inside = np.abs(np.arctan2(h[..., 1], h[..., 2])) < half_angle
    facets = np.where(inside & (cosine > 0.0), elevation_density / (4.0 * half_angle), 0.0)
    diffuse = np.maximum(unit(l)[..., 2], 0.0) / np.pi
    s = real(specular)
    return (1.0 - s) * diffuse + s * facets / (4.0 * vh)


def poulin_fournier_sample(u: Array, v: Array, spread: Array, specular: Array, exponent: Array) -> Array:
    """The strategy by u.x, rescaled; then a cosine direction or a facet normal to mirror about."""
    x, y, s = real(u)[..., 0], real(u)[..., 1], real(specular)
    diffuse = x < 1.0 - s
    spread_out = cosine_direction(stack(np.where(diffuse, x / np.where(s < 1.0, 1.0 - s, 1.0), 0.5), y))
    first = np.where(diffuse, 0.5, (x - (1.0 - s)) / np.where(s > 0.0, s, 1.0))
    root = 2.0 * first - 1.0
    # u = (0, 0) for specular 1 is the peak and not the corner of the lobe; on its edges the density is 0
    begins = root <= -1.0
    q = bell_defect(np.where(begins, 0.0, np.abs(root)), real(exponent) + 1.0)
    xi = np.where(y == 0.0, 0.0, real(spread) * (2.0 * y - 1.0))
    c, sine = 1.0 - q, np.sign(root) * np.sqrt(q * (2.0 - q))
    h = stack(sine, c * np.sin(xi), c * np.cos(xi))
    return np.where(diffuse[..., None], spread_out, mirror(unit(v), h))


__all__ = [
    "poulin_fournier_pdf", "poulin_fournier_sample", "poulin_fournier_value", "strand_pdf", "strand_sample",
    "strand_value",
]  # fmt: skip
