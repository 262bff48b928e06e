"""The lights of a scene: how many of which kind, and what is known of their colours and distances."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from codegen.errors import nearest
from codegen.scene.description.model import COLOUR, HALF, LIGHT, Model
from codegen.scene.description.tables import Table, is_number, show

MOST = 64
"""Lights of one kind."""
UNROLLED = 4
"""Up to this many lights are written out; more are a loop over arrays."""

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Lights:
    """Lights of a scene.

    directional, point   how many
    environment          a map in latitude and longitude, y up; None without one
    environment_lights   constant directional lights that stand for the map
    colour               least and largest component of a light's colour, or one constant colour
    distance             range of the distance to a point light; below the lower end its light grows no more
    per_light            paths of parameters that each light has its own value of
    """

    directional: int = 1
    point: int = 0
    environment: Path | None = None
    environment_lights: int = 8
    colour: tuple[float, float] | Triple = (0.0, 1.0)
    distance: tuple[float, float] = (1.0, 100.0)
    per_light: tuple[str, ...] = field(default=())

    @property
    def varying(self) -> int:
        """Lights whose direction is an input."""
        return self.directional + self.point

    @property
    def constant_colour(self) -> Triple | None:
        """The colour of all lights where the scene states one."""
        return self.colour if len(self.colour) == 3 else None


def read_lights(table: Table, model: Model) -> Lights:
    """The table [lights]; one directional light where it says nothing."""
    if not table.content:
        return Lights()
    stated = any(key in table for key in ("directional", "point", "environment"))
    lights = Lights(
        directional=table.integer("directional", 0, MOST, 0 if stated else 1),
        point=table.integer("point", 0, MOST, 0),
        environment=_environment(table),
        environment_lights=table.integer("environment_lights", 1, MOST, 8),
        colour=_colour(table),
        distance=_range(table, "distance", 1e-6, 1e9, (1.0, 100.0)),
        per_light=_per_light(table, model),
    )
    if lights.varying == 0 and lights.environment is None:
        raise table.error("directional", "the scene has no light at all")
    if "environment_lights" in table and lights.environment is None:
        raise table.error("environment_lights", 'needs a map: environment = "FILE"')
    if "distance" in table and not lights.point:
        raise table.error("distance", "belongs to point lights, and the scene has none")
    if LIGHT not in model.slots and HALF not in model.slots:
        raise table.error("directional", f"{model.function.name} takes no direction to a light")
    table.close()
    return lights


def _environment(table: Table) -> Path | None:
    name = table.text("environment", "none")
    return None if name == "none" else table.path.parent / name


def _colour(table: Table) -> tuple[float, float] | Triple:
    value = table.value("colour", {"min": 0.0, "max": 1.0})
    if isinstance(value, dict):
        return _range(table, "colour", 0.0, 1e4, (0.0, 1.0))
    triple = table.triple("colour")
    if not all(0.0 <= x <= 1e4 for x in triple):
        raise table.error("colour", f"must be three numbers from 0 to 10000, not {show(value)}")
    return triple


def _range(
    table: Table, key: str, least: float, most: float, default: tuple[float, float]
) -> tuple[float, float]:
    value = table.value(key, {"min": default[0], "max": default[1]})
    if not isinstance(value, dict) or not all(is_number(x) for x in value.values()):
        raise table.error(key, f"must be a range {{ min = ..., max = ... }}, not {show(value)}")
    for name in value:
        if name not in ("min", "max"):
            raise table.error(key, f'unknown key "{name}" of a range{nearest(name, ("min", "max"))}')
    low, high = float(value.get("min", default[0])), float(value.get("max", default[1]))
    if low > high:
        raise table.error(key, f"min = {low:g} is above max = {high:g}")
    if low < least or high > most:
        raise table.error(key, f"must lie in {least:g} to {most:g}")
    return low, high


def _per_light(table: Table, model: Model) -> tuple[str, ...]:
    value = table.value("per_light", [])
    if not isinstance(value, list) or not all(isinstance(x, str) for x in value):
        raise table.error("per_light", f'must be an array of parameters, as ["skin"], not {show(value)}')
    for path in value:
        if path in (LIGHT, COLOUR, HALF):
            raise table.error("per_light", f'"{path}" belongs to each light anyway')
        if path not in model.settable:
            what = f"{model.function.name} has no parameter"
            raise table.error("per_light", f'{what} "{path}"{nearest(path, model.settable)}')
    return tuple(dict.fromkeys(value))
