"""What a frame costs against the number of layers and of pixels."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from codegen.library import Library
from conformance.bench.clocks import Clock
from conformance.bench.fur.frames import FAKE_FUR, frame, studio
from conformance.bench.fur.rounds import drawn_in_turns, line

LAYERS = (4, 8, 16, 32, 48, 64)
LAYERS_SIDE = 384
SIDES = (192, 320, 448, 576, 704)


def against_layers(library: Library, target: str, rounds: int, clock: Clock) -> dict[str, Any]:
    """Frames with more and more shells, whose opacity is resampled so that the coat stays as dense."""
    made = studio(library, FAKE_FUR, LAYERS_SIDE)
    authored = float(made.fur.layers - 1)
    frames = {}
    for layers in LAYERS:
        coat = replace(made.fur, layers=layers, authored_layers=authored)
        frames[str(layers)] = frame(replace(made, fur=coat), target)
    times = drawn_in_turns(frames, target, rounds, clock)
    shells = [layers - 1 for layers in LAYERS]
    return described("shell", shells, [times[str(layers)] for layers in LAYERS], side=LAYERS_SIDE)


def against_pixels(library: Library, target: str, rounds: int, clock: Clock) -> dict[str, Any]:
    """Frames with more and more pixels; by the million."""
    made = studio(library, FAKE_FUR, SIDES[0])
    frames = {}
    for side in SIDES:
        picture = replace(made.picture, size=(side, side))
        frames[str(side)] = frame(replace(made, picture=picture), target)
    times = drawn_in_turns(frames, target, rounds, clock)
    return described(
        "megapixels", [side * side / 1e6 for side in SIDES], [times[str(side)] for side in SIDES]
    )


def described(unit: str, x: list[Any], seconds: list[list[float]], **more: Any) -> dict[str, Any]:
    """Milliseconds per frame against x, and the line through their medians."""
    ms = [float(np.median(times)) * 1000.0 for times in seconds]
    return {"unit": unit, "x": x, "ms": ms, **line(x, ms), **more}
