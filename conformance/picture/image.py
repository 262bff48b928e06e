"""PNG files: pictures, a picture of differences, a contact sheet."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw, ImageFont

from codegen.files import write_bytes

Bytes = npt.NDArray[np.uint8]

GAP = 12
CAPTION = 34
PAPER = (18, 19, 22)
INK = (226, 228, 232)
# Dark to bright at an even pace, so that equal steps of a difference look equal.
RAMP = np.array(
    [(6, 7, 12), (44, 24, 92), (128, 36, 118), (208, 66, 82), (246, 140, 50), (250, 236, 160)],
    dtype=np.float64,
)


def write_png(path: Path, picture: Bytes) -> None:
    """Write a picture (height, width, 3); the file appears whole or not at all.

    errors  UserError where the file cannot be written
    """
    encoded = io.BytesIO()
    Image.fromarray(picture).save(encoded, format="PNG", optimize=True)
    write_bytes(path, encoded.getvalue())


def full_scale(largest: float) -> float:
    """The least of 1, 2, 5 times a power of ten that is not below the largest difference."""
    if largest <= 0.0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(largest))
    return float(next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= largest))


def heat(steps: npt.NDArray[np.float64], scale: float) -> Bytes:
    """Differences (height, width) in colour: black is none, pale yellow is `scale` and above."""
    place = np.clip(steps / scale, 0.0, 1.0) * (len(RAMP) - 1)
    knots = np.arange(len(RAMP))
    channels = [np.interp(place, knots, RAMP[:, channel]) for channel in range(3)]
    return np.round(np.stack(channels, axis=-1)).astype(np.uint8)


def contact_sheet(panels: Sequence[tuple[str, Bytes]], columns: int, footer: Bytes | None = None) -> Bytes:
    """Pictures of one size side by side, each under its caption; `footer` is put below them."""
    height, width, _ = panels[0][1].shape
    rows = -(-len(panels) // columns)
    below = 0 if footer is None else footer.shape[0] + GAP
    size = (columns * (width + GAP) + GAP, rows * (height + CAPTION + GAP) + GAP + below)
    sheet = Image.new("RGB", size, PAPER)
    draw = ImageDraw.Draw(sheet)
    for number, (caption, picture) in enumerate(panels):
        x = GAP + number % columns * (width + GAP)
        y = GAP + number // columns * (height + CAPTION + GAP)
        draw.text((x, y), caption, fill=INK, font=_font(20))
        sheet.paste(Image.fromarray(picture), (x, y + CAPTION))
    if footer is not None:
        sheet.paste(Image.fromarray(footer), (GAP, size[1] - footer.shape[0] - GAP))
    return np.asarray(sheet)


def difference_sheet(panels: Sequence[tuple[str, npt.NDArray[np.float64]]]) -> Bytes:
    """Differences (height, width) in 8-bit steps as heat maps on one labelled scale."""
    largest = max(float(steps.max()) for _, steps in panels)
    scale = full_scale(largest)
    shown = [(f"{name}: at most {steps.max():.2g}", heat(steps, scale)) for name, steps in panels]
    width = len(panels) * (shown[0][1].shape[1] + GAP) - GAP
    return contact_sheet(shown, len(panels), _scale_bar(width, scale))


def _scale_bar(width: int, scale: float) -> Bytes:
    bar = Image.new("RGB", (width, 62), PAPER)
    draw = ImageDraw.Draw(bar)
    ramp = heat(np.broadcast_to(np.linspace(0.0, scale, width), (22, width)), scale)
    bar.paste(Image.fromarray(ramp), (0, 0))
    font = _font(18)
    left, middle, right = "0", "difference to float64 in 8-bit steps", f"{scale:g}"
    draw.text((0, 30), left, fill=INK, font=font)
    draw.text(((width - draw.textlength(middle, font=font)) / 2, 30), middle, fill=INK, font=font)
    draw.text((width - draw.textlength(right, font=font), 30), right, fill=INK, font=font)
    return np.asarray(bar)


def _font(size: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    return ImageFont.load_default(size=size)
