"""An environment map as a few constant directional lights, and how far they are off.

Median cut (Debevec 2005): the map is cut across its longer side, measured on the sphere, into two parts of
one energy, and these again, until there are as many regions as lights; each becomes a directional light at
the centre of its energy with the whole of it. The colour of a light is what a white Lambertian that faces it
shows, as with all punctual lights of this library: the irradiance over pi.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError
from codegen.maps import latlong, mipmap
from codegen.maps.image import read_pixels
from codegen.maps.radiance import LUMINANCE, cleaned, first_wrong

Floats = npt.NDArray[np.float64]
COARSE = 64
"""Rows of the map that direct integration uses, at most."""


@dataclass(frozen=True)
class ConstantLight:
    """A directional light: unit direction to it, and its colour."""

    direction: tuple[float, float, float]
    colour: tuple[float, float, float]


@dataclass(frozen=True)
class Texels:
    """Texels as directional lights: directions (N, 3) and colours (N, 3), their solid angle included."""

    directions: Floats
    colours: Floats


def read_map(path: Path, shown: str) -> Floats:
    """The map's linear RGB, (height, width, 3); raises UserError for what is no such map.

    shown  what stands before the sentence: file and key
    """
    try:
        pixels = read_pixels(path, linear=True)
    except UserError as e:
        raise UserError(f"{shown}: {e}") from None
    height, width = pixels.shape[:2]
    if width != 2 * height:
        raise UserError(
            f'{shown}: "{path.name}" is {width} x {height}; a map in latitude and longitude is twice as '
            "wide as high"
        )
    endless = ~np.isfinite(pixels)
    if endless.any():
        raise UserError(f'{shown}: "{path.name}": {first_wrong(pixels, endless)}')
    # Negative values are mended unasked: lossy compression leaves small ones beside bright texels.
    rgb = np.asarray(cleaned(pixels), np.float64)
    if not rgb.any():
        raise UserError(f'{shown}: "{path.name}" is black: no light comes from it')
    return rgb


def texels(rgb: Floats) -> Texels:
    """Every texel as a light; orientation as in latlong_direction, y up."""
    height, width = rgb.shape[:2]
    weight = latlong.solid_angles(height, width)[:, None, None] / math.pi
    return Texels(latlong.directions(height, width).reshape(-1, 3), (rgb * weight).reshape(-1, 3))


def median_cut(rgb: Floats, count: int) -> list[ConstantLight]:
    """The map as this many lights, brightest first; fewer where the map has fewer lit texels."""
    height, width = rgb.shape[:2]
    lights = texels(rgb)
    energy = (lights.colours @ LUMINANCE).reshape(height, width)
    regions = [(0, height, 0, width)]
    while len(regions) < count:
        region = max(regions, key=lambda r: float(_part(energy, r).sum()) if _divisible(r) else -1.0)
        halves = _halves(energy, region)
        if halves is None:
            break
        regions.remove(region)
        regions += halves
    index = np.arange(height * width).reshape(height, width)
    found = []
    for region in regions:
        chosen = _part(index, region).ravel()
        total, weight = lights.colours[chosen].sum(axis=0), lights.colours[chosen] @ LUMINANCE
        mean = weight @ lights.directions[chosen]
        length = float(np.linalg.norm(mean))
        if length == 0.0 or not total.any():
            continue
        x, y, z = (float(c) for c in mean / length)
        r, g, b = (float(c) for c in total)
        found.append(ConstantLight((x, y, z), (r, g, b)))
    return sorted(found, key=lambda light: -float(np.dot(light.colour, LUMINANCE)))


Region = tuple[int, int, int, int]


def _part(values: npt.NDArray[np.generic], region: Region) -> npt.NDArray[np.generic]:
    top, bottom, left, right = region
    return values[top:bottom, left:right]


def _divisible(region: Region) -> bool:
    top, bottom, left, right = region
    return bottom - top > 1 or right - left > 1


def _halves(energy: Floats, region: Region) -> list[Region] | None:
    """The region cut across its longer side where half of its energy lies on either side."""
    top, bottom, left, right = region
    if not _divisible(region) or not _part(energy, region).any():
        return None
    middle = math.pi * 0.5 * (top + bottom) / energy.shape[0]
    across = (right - left) * math.sin(middle)
    wide = (across >= bottom - top and right - left > 1) or bottom - top == 1
    running = np.cumsum(np.asarray(_part(energy, region), np.float64).sum(axis=0 if wide else 1))
    cut = int(np.clip(np.searchsorted(running, 0.5 * running[-1]) + 1, 1, len(running) - 1))
    if wide:
        return [(top, bottom, left, left + cut), (top, bottom, left + cut, right)]
    return [(top, top + cut, left, right), (top + cut, bottom, left, right)]


@dataclass(frozen=True)
class MapError:
    """How far the constant lights are from direct integration over the map, relative to the mean radiance."""

    largest: float
    rms: float
    mean_radiance: float
    points: int
    texels: int


def measured_error(
    rgb: Floats,
    lights: list[ConstantLight],
    shade: Callable[[Floats, Floats, npt.NDArray[np.intp]], Floats],
    points: int,
) -> MapError:
    """The lights against the sum over all texels.

    shade   (directions (N, 3), colours (N, 3), points (N,) or (1,) for all lights) -> radiance (N, 3) of
            each light at its point
    points  number of points
    """
    everything = texels(mipmap.reduced(rgb, COARSE))
    few = Texels(
        np.array([light.direction for light in lights]), np.array([light.colour for light in lights])
    )
    places = np.repeat(np.arange(points), len(lights))
    shown = shade(np.tile(few.directions, (points, 1)), np.tile(few.colours, (points, 1)), places)
    wrong, right = [], []
    for k, of_lights in enumerate(np.split(shown, points)):
        truth = shade(everything.directions, everything.colours, np.array([k])).sum(axis=0)
        wrong.append(of_lights.sum(axis=0) - truth)
        right.append(truth)
    difference, mean = np.array(wrong), float(np.mean(right))
    return MapError(
        largest=float(np.abs(difference).max()),
        rms=float(np.sqrt((difference**2).mean())),
        mean_radiance=mean,
        points=points,
        texels=len(everything.directions),
    )
