"""What `vair env` writes: levels and prefiltered lobes as OpenEXR files, and their description in JSON."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError, unknown
from codegen.ir.domains import number
from codegen.maps import latlong, mipmap, octahedral, paraboloid, prefilter
from codegen.maps.image import Pixels
from codegen.maps.radiance import read_radiance
from codegen.maps.undated import undated_exr
from codegen.version import VERSION

Array = npt.NDArray[np.float64]
SCHEMA = 1
LARGEST = 4096
"""Texels along a side of a map, at most: a larger one would not fit the textures of many devices."""
MAPPINGS = {
    "dual-paraboloid": "front disc (+z) left, back disc (-z) right; see dual_paraboloid_uv",
    "octahedral": "one square with a border of one texel around every level; see octahedral_encode",
}


@dataclass(frozen=True)
class Settings:
    """How a map is prepared.

    mapping    a key of MAPPINGS
    size       texels along a side of the largest level (of each disc), without border texels
    border     dual-paraboloid: how much of the plane beyond the rim is shown, >= 1
    weighting  "solid-angle": a texel of the chain is the mean over the sphere of what it covers; "plain":
               the mean of its texels, as hardware makes chains
    exponents  of the lobes to prefilter
    clean      mend values that are no radiance instead of refusing the map
    """

    mapping: str = "dual-paraboloid"
    size: int = paraboloid.SIZE
    border: float = paraboloid.BORDER
    weighting: str = "solid-angle"
    exponents: Sequence[float] = ()
    clean: bool = False


@dataclass(frozen=True)
class Prepared:
    """Images by file name, (height, width, channels) float64, and what env.json says of them."""

    images: dict[str, Array]
    manifest: dict[str, Any]
    chain: list[Array] = field(default_factory=list)

    def files(self) -> dict[str, bytes]:
        """The files of the folder, by name."""
        text = json.dumps(self.manifest, indent=1) + "\n"
        return {name: undated_exr(image) for name, image in self.images.items()} | {"env.json": text.encode()}


def check(settings: Settings) -> None:
    """Raise UserError for settings that no map can have."""
    if settings.mapping not in MAPPINGS:
        raise unknown("mapping", settings.mapping, MAPPINGS)
    if not 1 <= settings.size <= LARGEST:
        raise UserError(f"--size {settings.size}: a map has 1 to {LARGEST} texels along a side")
    if not 1.0 <= settings.border <= 4.0:
        raise UserError(f"--border {settings.border:g}: the border is a factor of 1 to 4; 1 shows none")
    for exponent in settings.exponents:
        if not 0.0 <= exponent <= 1e5:
            raise UserError(f"--prefilter {exponent:g}: a lobe's exponent is in [0, 1e5]")


def unexpected(settings: Settings) -> str:
    """What env_* functions do not expect of a map, in one sentence; empty where they read it."""
    whole = settings.size & (settings.size - 1) == 0
    if settings.mapping == "dual-paraboloid" and whole and settings.border == paraboloid.BORDER:
        return ""
    return (
        "the env_* functions will misread this map: they expect a dual-paraboloid map of a size that is a "
        f"power of two, with a border of {number(paraboloid.BORDER)}"
    )


def prepare(path: Path, settings: Settings, progress: Callable[[str], None] = lambda step: None) -> Prepared:
    """A latitude-longitude map from a file, resampled, with its chain and its prefiltered lobes.

    progress  called with what is done next

    raises    UserError for bad settings or an unreadable or unphysical map
    """
    check(settings)
    progress(f"reading {path.name}")
    pixels = read_radiance(path, clean=settings.clean)
    progress("resampling")
    chain = levels(pixels, settings)
    images = {f"level_{k}.exr": level for k, level in enumerate(chain)}
    lobes = []
    for exponent in dict.fromkeys(settings.exponents):
        progress(f"prefiltering exponent {number(exponent)}")
        discs = prefilter.prefilter(pixels, exponent, border=settings.border)
        name = f"phong_{number(exponent)}.exr"
        images[name] = np.concatenate(list(discs), axis=1)
        lobes.append({"exponent": exponent, "size": discs.shape[1], "file": name})
    height, width = pixels.shape[:2]
    mean = (pixels * latlong.solid_angles(height, width)[:, None, None]).sum((0, 1)) / (4.0 * np.pi)
    manifest = {
        "schema": SCHEMA,
        "version": VERSION,
        "source": {
            "file": path.name,
            "sha256": hashlib.sha256(path.read_bytes()).hexdigest(),
            "width": width,
            "height": height,
            "mended": settings.clean,
            "mean_radiance": [float(f"{x:.7g}") for x in mean],
            "largest_radiance": float(pixels.max()),
        },
        "mapping": settings.mapping,
        "layout": MAPPINGS[settings.mapping],
        "axes": "y up; paraboloids look along +z and -z",
        "border": settings.border if settings.mapping == "dual-paraboloid" else "1 texel",
        "weighting": settings.weighting,
        "levels": [
            {"file": f"level_{k}.exr", "width": level.shape[1], "height": level.shape[0]}
            for k, level in enumerate(chain)
        ],
        "prefiltered": lobes,
    }
    return Prepared(images, manifest, chain)


def levels(pixels: Pixels, settings: Settings) -> list[Array]:
    """The levels of the map from the largest down to one texel per face, each as it is laid out in a file."""
    weighted = settings.weighting == "solid-angle"
    if settings.mapping == "octahedral":
        weights = octahedral.solid_angles(settings.size) if weighted else None
        flat = octahedral.from_latlong(pixels, settings.size)
        return [octahedral.bordered(level) for level in mipmap.chain(flat, weights)]
    weights = paraboloid.solid_angles(settings.size, settings.border) if weighted else None
    discs = paraboloid.from_latlong(pixels, settings.size, settings.border)
    front, back = (mipmap.chain(disc, weights) for disc in discs)
    return [np.concatenate(pair, axis=1) for pair in zip(front, back, strict=True)]
