"""Samples of a reflectance: pairs of directions in the local frame and values, drawn or read from a file."""

from __future__ import annotations

import math
import warnings
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.lib.recfunctions import structured_to_unstructured

from codegen.errors import UserError, nearest

Array = npt.NDArray[np.float64]

COLUMNS = ("l.x", "l.y", "l.z", "v.x", "v.y", "v.z")
FEWEST = 100
"""Samples that a fit needs, at least."""
UNIT = 1e-3
"""How far the length of a direction in a file may be from 1 before the file is taken for something else."""


@dataclass(frozen=True)
class Samples:
    """Directions (n, 3) above the surface, unit, and values (n, channels); a NaN value is a missing one."""

    l: Array  # the library's name of the direction to the light
    v: Array
    value: Array

    def known(self) -> Samples:
        """Without missing values and without values <= 0, whose logarithm says nothing."""
        kept = (np.isfinite(self.value) & (self.value > 0.0)).all(axis=1)
        return Samples(self.l[kept], self.v[kept], self.value[kept])

    def above(self, height: float) -> Samples:
        """Those of which light and viewer are at least that high above the surface, by their z."""
        kept = (self.l[:, 2] >= height) & (self.v[:, 2] >= height)
        return Samples(self.l[kept], self.v[kept], self.value[kept])

    def __len__(self) -> int:
        return len(self.value)


def directions(count: int, seed: int) -> tuple[Array, Array]:
    """Two directions each of `count` pairs, uniform over the hemisphere about +z."""
    u = np.random.default_rng(seed).random((2, count, 2))
    z, phi = u[..., 0], 2.0 * np.pi * u[..., 1]
    radius = np.sqrt(1.0 - z * z)
    w = np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1)
    return w[0], w[1]


def read_samples(path: Path) -> Samples:
    """Samples from a file: .csv with a header, or .npz with arrays l, v (n, 3) and value (n,) or (n, 3).

    The columns of a .csv are l.x l.y l.z v.x v.y v.z and value, or r g b; an empty value is a missing one.

    raises  UserError for a file that is none of this: which column, and where
    """
    if not path.is_file():
        raise UserError(f'cannot read "{path}": no such file')
    if path.suffix == ".npz":
        return _checked(path, *_arrays(path))
    if path.suffix != ".csv":
        raise UserError(f'cannot read "{path}": samples are a .csv or .npz file')
    try:
        if not path.read_text(encoding="utf-8").strip():
            raise UserError(f"{path.name}: not a table of numbers: it is empty")
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # of a table without rows
            table: Any = np.genfromtxt(
                path, delimiter=",", names=True, deletechars="", dtype=np.float64, ndmin=1
            )
    except (ValueError, OSError, IndexError, UserWarning) as e:  # undecodable: a ValueError
        raise UserError(f"{path.name}: not a table of numbers: {str(e).splitlines()[0]}") from None
    names = table.dtype.names or ()
    values = ("r", "g", "b") if "r" in names else ("value",)
    for column in (*COLUMNS, *values):
        if column not in names:
            raise UserError(f'{path.name}: the column "{column}" is missing{nearest(column, names)}')

    numbers = structured_to_unstructured(table)

    def stacked(columns: tuple[str, ...]) -> Array:
        return np.asarray(numbers[:, [names.index(name) for name in columns]])

    return _checked(path, stacked(COLUMNS[:3]), stacked(COLUMNS[3:]), stacked(values))


def _arrays(path: Path) -> tuple[Array, Array, Array]:
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as data:
            for name in ("l", "v", "value"):
                if name not in data:
                    raise UserError(f'{path.name}: the array "{name}" is missing{nearest(name, data.files)}')
            l, v, value = (_floats(path, name, data[name]) for name in ("l", "v", "value"))
    except (ValueError, OSError, EOFError, zipfile.BadZipFile, zlib.error) as e:
        reason = (str(e) or "it is damaged").splitlines()[0]
        raise UserError(f"{path.name}: not a readable .npz file: {reason}") from None
    value = np.atleast_1d(value)
    return l, v, value.reshape(len(value), math.prod(value.shape[1:]))


def _floats(path: Path, name: str, values: npt.NDArray[Any]) -> Array:
    if values.dtype.kind not in "fiub":
        raise UserError(f'{path.name}: the array "{name}" holds {values.dtype.name} instead of numbers')
    with np.errstate(invalid="ignore"):  # of a signalling NaN
        return values.astype(np.float64)


def _checked(path: Path, l: Array, v: Array, value: Array) -> Samples:
    if not l.shape == v.shape == (len(value), 3) or value.shape[1] not in (1, 3):
        raise UserError(f"{path.name}: l and v have 3 columns, value has 1 or 3, and all have as many rows")
    for name, w in (("l", l), ("v", v)):
        with np.errstate(over="ignore"):  # an infinite length is none of 1 either
            length = np.linalg.norm(w, axis=1)
        wrong = ~(np.abs(length - 1.0) <= UNIT) | (w[:, 2] < 0.0)
        if wrong.any():
            row = int(np.flatnonzero(wrong)[0])
            raise UserError(
                f"{path.name}: row {row + 1}: {name} = ({', '.join(f'{c:g}' for c in w[row])}) is no unit "
                f"vector with {name}.z >= 0"
            )
    wrong = (np.isinf(value) | (value < 0.0)).any(axis=1)  # a missing value is NaN
    if wrong.any():
        row = int(np.flatnonzero(wrong)[0])
        told = ", ".join(f"{x:g}" for x in value[row])
        raise UserError(
            f"{path.name}: row {row + 1}: the value {told} is no reflectance ({int(wrong.sum())} such rows)"
        )
    found = Samples(l, v, value)
    usable = len(found.known())
    if usable < FEWEST:
        raise UserError(f"{path.name}: {usable} samples have a value above 0; a fit needs {FEWEST}")
    return found
