"""Factors as the maps that shading functions read, from a fit, a written folder or a published material.

maps = read_factor_maps(Path("satin"))
execute(library, maps.function, {**maps.inputs(), "l": l, "v": v}, runtime)
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.documents import read_json
from codegen.errors import UserError
from codegen.factors.homomorphic import Factors
from codegen.factors.waterloo import read_waterloo
from codegen.maps.image import read_pixels

Map = npt.NDArray[np.float32]
MANIFEST = "factors.json"
LARGEST = float(np.finfo(np.float32).max)
SHADES = {"": "factored_shade", "along": "factored_strand_shade", "across": "factored_satin_shade"}
"""The angles that the factor r follows -> the function of the library that reads the factors."""


@dataclass(frozen=True)
class FactorMaps:
    """Maps (h, w, 4) float32, row 0 at v = 0, clamped at their edges, and the scale (3,).

    function  the name of the library's function that reads them
    """

    name: str
    function: str
    scale: Map
    p: Map
    q: Map
    r: Map | None = None

    def inputs(self) -> dict[str, Any]:
        """The function's inputs but for l and v, by name."""
        third = {} if self.r is None else {"r": self.r}
        return {"p": self.p, "q": self.q, **third, "scale": self.scale}


def factor_maps(name: str, factors: Factors) -> FactorMaps:
    """The maps of factors in one or three channels."""
    return FactorMaps(
        name,
        SHADES[factors.angles if factors.r is not None else ""],
        np.broadcast_to(factors.scale, (3,)).astype(np.float32),
        _map(factors.p),
        _map(factors.q),
        None if factors.r is None else _map(factors.r),
    )


def read_factor_maps(path: Path) -> FactorMaps:
    """The maps that `vair factor` wrote into a folder, or those of a material of the Waterloo repository.

    raises  UserError for a folder or file that holds neither, and says what is missing
    """
    manifest = path / MANIFEST
    if not manifest.is_file():
        material = read_waterloo(path)
        return factor_maps(material.name, material.factors)
    told = _manifest(manifest)
    images = {k: np.asarray(read_pixels(path / f"{k}.exr"), np.float64) for k in ("p", "q")}
    r = np.asarray(read_pixels(path / "r.exr"), np.float64) if told["angles"] else None
    factors = Factors(np.array(told["scale"]), images["p"], images["q"], r, told["angles"] or "along")
    return factor_maps(str(told["name"]), factors)


def _manifest(path: Path) -> dict[str, Any]:
    try:
        told = read_json(path)
        scale, angles = [float(x) for x in told["scale"]], told["angles"]
    except (ValueError, KeyError, TypeError, OverflowError):
        raise UserError(f'{path}: not what "vair factor" writes; write the factors again') from None
    usable = all(0.0 < x <= LARGEST for x in scale)
    if len(scale) not in (1, 3) or not usable or angles not in list(SHADES):
        raise UserError(f'{path}: not what "vair factor" writes; write the factors again')
    return {"name": told.get("name", path.parent.name), "scale": scale, "angles": angles}


def _map(image: npt.NDArray[np.floating]) -> Map:
    """An image of one or three channels as RGBA."""
    colours = np.broadcast_to(image, (*image.shape[:2], 3))
    return np.concatenate([colours, np.ones((*image.shape[:2], 1))], axis=2).astype(np.float32)
