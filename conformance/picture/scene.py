"""Scene files: what is shaded, with which parameters, and what a picture of it needs.

The tables [scene], [shade], [parameters], [view] and [lights] say what is known of a scene; [render]
adds what only a picture needs: a mesh, a camera, lights, how the surface is brushed; [fur] the coat
on it, where it bears one; [strands] the strands that are drawn in the place of a mesh.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from codegen.backends import TARGETS
from codegen.errors import UserError
from codegen.scene.description.document import BUDGETS
from codegen.scene.description.tables import Table, is_number, read_tables, show
from conformance.picture.brush import Brush
from conformance.picture.fur.settings import Fur, read_fur
from conformance.picture.strands.settings import Hair, read_hair
from conformance.picture.visibility import Camera

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
SCENES = EXAMPLES / "scenes"
MOST_LIGHTS = 64
"""Lights of one kind."""
BRIGHTEST = 1.0e4
"""Largest component of a light's colour, as shading functions take it."""
TABLES = ("scene", "shade", "parameters", "view", "lights", "render", "fur", "strands")

Triple = tuple[float, float, float]
Value = float | tuple[float, ...]


@dataclass(frozen=True)
class Range:
    """A parameter that varies; a picture shows the middle of the range."""

    low: float
    high: float

    @property
    def middle(self) -> float:
        return 0.5 * (self.low + self.high)


@dataclass(frozen=True)
class Light:
    """A directional light: the direction to it (any length) and its colour in linear light."""

    direction: Triple
    colour: Triple


@dataclass(frozen=True)
class Sky:
    """An environment map that lights a scene: a file in latitude and longitude, y up.

    lights  how many directional lights stand for it
    scale   factor of its light
    """

    map: Path
    lights: int
    scale: float


@dataclass(frozen=True)
class Picture:
    """What only a picture needs; sizes in pixels, lengths in units of the mesh, colours of the
    background in sRGB.

    lights  those that the scene lists
    sky     what lights the scene besides; None without an environment
    """

    mesh: Path
    size: tuple[int, int]
    supersample: int
    subdivide: int
    shadows: bool
    top: Triple
    bottom: Triple
    camera: Camera
    brush: Brush
    lights: tuple[Light, ...]
    sky: Sky | None = None

    @property
    def samples(self) -> tuple[int, int]:
        """Samples (width, height): supersample along each side of a pixel."""
        width, height = self.size
        return width * self.supersample, height * self.supersample


@dataclass(frozen=True)
class Scene:
    """A scene file that has been read and checked, except for the names that the library decides.

    budget       largest permitted error: a name of BUDGETS or the error itself; None where none is set
    parameters   by the function's own names, dotted for struct fields
    min_n_dot_v  least n.v that occurs
    lights       how many directional lights there are
    picture      None without a [render] table
    fur          None without a [fur] table
    hair         None without a [strands] table
    """

    path: Path
    name: str
    targets: tuple[str, ...]
    budget: str | float | None
    model: str
    parameters: dict[str, Value | Range]
    min_n_dot_v: float
    lights: int
    picture: Picture | None = field(default=None)
    fur: Fur | None = field(default=None)
    hair: Hair | None = field(default=None)


def read_scene(path: Path) -> Scene:
    """Read a scene file; paths in it are relative to its own folder."""
    tables = read_tables(path, TABLES)
    scene, shade, view, lights = (tables[name] for name in ("scene", "shade", "view", "lights"))
    sky = _sky(tables)
    hair, fur = read_hair(tables["strands"]), read_fur(tables["fur"])
    if hair is not None and fur is not None:
        raise UserError(f"{path}: has a [fur] and a [strands] table; a picture shows one of them")
    picture = _picture(tables["render"], sky, hair) if tables["render"].content else None
    result = Scene(
        path=path,
        name=scene.text("name", path.stem),
        targets=scene.choices("targets", "target", TARGETS),
        budget=scene.number_or_name("budget", BUDGETS, 0.0, 1e6) if "budget" in scene else None,
        model=shade.text("model"),
        parameters={key: _parameter(tables["parameters"], key) for key in tables["parameters"].content},
        min_n_dot_v=view.number("min_n_dot_v", -1.0, 1.0, -1.0),
        lights=_lights(lights, picture),
        picture=picture,
        fur=fur,
        hair=hair,
    )
    for table in (scene, shade, view, lights):
        table.close()
    return result


