"""Strands of hair from TressFX files (.tfx, version 4).

Little-endian: version as f32; strands and points per strand as u32; byte offsets of positions, strand uv,
vertex uv, thickness and colour as u32; 32 reserved words. Positions are four f32 each.
"""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError

Doubles = npt.NDArray[np.float64]

HEADER = struct.Struct("<f7I")
HEADER_BYTES = 160
VERSION = 4.0
LARGEST_FILE = 1 << 29
MOST_POINTS = 1 << 21
"""Drawn as two vertices each, they fill half of the 256 MiB that WebGPU promises for a buffer."""
FARTHEST = 1.0e3
"""Coordinates up to which strands are drawn, as fur is."""


def read_strands(path: Path) -> Doubles:
    """The points (strands, points, 3) of a file, from root to tip.

    errors  UserError for a file that is missing, no such file, truncated, empty, huge, far away or not finite
    """
    if not path.is_file():
        raise UserError(f"{path}: there is no such file of strands")
    try:
        data = path.read_bytes() if path.stat().st_size <= LARGEST_FILE else None
    except OSError as error:
        raise UserError(f"{path}: cannot be read ({error.strerror or error})") from None
    if data is None:
        raise UserError(f"{path}: is larger than {LARGEST_FILE >> 20} MiB; thin the strands first")
    if len(data) < HEADER_BYTES or HEADER.unpack_from(data)[0] != VERSION:
        raise UserError(f"{path}: is no TressFX file of version 4")
    _, strands, points, offset, *_ = HEADER.unpack_from(data)
    if strands == 0 or points < 2:
        raise UserError(f"{path}: holds no strands of two points or more")
    if strands * points > MOST_POINTS:
        raise UserError(
            f"{path}: has {strands * points} points, more than {MOST_POINTS}; thin the strands first"
        )
    if offset < HEADER_BYTES or offset + 16 * strands * points > len(data):
        raise UserError(f"{path}: ends before its {strands} strands of {points} points do")
    rows = np.frombuffer(data, "<f4", 4 * strands * points, offset).reshape(strands, points, 4)
    with np.errstate(invalid="ignore"):  # of a signalling NaN
        found: Doubles = rows[..., :3].astype(np.float64)
    if not np.isfinite(found).all():
        raise UserError(f"{path}: has a point that is not finite")
    farthest = float(np.abs(found).max())
    if farthest > FARTHEST:
        raise UserError(
            f"{path}: reaches out to {farthest:g}; strands are drawn within {FARTHEST:g} units of the origin"
        )
    return found


def tfx(points: npt.ArrayLike) -> bytes:
    """The points (strands, points, 3) as the bytes of a file."""
    array = np.asarray(points, np.float64)
    strands, each, _ = array.shape
    rows = np.zeros((strands, each, 4), "<f4")
    rows[..., :3] = array
    head = HEADER.pack(VERSION, strands, each, HEADER_BYTES, 0, 0, 0, 0)
    return head.ljust(HEADER_BYTES, b"\0") + rows.tobytes()
