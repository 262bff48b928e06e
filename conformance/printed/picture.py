"""The picture of a misprint: right, as printed, and the difference on a labelled scale."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw, ImageFont

from conformance.picture.image import GAP, INK, PAPER, Bytes, full_scale
from conformance.printed.misprint import Misprint, drawn
from conformance.printed.places import Array, equal_area

SIZE = 220
MARGIN = 5
TOP, BOTTOM, BAR = 26, 44, 12
WHITE = (255, 255, 255)
DIM = (160, 164, 172)
# Both palettes change their lightness at an even pace.
VALUES = np.array(
    [(10, 12, 32), (28, 48, 98), (24, 100, 122), (62, 150, 108), (158, 194, 88), (252, 240, 170)],
    dtype=np.float64,
)
DIFFERENCES = np.array(
    [
        (170, 222, 255),
        (70, 150, 235),
        (26, 70, 140),
        (12, 13, 16),
        (140, 58, 22),
        (230, 128, 48),
        (255, 226, 160),
    ],
    dtype=np.float64,
)


def picture(misprint: Misprint) -> Bytes:
    """Three panels under their captions and above their scales, (height, width, 3)."""
    x, y, inside = _pixels(misprint.drawing.samples)
    right, printed = drawn(misprint, x[inside], y[inside])
    change = printed - right
    if change.ndim == 2:  # of colours the component that changes most, with its sign
        change = np.take_along_axis(change, np.abs(change).argmax(axis=1)[:, None], axis=1)[:, 0]
    limit = misprint.drawing.limit or full_scale(float(np.abs(change).max()) * (1.0 - 1e-9))
    differences = _ramp(DIFFERENCES, (change / limit + 1.0) / 2.0)
    panels = [_panel(_shown(misprint, values), inside) for values in (right, printed)]
    sheet = Image.new("RGB", (3 * (SIZE + GAP) + GAP, TOP + SIZE + GAP + BOTTOM), PAPER)
    captions = ("right", "as printed", "printed minus right")
    for number, panel in enumerate([*panels, _panel(differences, inside)]):
        left = GAP + number * (SIZE + GAP)
        sheet.paste(Image.fromarray(panel), (left, TOP))
        _text(sheet, (left + SIZE / 2, TOP / 2), captions[number], 14)
        if misprint.drawing.ball is None:
            _marks(sheet, misprint, left)
    top = TOP + SIZE + GAP
    scale = misprint.drawing.scale
    if scale is not None:
        beyond = bool(max(right.max(), printed.max()) > scale[1] * (1.0 + 1e-9))
        _bar(sheet, VALUES, (GAP, top, 2 * SIZE + GAP), scale, misprint.drawing.shows, beyond)
    else:
        _text(sheet, (GAP * 1.5 + SIZE, top + BAR), misprint.drawing.shows, 13)
    beyond = bool(np.abs(change).max() > limit * (1.0 + 1e-9))
    _bar(sheet, DIFFERENCES, (3 * GAP + 2 * SIZE, top, SIZE), (-limit, limit), "difference", beyond)
    return np.asarray(sheet)


def _pixels(samples: int) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
    """Positions in the unit disc, y upwards, of every sample of a panel (rows, columns)."""
    centres = (np.arange(SIZE * samples) + 0.5) / samples
    ticks = (centres - SIZE / 2.0) / (SIZE / 2.0 - MARGIN)
    x, y = np.meshgrid(ticks, -ticks)
    return x, y, x * x + y * y <= 1.0


def _panel(colours: Array, inside: npt.NDArray[np.bool_]) -> Bytes:
    """Colours (N, 3) of the samples inside, on paper, averaged over the pixels."""
    full = np.empty((*inside.shape, 3))
    full[:] = PAPER
    full[inside] = colours
    samples = inside.shape[0] // SIZE
    small = full.reshape(SIZE, samples, SIZE, samples, 3).mean(axis=(1, 3))
    return np.asarray(np.round(small), dtype=np.uint8)


def _shown(misprint: Misprint, values: Array) -> Array:
    """Colours (N, 3), 0 to 255, of values (N,) by the palette or of linear RGB (N, 3) as sRGB."""
    scale = misprint.drawing.scale
    if scale is not None:
        return _ramp(VALUES, (values - scale[0]) / (scale[1] - scale[0]))
    linear = np.clip(values, 0.0, 1.0)
    curved = 1.055 * np.maximum(linear, 0.0031308) ** (1.0 / 2.4) - 0.055
    return np.asarray(255.0 * np.where(linear <= 0.0031308, 12.92 * linear, curved))


def _ramp(palette: Array, place: Array) -> Array:
    """Colours (N, 3) at places in [0, 1] of a palette."""
    at = np.clip(place, 0.0, 1.0) * (len(palette) - 1)
    return np.stack([np.interp(at, np.arange(len(palette)), palette[:, k]) for k in range(3)], axis=-1)


def _marks(sheet: Image.Image, misprint: Misprint, left: float) -> None:
    """Small rings where the example's directions lie, with their names."""
    radius = SIZE / 2.0 - MARGIN
    for label, direction in misprint.drawing.marks:
        x, y = equal_area(direction)
        at = (left + SIZE / 2.0 + x * radius, TOP + SIZE / 2.0 - y * radius)
        _ring(sheet, at, 6.5, 4.0, PAPER)
        _ring(sheet, at, 5.5, 1.8, WHITE)
        _text(sheet, (at[0] - 7, at[1] - 6), label, 14, WHITE, "rb")


