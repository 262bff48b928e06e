"""Figures about the misprints that were known before, computed anew from the library."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from conformance.printed import fur, shells, strands
from conformance.printed.misprint import N, measure_every_light, value
from conformance.printed.places import LAYERS, Array, direction, hemisphere, over_hemisphere

FIGURES = Path(__file__).with_name("figures.toml")


@dataclass(frozen=True)
class Figure:
    """A known figure.

    name       of the function of COMPUTED
    arguments  its arguments
    says       what it is, in words
    known      the values known
    digits     of the values, where they are shown
    tolerance  absolute
    origin     where known and tolerance come from
    """

    name: str
    arguments: tuple[tuple[float, ...], ...]
    says: str
    known: tuple[float, ...]
    digits: int
    tolerance: float
    origin: str

    def computed(self) -> tuple[float, ...]:
        """The same values from the library."""
        return tuple(COMPUTED[self.name](*row) for row in self.arguments)


def figures() -> list[Figure]:
    """All figures of figures.toml."""
    tables = tomllib.loads(FIGURES.read_text(encoding="utf-8"))
    return [
        Figure(
            name=name,
            arguments=tuple(tuple(row) for row in table.get("arguments", [[]])),
            says=table["says"],
            known=tuple(table["known"]),
            digits=table["digits"],
            tolerance=table["tolerance"],
            origin=table["origin"],
        )
        for name, table in tables.items()
    ]


def banks_sum() -> float:
    """Largest |printed + right| over pairs of directions."""
    l, v = (np.roll(hemisphere(5, 5)[0], shift, axis=0) for shift in (0, 371))
    right, printed = strands.cosine_banks(v, l)
    return float(np.abs(right + printed).max())


def kajiya_mean() -> float:
    """Mean error of the strand cosine after Kajiya and Kay over every light."""
    found = [measure_every_light(m) for m in strands.MISPRINTS if m.key == "strand-cosine-kajiya"]
    assert found[0] is not None
    return found[0][1]


def reflection_angles() -> Array:
    """Angle between the two reflection vectors in degrees, at polar angles of l in [0, 180], (N,)."""
    polar = np.linspace(0.0, np.pi, 3601)
    l = np.stack([np.sin(polar), 0.0 * polar, np.cos(polar)], axis=1)
    cosine = np.sum(value("mirror", l=l, n=N) * strands.mirrored(N, l), axis=1)
    return np.asarray(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


def reflection_mean() -> float:
    angle = reflection_angles()
    weight = np.sin(np.linspace(0.0, np.pi, len(angle)))
    return float(angle @ weight / weight.sum())


def reflection_largest() -> float:
    return float(reflection_angles().max())


def hair_area_ratio() -> float:
    return float((fur.area(printed=True) / fur.area(printed=False))[0])


def halved_opacity(right: float) -> float:
    """Opacity with the printed area of a coat whose opacity is `right`."""
    strands_lie, seen_from_above = direction(90, 0), direction(0, 0)
    density = -np.log1p(-right) / fur.area(printed=False)
    rows = {"t": strands_lie, "n": N, "w": seen_from_above}
    depth = value("fur_optical_depth", density=density, hair_area=fur.area(printed=True), **rows)
    return float(value("fur_opacity", optical_depth=depth)[0])


def alpha_supremum(part: str) -> float:
    """Largest error of one opacity throughout, over optical depths 0 and 1e-9 .. 1e9 along v and l."""
    depths = np.concatenate([[0.0], np.logspace(-9.0, 9.0, 181)])
    view, light = (x.ravel() for x in np.meshgrid(depths, depths))
    right = value("fur_weights_goldman", depth_view=view, depth_light=light, overlap=0.5)
    printed = value("fur_weights_goldman", depth_view=view, depth_light=view, overlap=0.5)
    return float(np.abs(right[part] - printed[part]).max())


def fin_mean(form: int, uniform_polar: bool) -> float:
    """Mean opacity of a fin, right (0) or printed (1), over the sphere or over uniform polar angles."""
    places = over_hemisphere()
    v = places.points
    weights = places.weights
    if uniform_polar:  # every polar angle counts alike; the two ends of the range are half a step each
        ends = (v[:, 2] == 0.0) | (v[:, 2] == 1.0)
        weights = np.where(ends, 0.5, 1.0)
        weights = weights / weights.sum()
    return float(weights @ shells.fin(v, v)[form])


def last_shell() -> float:
    right, printed = shells.shell_shadow(np.array([[LAYERS - 1.0]]), N)
    return float((right - printed)[0])


COMPUTED: dict[str, Callable[..., float]] = {
    "banks_sum": banks_sum,
    "kajiya_mean": kajiya_mean,
    "reflection_mean": reflection_mean,
    "reflection_largest": reflection_largest,
    "hair_area_ratio": hair_area_ratio,
    "halved_opacity": halved_opacity,
    "alpha_skin": partial(alpha_supremum, "skin"),
    "alpha_hair": partial(alpha_supremum, "hair"),
    "fin_polar_right": partial(fin_mean, 0, True),
    "fin_polar_printed": partial(fin_mean, 1, True),
    "fin_sphere_right": partial(fin_mean, 0, False),
    "fin_sphere_printed": partial(fin_mean, 1, False),
    "shell_identity": shells.identity,
    "last_shell": last_shell,
}
