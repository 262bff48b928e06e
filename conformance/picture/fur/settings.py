"""The [fur] table of a scene: how the coat grows, how it is combed, how its shells and fins are drawn."""

from __future__ import annotations

from dataclasses import dataclass

from codegen.errors import nearest
from codegen.fur.coat import Combing
from codegen.scene.description.tables import Table, show

Triple = tuple[float, float, float]

CHANNELS = ("none", "red", "green", "blue")
LONGEST_COAT = 100.0
STRONGEST_BEND = 4.0
MOST_LAYERS = 256
"""Ends of the domains of shell_offset and shell_height."""


@dataclass(frozen=True)
class Fur:
    """A coat; lengths in units of the mesh. examples/README.md says what the keys mean."""

    length: float
    spacing: float
    thickness: float
    opacity: float
    layers: int
    authored_layers: float
    s_min: float
    seed: int
    fins: bool
    fin_threshold: float
    fin_opacity: float
    force: Triple
    combing: Combing
    surface: Triple
    channels: tuple[str, str]


def read_fur(table: Table) -> Fur | None:
    """The coat that a scene describes; None where it has no [fur] table."""
    if not table.content:
        return None
    comb, surface = table.table("comb"), table.table("surface")
    layers = table.integer("layers", 1, MOST_LAYERS, 32)
    fur = Fur(
        length=table.number("length", 0.0, LONGEST_COAT),
        spacing=table.number("spacing", 1e-6, 1e3),
        thickness=table.number("thickness", 0.0, 1.0, 0.8),
        opacity=table.number("opacity", 0.0, 1.0, 1.0),
        layers=layers,
        authored_layers=table.number("authored_layers", 1.0, 1e3, float(max(layers - 1, 1))),
        s_min=table.number("s_min", 0.0, 1.0, 0.3),
        seed=table.integer("seed", 0, 2**32 - 1, 1),
        fins=table.flag("fins", True),
        fin_threshold=table.number("fin_threshold", 0.0, 1.0, 0.25),
        fin_opacity=table.number("fin_opacity", 0.0, 1.0, 1.0),
        force=_bend(table, "force"),
        combing=_combing(comb),
        surface=_surface(surface),
        channels=(_channel(table, "length_channel"), _channel(table, "density_channel")),
    )
    for part in (table, comb, surface):
        part.close()
    return fur


def _combing(table: Table) -> Combing:
    if not table.content:
        return Combing()
    return Combing(table.direction("direction"), table.number("strength", 0.0, STRONGEST_BEND))


def _surface(table: Table) -> Triple:
    """Strength of the body's shadow on its coat, and n.l where it is total and where it starts."""
    if not table.content:
        return 0.0, -0.5, 0.5
    dark = table.number("cos_dark", -1.0, 1.0, -0.5)
    lit = table.number("cos_lit", -1.0, 1.0, 0.5)
    if dark >= lit:
        raise table.error("cos_dark", f"must be below cos_lit = {lit:g}, not {dark:g}")
    return table.number("rho", 0.0, 1.0, 1.0), dark, lit


def _bend(table: Table, key: str) -> Triple:
    bend = table.triple(key, (0.0, 0.0, 0.0))
    if sum(x * x for x in bend) > STRONGEST_BEND**2:
        raise table.error(key, f"must not be longer than {STRONGEST_BEND:g}")
    return bend


def _channel(table: Table, key: str) -> str:
    name = table.text(key, "none")
    if name not in CHANNELS:
        raise table.error(key, f"unknown channel {show(name)}{nearest(name, CHANNELS)}")
    return "" if name == "none" else name