def _ring(
    sheet: Image.Image, at: tuple[float, float], radius: float, width: float, colour: tuple[int, int, int]
) -> None:
    """A ring without jagged edges, radius and width in pixels."""
    left, top = (int(coordinate - radius) - 2 for coordinate in at)
    size = int(2.0 * radius) + 6
    y, x = np.ogrid[top : top + size, left : left + size]
    distance = np.hypot(x + 0.5 - at[0], y + 0.5 - at[1])
    cover = np.clip(radius + 0.5 - distance, 0.0, 1.0) * np.clip(distance - radius + width + 0.5, 0.0, 1.0)
    sheet.paste(colour, (left, top), Image.fromarray(np.asarray(np.round(255.0 * cover), dtype=np.uint8)))


def _bar(
    sheet: Image.Image,
    palette: Array,
    place: tuple[int, int, int],
    scale: tuple[float, float],
    label: str,
    beyond: bool,
) -> None:
    """A palette at (left, top, width) with its ends and its label; `beyond` marks ends that are passed."""
    left, top, width = place
    ramp = np.round(_ramp(palette, np.linspace(0.0, 1.0, width))).astype(np.uint8)
    sheet.paste(Image.fromarray(np.broadcast_to(ramp, (BAR, width, 3)).copy()), (left, top))
    y = top + BAR + 12
    more = " and more" if beyond else ""
    low, high = (f"{end:g}" for end in scale)
    _text(sheet, (left, y), low, 13, DIM, "lm")
    _text(sheet, (left + width / 2, y), label, 13, DIM)
    _text(sheet, (left + width, y), f"{high}{more}", 13, DIM, "rm")


def _text(
    sheet: Image.Image,
    at: tuple[float, float],
    text: str,
    size: int,
    colour: tuple[int, int, int] = INK,
    anchor: str = "mm",
) -> None:
    font = ImageFont.load_default(size=size)
    assert isinstance(font, ImageFont.FreeTypeFont), "Pillow is built without FreeType"
    # The basic layout needs no library of the system, so the letters fall on the same pixels everywhere.
    font = font.font_variant(layout_engine=ImageFont.Layout.BASIC)
    ImageDraw.Draw(sheet).text(at, text, colour, font, anchor, stroke_width=2, stroke_fill=PAPER)
