"""The figures that the estimators promise, measured: rows of the report."""

from __future__ import annotations

from conformance.bench.figures import Figure
from conformance.light import estimators, published

PLACES = {
    "power": "Phong-like lobe of weight 1, 200 directions, Hammersley points",
    "strand": "strand lobe over the sphere, 48 views, Hammersley points",
}


def goals(*, quick: bool = False) -> list[Figure]:
    """All of them; quick leaves out those of the strand lobe, whose truth takes long."""
    promised = published.FIGURES["promised"]
    wide, sharp, both = (promised[key] for key in ("filtered_dawn", "guarded_dawn", "combined_studio"))
    found = [
        _figure("filtered importance sampling", "dawn", "power", p, wide["at_most"], estimators.filtered)
        for p in wide["exponents"]
    ]
    p = wide["plain_exponent"]
    filtered, plain = (
        published.error("dawn", "power", float(p), way) for way in (estimators.filtered, estimators.plain)
    )
    goal, where = 1.0 / wide["plain_at_least"], _where("dawn", "power", p)
    found.append(Figure("error filtered over unfiltered", where, "", goal, filtered / plain, "1"))
    p = sharp["exponent"]
    found.append(
        _figure("filtered where that helps", "dawn", "power", p, sharp["at_most"], estimators.guarded)
    )
    if quick:
        return found
    isotropic = next(row for row in published.FIGURES["strand"] if row["map"] == "studio")["filtered"]
    for p in both["exponents"]:
        goal = isotropic[str(p)] / both["better_by"]
        name = "samples of lobe and map together, unfiltered"
        found.append(_figure(name, "studio", "strand", p, goal, published.combined("studio")))
        # No goal: isotropic levels blur across the thin cone, which is what the row above is held against.
        name = "filtered importance sampling"
        found.append(_figure(name, "studio", "strand", p, None, estimators.filtered))
    return found


def _figure(
    what: str,
    name: str,
    kind: published.Kind,
    exponent: float,
    goal: float | None,
    estimate: estimators.Estimator,
) -> Figure:
    measured = published.error(name, kind, float(exponent), estimate)
    return Figure(what, _where(name, kind, exponent), "", goal, measured, "relative RMS")


def _where(name: str, kind: published.Kind, exponent: float) -> str:
    return f"{name}, exponent {exponent:g}, {published.SAMPLES} samples; {PLACES[kind]}; float64"