def _parameter(table: Table, key: str) -> Value | Range:
    value: Any = table.value(key)
    if isinstance(value, dict):
        bounds = Table(table.path, f'{table.name}."{key}"', value)
        low, high = bounds.number("min", -1e38, 1e38), bounds.number("max", -1e38, 1e38)
        bounds.close()
        if low > high:
            raise table.error(f'"{key}"', f"min = {low:g} is above max = {high:g}")
        return Range(low, high)
    if is_number(value):
        return float(value)
    if isinstance(value, list) and 2 <= len(value) <= 4 and all(map(is_number, value)):
        return tuple(float(x) for x in value)
    raise table.error(
        f'"{key}"',
        f"must be a number, a vector of numbers or a range {{ min = ..., max = ... }}, not {show(value)}",
    )


def _lights(table: Table, picture: Picture | None) -> int:
    """The number of directional lights; what a picture cannot show is refused where there is one."""
    directional = table.integer("directional", 0, MOST_LIGHTS, len(picture.lights) if picture else 0)
    point = table.integer("point", 0, MOST_LIGHTS, 0)
    if picture is None:
        return directional
    if directional != len(picture.lights):
        raise table.error(
            "directional", f"is {directional}, but [[render.light]] lists {len(picture.lights)}"
        )
    if point:
        raise table.error("point", "a picture is lit by directional lights and an environment only")
    return directional


def _sky(tables: Mapping[str, Table]) -> Sky | None:
    """The environment that [lights] names, with the factor that [render] gives it."""
    table, render = tables["lights"], tables["render"]
    name = table.text("environment", "none")
    lights = table.integer("environment_lights", 1, MOST_LIGHTS, 8)
    scale = render.number("environment_scale", 0.0, 1e4, 1.0)
    if name != "none":
        return Sky(table.path.parent / name, lights, scale)
    if "environment_lights" in table:
        raise table.error("environment_lights", 'needs a map: environment = "FILE"')
    if "environment_scale" in render:
        raise render.error("environment_scale", 'needs a map: [lights] environment = "FILE"')
    return None


def _picture(render: Table, sky: Sky | None, hair: Hair | None) -> Picture:
    camera, brush, background = (render.table(name) for name in ("camera", "brush", "background"))
    lights = render.tables("light")
    if not lights and sky is None:
        raise UserError(f"{render.path}: [[render.light]] is missing: a picture needs a light")
    picture = Picture(
        mesh=hair.file if hair else render.path.parent / render.text("mesh"),
        size=_size(render),
        supersample=render.integer("supersample", 1, 8, 2),
        subdivide=render.integer("subdivide", 0, 4, 0),
        shadows=render.flag("shadows", True),
        top=background.triple("top", (0.0, 0.0, 0.0)),
        bottom=background.triple("bottom", (0.0, 0.0, 0.0)),
        camera=_camera(camera),
        brush=Brush(
            axis=brush.direction("axis", (0.0, 1.0, 0.0)),
            amplitude=brush.number("amplitude", 0.0, 1.5, 0.0),
            frequency=brush.number("frequency", 0.0, 1e4, 10.0),
            length=brush.number("length", 1.0, 1e4, 40.0),
        ),
        lights=tuple(Light(t.direction("direction"), _colour(t)) for t in lights),
        sky=sky,
    )
    for table in (render, camera, brush, background, *lights):
        table.close()
    return picture


def _colour(light: Table) -> Triple:
    colour = light.triple("colour", (1.0, 1.0, 1.0))
    if not all(0.0 <= x <= BRIGHTEST for x in colour):
        said = f"must be three numbers from 0 to {BRIGHTEST:g}, not {show(list(colour))}"
        raise light.error("colour", said)
    return colour


def _size(render: Table) -> tuple[int, int]:
    value = render.value("size", [768, 768])
    whole = isinstance(value, list) and len(value) == 2 and all(type(x) is int for x in value)
    if not whole or not all(1 <= x <= 4096 for x in value):
        raise render.error("size", f"must be [width, height] from 1 to 4096 pixels, not {show(value)}")
    return value[0], value[1]


def _camera(table: Table) -> Camera:
    eye, target, up = table.triple("eye"), table.triple("target"), table.direction("up", (0.0, 1.0, 0.0))
    forward = [b - a for a, b in zip(eye, target, strict=True)]
    if not any(forward):
        raise table.error("target", "is where the eye is")
    if not any(forward[i - 2] * up[i - 1] - forward[i - 1] * up[i - 2] for i in range(3)):
        raise table.error("up", "points along the view")
    return Camera(eye, target, up, table.number("field_of_view", 0.1, 170.0, 30.0))
