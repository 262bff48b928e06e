"""One lookup in a map that was convolved with the lobe: for lobes that are round about one direction.

The map holds means of radiance weighted by (p + 1) / (2 pi) max(0, w.r)^p. A Lambert lobe is p = 1 about the
normal, exactly. A Phong lobe keeps its own scale (p + 2) / (p + 1), and its cosine is taken at the mirror
direction: what the cosine does across the lobe, and what the horizon cuts off, is left out.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from codegen.maps import prefilter
from conformance.light.environment import Environment
from conformance.light.lobes import Lobe, View

Array = npt.NDArray[np.float64]

NAME = "prefiltered"
LARGEST_EXPONENT = 10.0
"""Sharper lobes need larger maps, whose convolution takes half a minute each."""


def exponent_of(lobe: Lobe) -> float | None:
    """The exponent of the map that serves a lobe; None where none does or none is made here."""
    if lobe.name == "lambert":
        return 1.0
    if lobe.name == "phong" and lobe.parameters[0] <= LARGEST_EXPONENT:
        return lobe.parameters[0]
    return None


def convolved(here: Environment, exponent: float) -> Environment:
    """A map whose only level is the convolution, of the size that prefilter.size_for says."""
    discs = prefilter.prefilter(here.pixels, exponent, border=here.border)
    found = Environment(np.zeros((1, 2, 3)), size=discs.shape[1], border=here.border)
    found.levels = [discs]
    return found


def directions(view: View, lobe: Lobe) -> Array:
    """Where to look it up, in the map's axes, (n, 3)."""
    if lobe.name == "lambert":
        return view.normal
    return view.to_world((view.v * np.array([-1.0, -1.0, 1.0]))[:, None, :])[:, 0]


def scale(view: View, lobe: Lobe) -> Array:
    """What the looked up value is multiplied by, (n, 1)."""
    if lobe.name == "lambert":
        return np.ones((len(view), 1))
    (exponent,) = lobe.parameters
    return np.asarray((exponent + 2.0) / (exponent + 1.0) * view.v[:, 2:])
