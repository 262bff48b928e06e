"""Image files to arrays of linear floats and back, through OpenImageIO."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError

Pixels = npt.NDArray[np.float32]

INTEGER_FORMATS = ("uint8", "uint16")


def read_pixels(path: Path, *, linear: bool = False) -> Pixels:
    """The pixels of an image file as (height, width, 3) float32, row 0 at the top.

    One channel is repeated; alpha is left out; integer formats become [0, 1].

    linear  whether sRGB-coded integers are decoded to linear light; float formats are linear already

    raises  UserError for a file that is missing, truncated, deep, or no image
    """
    oiio = _library()
    if not path.is_file():
        raise UserError(f'cannot read "{path}": {"it is a folder" if path.is_dir() else "no such file"}')
    with _silent():
        source = oiio.ImageInput.open(str(path))
        if source is None:
            raise UserError(f'cannot read "{path}": {_reason(_message(oiio))}')
        spec = source.spec()
        data = None if spec.deep else source.read_image(oiio.FLOAT)
        message = _message(source)
        source.close()
    if spec.deep:
        raise UserError(f'cannot read "{path}": it is a deep image, which has no single value per pixel')
    if data is None or message:
        raise UserError(f'cannot read "{path}": {_reason(message)}')
    pixels = np.asarray(data, np.float32).reshape(spec.height, spec.width, spec.nchannels)
    colours = pixels[:, :, :3] if spec.nchannels >= 3 else np.repeat(pixels[:, :, :1], 3, axis=2)
    if linear and str(spec.format) in INTEGER_FORMATS:
        colours = _decoded(colours)
    return np.ascontiguousarray(colours)


def _message(told: Any) -> str:
    """What the library, or an image of it, has to complain of."""
    try:
        return str(told.geterror())
    except UnicodeDecodeError as e:  # it quotes the file
        return bytes(e.object).decode("utf-8", "replace")


@contextmanager
def _silent() -> Iterator[None]:
    """Without what libraries of C print on their own: the sentence says it."""
    sys.stderr.flush()
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)


def _library() -> Any:
    try:
        import OpenImageIO
    except ImportError:
        raise UserError("images need the package OpenImageIO; install vair[maps]") from None
    return OpenImageIO


def _reason(message: str) -> str:
    """The first line of a library's message, as the end of a sentence."""
    lines = [line.strip() for line in message.splitlines() if line.strip()]
    return lines[0].rstrip(".") if lines else "the file ends too early or is damaged"


def _decoded(code: Pixels) -> Pixels:
    """Linear light of sRGB code values (IEC 61966-2-1)."""
    low, high = code / np.float32(12.92), ((code + np.float32(0.055)) / np.float32(1.055)) ** np.float32(2.4)
    return np.where(code <= np.float32(0.04045), low, high).astype(np.float32)


def exr(pixels: npt.ArrayLike) -> bytes:
    """(height, width) or (height, width, channels) floats as the bytes of a 32-bit OpenEXR file.

    raises  UserError where the library cannot write it
    """
    oiio = _library()
    return _encoded(np.atleast_3d(np.asarray(pixels, np.float32)), "exr", oiio.FLOAT, "zip")


def png(pixels: npt.ArrayLike) -> bytes:
    """(height, width, channels) values in [0, 1] as the bytes of an 8-bit PNG, rounded, not sRGB-coded.

    raises  UserError where the library cannot write it
    """
    oiio = _library()
    code = np.round(np.clip(np.asarray(pixels, np.float64), 0.0, 1.0) * 255.0).astype(np.uint8)
    return _encoded(code, "png", oiio.UINT8, None)


def _encoded(data: npt.NDArray[np.generic], kind: str, format_: Any, compression: str | None) -> bytes:
    oiio = _library()
    height, width, channels = data.shape
    spec = oiio.ImageSpec(width, height, channels, format_)
    if compression is not None:
        spec.attribute("compression", compression)
    with tempfile.TemporaryDirectory(prefix="vair-") as folder:
        path = os.path.join(folder, f"image.{kind}")
        out = oiio.ImageOutput.create(path)
        done = out is not None and out.open(path, spec) and out.write_image(np.ascontiguousarray(data))
        closed = out is not None and out.close()
        if not (done and closed):
            raise UserError(f"cannot make a .{kind} file: {_reason(oiio.geterror())}")
        return Path(path).read_bytes()
