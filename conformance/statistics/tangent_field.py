"""The highlight of a disordered tuft: the strand lobe averaged over von Mises-Fisher tangents."""

import numpy as np
from scipy.optimize import brentq

from conformance.statistics.evaluator import Array, shifted_sets


def concentration(mean_length: float) -> float:
    """The von Mises-Fisher concentration whose mean vector has that length: coth k - 1 / k = m."""
    return float(brentq(lambda k: 1.0 / np.tanh(k) - 1.0 / k - mean_length, 1e-3, 1e6))


def scattered_tangents(mean_length: float, count: int, seed: int) -> Array:
    """Tangents (count, 3) around z whose mean has that length, from one shifted low-discrepancy set."""
    k = concentration(mean_length)
    u = shifted_sets(count, 1, seed)[0]
    # inverse of the distribution of cos: 1 + log(u + (1 - u) e^-2k) / k
    first = (u[:, 0] * 2.0**24 + 0.5) * 2.0**-24
    z = 1.0 + np.log(first + (1.0 - first) * np.exp(-2.0 * k)) / k
    s, phi = np.sqrt(np.clip(1.0 - z * z, 0.0, None)), 2.0 * np.pi * u[:, 1]
    return np.stack([s * np.cos(phi), s * np.sin(phi), z], axis=1)


def pair_of_directions(elevation_l: float, elevation_v: float, kappa: float) -> tuple[Array, Array]:
    """l and v with given elevations above the plane orthogonal to z, and cosine of azimuth kappa."""
    across = np.sqrt(max(0.0, 1.0 - kappa * kappa))
    l = np.array([np.cos(elevation_l), 0.0, np.sin(elevation_l)])
    v = np.array([np.cos(elevation_v) * kappa, np.cos(elevation_v) * across, np.sin(elevation_v)])
    return l, v


def tuft_highlight(tangents: Array, l: Array, v: Array, exponent: float) -> float:
    """Mean of max(0, strand cosine)^exponent over the tangents."""
    cl, cv = tangents @ l, tangents @ v
    sl, sv = np.sqrt(np.clip(1.0 - cl * cl, 0.0, None)), np.sqrt(np.clip(1.0 - cv * cv, 0.0, None))
    return float(np.mean(np.maximum(sl * sv - cl * cv, 0.0) ** exponent))
