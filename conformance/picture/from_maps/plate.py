"""One plate: rows are bodies under maps, columns are ways of lighting."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.library import Library
from codegen.maps.radiance import LUMINANCE
from conformance.light.estimators import rms
from conformance.light.lobes import Lobe
from conformance.light.plan import DATA
from conformance.picture.from_maps.bodies import BODIES, Body, see_body
from conformance.picture.from_maps.ways import WAYS, Look, Map, background, truth
from conformance.picture.image import contact_sheet
from conformance.picture.shade import Backend
from conformance.picture.tone import eight_bit, resolve, steps_apart

Doubles = npt.NDArray[np.float64]
PLAN: dict[str, Any] = tomllib.loads(Path(__file__).with_name("plates.toml").read_text(encoding="utf-8"))


@dataclass(frozen=True)
class Panel:
    """One picture: its caption and its linear light (height, width, 3), exposed.

    error  root mean square of the body's radiance to the sum over the map's texels, over that of the sum, at
           the row's points
    """

    caption: str
    linear: Doubles
    error: float


@dataclass(frozen=True)
class Row:
    """A body under a map.

    points    covered samples at which errors are measured
    truth     (points, 3) radiance there
    exposure  factor of the pictures' light
    """

    body: Body
    env: Map
    points: npt.NDArray[np.int64]
    truth: Doubles
    exposure: float


@dataclass(frozen=True)
class Plate:
    """A plate made ready to be drawn by backends."""

    look: Look
    rows: tuple[Row, ...]
    parameter_names: list[str]

    @property
    def columns(self) -> int:
        """Panels in a row."""
        return len(WAYS)

    def draw(self, backend: Backend) -> list[Panel]:
        """All panels, row by row."""
        return [panel for row in self.rows for panel in self._row(backend, row)]

    def _row(self, backend: Backend, row: Row) -> list[Panel]:
        behind = background(backend, row.body, row.env, PLAN["background_level"])
        counts = {"filtered": self.look.samples, "plain": self.look.samples, "reference": self.look.reference}
        panels: list[Panel] = []
        for name, way in WAYS.items():
            shaded = way(backend, row.body, row.env, self.look, self.parameter_names)
            linear = resolve(row.body.mask, shaded * np.array(self.look.colour), behind) * row.exposure
            error = rms(shaded[row.points], row.truth)
            label = f"{name} {counts[name]}" if name in counts else name
            under = "" if panels else f"{row.env.name}: "
            percent = f"{100.0 * error:.0f}" if error >= 0.1 else f"{100.0 * error:.2g}"
            panels.append(Panel(f"{under}{label}, {percent} %", linear, error))
        return panels

    @staticmethod
    def sheet(panels: list[Panel], columns: int) -> npt.NDArray[np.uint8]:
        """The panels of a plate as one picture."""
        return contact_sheet([(panel.caption, eight_bit(panel.linear)) for panel in panels], columns)

    @staticmethod
    def apart(one: Panel, other: Panel) -> float:
        """The largest difference of two pictures of the same panel, in 8-bit steps before rounding."""
        return float(steps_apart(one.linear, other.linear).max())


def made_ready(
    name: str,
    library: Library,
    size: int | None = None,
    maps: Sequence[str] | None = None,
    kinds: Sequence[str] = BODIES,
) -> Plate:
    """The plate of that name in plates.toml.

    size   pixels along a panel's side, instead of the plate's own
    maps   of examples/data, instead of all
    kinds  of bodies
    """
    said = PLAN["plate"][name]
    lobe = Lobe(said["lobe"], tuple(said["parameters"]))
    exponent = said.get("prefiltered", lobe.parameters[0])
    look = Look(lobe, exponent, PLAN["samples"], PLAN["reference"], tuple(said["colour"]))
    parameters = [
        p.name for p in library.function(f"{lobe.name}_value").parameters if p.name not in ("l", "v")
    ]
    bodies = {}
    for kind in kinds:
        table = PLAN["body"][kind]
        bodies[kind] = see_body(kind, table if size is None else table | {"size": size})
    rows = []
    for file in maps or PLAN["maps"]:
        env = Map(DATA / f"{file}.exr", PLAN["lights"])
        for body in bodies.values():
            points = body.some(PLAN["points"])
            right = truth(body.at(points), env, look)
            bright = float(np.quantile(right @ (LUMINANCE * np.array(look.colour)), PLAN["bright_share"]))
            rows.append(Row(body, env, points, right, PLAN["bright"] / bright))
    return Plate(look, tuple(rows), parameters)
