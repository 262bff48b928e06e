"""Written tables as the maps that shading functions read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from codegen.documents import read_json
from codegen.errors import UserError
from codegen.maps.image import read_pixels

MANIFEST, IMAGE = "table.json", "table.exr"


def read_angle_table(folder: Path) -> npt.NDArray[np.float32]:
    """A table that `vair table` wrote, (h, w, 4), for functions that read one over `strand_table_uv`.

    raises  UserError for a folder without a table, and for one on other axes than two angles
    """
    path = folder / MANIFEST
    if not path.is_file():
        raise UserError(f'cannot read "{folder}": there is no {MANIFEST} in it')
    try:
        told = read_json(path)
        axes = [
            (str(a["name"]), str(a["warp"]), float(a["low"]), float(a["high"]))
            for a in (told["x"], told["y"])
        ]
    except (ValueError, KeyError, TypeError, OverflowError):
        raise UserError(f'{path}: not what "vair table" writes; write the table again') from None
    if any(axis[1:] != ("angle", -1.0, 1.0) for axis in axes):
        given = " and ".join(f"{name} by {warp} from {low:g} to {high:g}" for name, warp, low, high in axes)
        raise UserError(f"{path}: its axes are {given}; two cosines by angle from -1 to 1 are needed")
    colours = read_pixels(folder / IMAGE)
    return np.concatenate([colours, np.ones((*colours.shape[:2], 1), np.float32)], axis=2)
