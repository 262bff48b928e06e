"""An environment map as lights of a picture: median cut, as `vair scene` does it."""

from __future__ import annotations

from dataclasses import replace

from codegen.scene.environment import median_cut, read_map
from conformance.picture.scene import Light, Picture, Scene


def lit_by_sky(scene: Scene, picture: Picture) -> Picture:
    """The picture with the lights that stand for its environment behind those that it lists.

    errors  UserError for a map that cannot be read or is black
    """
    sky = picture.sky
    if sky is None:
        return picture
    found = median_cut(read_map(sky.map, f"{scene.path}: [lights] environment"), sky.lights)
    added = [Light(light.direction, _scaled(light.colour, sky.scale)) for light in found]
    return replace(picture, lights=(*picture.lights, *added))


def _scaled(colour: tuple[float, float, float], by: float) -> tuple[float, float, float]:
    r, g, b = colour
    return by * r, by * g, by * b
