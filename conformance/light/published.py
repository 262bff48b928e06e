"""The experiments whose figures the design publishes: lobes, directions and truths, as figures.toml says.

power   (p + 1) / (2 pi) max(0, w.r)^p about 200 directions r: its own density, so that every sample weighs 1
strand  the strand lobe over the whole sphere, the strand along x, seen from 48 directions
"""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from codegen.maps import prefilter
from conformance.light import estimators, plan
from conformance.light.environment import Environment, MapSampler
from conformance.light.lobes import Lobe, PowerLobe, View, about, along_x
from conformance.reference.sampling import sphere_uniform

Array = npt.NDArray[np.float64]
Kind = Literal["power", "strand"]

FIGURES: dict[str, Any] = tomllib.loads((Path(__file__).parent / "figures.toml").read_text(encoding="utf-8"))
SAMPLES = 40
DIRECTIONS: dict[Kind, int] = {"power": 200, "strand": 48}


@cache
def environment(name: str) -> Environment:
    """A carried map, with plain means in its chain."""
    return Environment.read(plan.path_of(name))


@cache
def sampler(name: str) -> MapSampler:
    """What draws from that map."""
    return MapSampler(environment(name))


@cache
def views(kind: Kind, every: int = 1) -> View:
    """The directions, or every so manieth of them."""
    r = np.asarray(sphere_uniform(estimators.sequence(DIRECTIONS[kind])))[::every]
    if kind == "strand":
        return along_x(r)
    return about(r, np.broadcast_to(np.array([0.0, 0.0, 1.0]), r.shape))


def lobe(kind: Kind, exponent: float) -> Lobe:
    """The integrand beside the radiance."""
    return PowerLobe(parameters=(exponent,)) if kind == "power" else Lobe("strand", (exponent,))


@cache
def truth(name: str, kind: Kind, exponent: float) -> Array:
    """The sum of the lobe over the map's texels."""
    if kind == "power":  # the same sum, twenty times faster; test_maps holds it against the plain one
        return prefilter.convolved(environment(name).pixels, exponent, views(kind).normal)
    return estimators.quadrature(environment(name), views(kind), lobe(kind, exponent))


def error(name: str, kind: Kind, exponent: float, estimate: estimators.Estimator) -> float:
    """The relative error of an estimator with SAMPLES samples."""
    u = estimators.sequence(SAMPLES)
    found = estimate(environment(name), views(kind), lobe(kind, exponent), u)
    return estimators.rms(found, truth(name, kind, exponent))


def combined(name: str) -> estimators.Estimator:
    """Half of the samples of the lobe and half of that map, by the balance heuristic."""

    def estimate(here: Environment, view: View, chosen: Lobe, u: Array) -> Array:
        return estimators.combined(here, view, chosen, *estimators.halves(len(u)), sampler(name))

    return estimate
