"""The format of the University of Waterloo's repository of factored reflectance: a text file and two images.

NAME.txt holds the material's name, a line that is 0, the scale per channel and, in most files, a number whose
meaning is not documented. NAME_0.png is p, NAME_1.png is q: parabolic maps in the frame of the tangent. Older
folders hold the scale in `alpha`, one channel per line, and the images as NAMEp.png and NAMEq.png.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError
from codegen.factors.homomorphic import Factors
from codegen.maps.image import png, read_pixels

Array = npt.NDArray[np.float64]

SHOWN = 40
"""Characters of a file that a sentence quotes."""


@dataclass(frozen=True)
class Material:
    """A material by name; `zeros` counts texels that eight bits rounded to 0, where nothing is reflected."""

    name: str
    factors: Factors
    zeros: int


def read_waterloo(path: Path) -> Material:
    """A material from its .txt file or from the folder that holds it.

    raises  UserError for a file or folder that holds no such material, and says what is missing
    """
    if path.is_dir():
        return _folder(path)
    if path.suffix != ".txt":
        raise UserError(f'cannot read "{path}": a factored material is a .txt file or a folder')
    return _listed(path)


def _folder(folder: Path) -> Material:
    alpha = folder / "alpha"
    if alpha.is_file():
        p, q = sorted(folder.glob("*p.png")), sorted(folder.glob("*q.png"))
        if len(p) != 1 or len(q) != 1:
            raise UserError(f'{folder}: beside "alpha" there must be one *p.png and one *q.png')
        return _material(
            p[0].stem[:-1], _numbers(alpha, alpha.read_text(errors="replace").split()), p[0], q[0]
        )
    listed = sorted(path for path in folder.glob("*.txt") if path.with_name(f"{path.stem}_0.png").is_file())
    if len(listed) != 1:
        raise UserError(f"{folder}: {len(listed)} materials; name one by its .txt file")
    return _listed(listed[0])


def _listed(path: Path) -> Material:
    if not path.is_file():
        raise UserError(f'cannot read "{path}": no such file')
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    if len(lines) < 3 or lines[1].strip() != "0":
        raise UserError(f"{path.name}: not a factored material: the second line is 0, the third the scale")
    p, q = (path.with_name(f"{path.stem}_{k}.png") for k in (0, 1))
    return _material(lines[0].strip(), _numbers(path, lines[2].split()), p, q)


def _numbers(path: Path, words: list[str]) -> Array:
    shown = repr(" ".join(words[:3])[:SHOWN])
    try:
        scale = np.array([float(word) for word in words[:3]])
    except ValueError:
        raise UserError(f"{path.name}: the scale is three numbers, not {shown}") from None
    if len(scale) != 3 or not (np.isfinite(scale) & (scale > 0.0)).all():
        raise UserError(f"{path.name}: the scale is three numbers above 0, not {shown}")
    return scale


def _material(name: str, scale: Array, p: Path, q: Path) -> Material:
    images = []
    for path in (p, q):
        image = np.asarray(read_pixels(path), np.float64)
        if image.shape[0] != image.shape[1]:
            raise UserError(f"{path.name}: {image.shape[1]} x {image.shape[0]}; a parabolic map is square")
        images.append(image)
    zeros = sum(int((image <= 0.0).any(axis=2).sum()) for image in images)
    return Material(name, Factors(scale, images[0], images[1]), zeros)


def waterloo_files(name: str, stem: str, factors: Factors) -> dict[str, bytes]:
    """The three files of a material in the newer layout; images are 8 bit, so values below 1/510 are lost.

    raises  UserError where the factors have a third one, which the format cannot hold
    """
    if factors.r is not None:
        raise UserError("the Waterloo format holds p and q only; leave out the factor r")
    scale = np.broadcast_to(factors.scale, (3,))
    text = f"{name}\n0\n{' '.join(f'{x:.9g}' for x in scale)}\n"
    return {
        f"{stem}.txt": text.encode(),
        f"{stem}_0.png": png(np.broadcast_to(factors.p, (*factors.p.shape[:2], 3))),
        f"{stem}_1.png": png(np.broadcast_to(factors.q, (*factors.q.shape[:2], 3))),
    }
