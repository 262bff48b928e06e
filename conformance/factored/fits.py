"""How well reflectances fit as products of textures, and what the published materials are like."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from codegen.factors.homomorphic import error
from codegen.factors.samples import directions
from codegen.factors.waterloo import read_waterloo
from codegen.library import Library
from conformance.factored.plan import Fit, Plan
from conformance.factored.published import SATIN, cosine_weighted, viewer

DIGITS = 3
KEPT = ("name", "function", "diffuse", "p", "q", "r", "angles", "emphasis")
MATERIALS = ("satin", "garnetred")
"""Folders of published factors."""
PAIRS = 20_000


def fit_row(library: Library, plan: Plan, fit: Fit) -> dict[str, Any]:
    """The errors of one fit against fresh samples: everywhere, and where no direction grazes."""
    factors = fit.factors(library, plan.samples)
    fresh = fit.drawn(library, plan.fresh, 2)
    whole, inner = error(factors, fresh), error(factors, fresh.above(plan.above))
    return {
        **{
            key: getattr(fit, key)
            for key in ("name", "function", "diffuse", "p", "q", "r", "angles", "emphasis")
        },
        "set": dict(fit.set),
        "texels": fit.p**2 + fit.q**2 + fit.r**2,
        **{key: short(getattr(whole, key)) for key in ("rms", "seen", "median", "p95")},
        "rms_above": short(inner.rms),
        "seen_above": short(inner.seen),
    }


def material_row(folder: Path) -> dict[str, Any]:
    """What a published material is like: size, texels without light, symmetry, anisotropy."""
    material = read_waterloo(folder)
    factors = material.factors
    l, v = directions(PAIRS, seed=3)
    there, back = factors.value(l, v), factors.value(v, l)
    light = cosine_weighted(256)
    along, across = (
        factors.value(light, np.broadcast_to(viewer(azimuth), light.shape)).mean(axis=0) for azimuth in SATIN
    )
    return {
        "name": material.name,
        "p": factors.p.shape[0],
        "q": factors.q.shape[0],
        "scale": [short(x) for x in factors.scale],
        "zeros": material.zeros,
        "asymmetry": short(float(np.abs(there - back).max() / there.mean())),
        "along": [short(x) for x in along],
        "across": [short(x) for x in across],
    }


def short(value: float) -> float:
    """Three significant digits: what does not depend on the machine."""
    return float(f"{value:.{DIGITS}g}")
