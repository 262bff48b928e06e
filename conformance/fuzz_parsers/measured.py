"""Reflectances: samples, factors of them, tables."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from codegen.factors.maps import read_factor_maps
from codegen.factors.samples import read_samples
from codegen.factors.waterloo import read_waterloo
from codegen.maps.image import exr, png, read_pixels
from codegen.tables.stored import read_angle_table
from conformance.fuzz_parsers.parser import Parser, json_parser, npz_parser

_DATE = re.compile(rb"\d{4}:\d\d:\d\d \d\d:\d\d:\d\d")
"""When an image was written: replaced, so that bytes give the same file on another day."""


def waterloo() -> Parser:
    """A factored material: NAME.txt beside its images, which are there."""

    images = {f"velvet_{k}.png": png(np.full((4, 4, 3), 0.5)) for k in (0, 1)}

    def read(path: Path) -> object:
        _beside(path, images)
        return read_waterloo(path)

    seeds = (b"velvet\n0\n0.5 0.4 0.3\n1.5\n", b"satin\n0\n1 1 1\n", b"\xff\xfe\n0\n1e400 nan -1\n")
    return Parser("velvet.txt", read, seeds)


def samples() -> Parser:
    """Samples of a reflectance as .csv."""
    rows = ["0,0,1,0,0,1,0.5", "0.6,0,0.8,0,0.6,0.8,0.25", "0,0,1,0.6,0,0.8,"] * 60
    single = "l.x,l.y,l.z,v.x,v.y,v.z,value\n" + "\n".join(rows)
    colours = "l.x,l.y,l.z,v.x,v.y,v.z,r,g,b\n" + "\n".join(f"{row},1,1" for row in rows)
    return Parser("own.csv", read_samples, (single.encode(), colours.encode(), b"l.x,v.x\n"))


def samples_npz() -> Parser:
    """The same as .npz."""
    directions = {"dtype": "float64", "shape": [200, 3], "values": [0.0, 0.0, 1.0, 0.6, 0.0, 0.8]}
    single = {"dtype": "float32", "shape": [200], "values": [0.5, 0.25]}
    colours = {"dtype": "float64", "shape": [200, 3], "values": [0.5, 0.25, 1.0, 0.0]}
    trees = [{"l": directions, "v": directions, "value": value} for value in (single, colours)]
    return npz_parser("own.npz", read_samples, trees)


def factors() -> Parser:
    """factors.json of `vair factor`, beside its images, which are there."""

    images = {f"{k}.exr": _grey_exr() for k in "pqr"}

    def read(path: Path) -> object:
        _beside(path, images)
        return read_factor_maps(path.parent)

    trees = [{"name": "velvet", "scale": [0.5, 0.4, 0.3], "angles": angles} for angles in ("", "along")]
    return json_parser("factors.json", read, trees)


def table() -> Parser:
    """table.json of `vair table`, beside its image, which is there."""

    images = {"table.exr": _grey_exr()}

    def read(path: Path) -> object:
        _beside(path, images)
        return read_angle_table(path.parent)

    axes = [{"name": name, "warp": "angle", "low": -1.0, "high": 1.0} for name in ("l", "v")]
    return json_parser("table.json", read, [{"x": axes[0], "y": axes[1]}])


def image() -> Parser:
    """A picture or map: OpenEXR, Radiance, PNG and PFM, told apart by their first bytes."""
    pixels = np.linspace(0.0, 1.0, 4 * 8 * 3, dtype=np.float32).reshape(4, 8, 3)
    dated = _DATE.sub(b"2000:01:01 00:00:00", exr(pixels))
    radiance = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n" + bytes(range(100, 164))
    portable = b"PF\n8 4\n-1.0\n" + pixels.tobytes()
    return Parser("own.image", read_pixels, (dated, png(pixels), radiance, portable))


def _grey_exr() -> bytes:
    return exr(np.full((4, 4, 3), 0.5))


def _beside(path: Path, files: dict[str, bytes]) -> None:
    for name, data in files.items():
        if not path.with_name(name).exists():
            path.with_name(name).write_bytes(data)
