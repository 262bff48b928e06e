"""The error of stages at the fragments of a picture: their own fragment stage against float64.

Rays find the fragments (where hairs meet pixels) and shade them in float64. The same fragments, each as a
square of one pixel that hands its values on, are drawn into floats of 32 bits by the fragment stage under
test. So no hair can have moved by a pixel, and nothing is blended.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.fur.coat import quads
from codegen.scene.description.document import HALF_STEP
from conformance.bench.fur.frames import Frame
from conformance.picture.backends import open_backend
from conformance.picture.fur.march import March
from conformance.picture.fur.studio import FurStudio
from conformance.picture.rasterise import open_scene
from targets.raster import Draw

FOLDER = Path(__file__).parent / "handwritten"
PROBE = np.dtype(
    [
        ("place", "<f4", 2),
        ("position", "<f4", 3),
        ("normal", "<f4", 3),
        ("tangent", "<f4", 3),
        ("share", "<f4", 2),
        ("uv", "<f4", 2),
        ("layer", "<f4", 2),
    ]
)
STATE = {"blend": None, "depth_test": "less-equal", "depth_write": True, "cull": "none"}


@dataclass(frozen=True)
class Fragments:
    """Fragments of shells.

    values  (N,) of PROBE without their places
    exact   (N, 3) linear RGB in float64
    """

    values: npt.NDArray[Any]
    exact: npt.NDArray[np.float64]


class _Collector(March):
    """Keeps what it shades."""

    def __init__(self, studio: FurStudio) -> None:
        super().__init__(studio, open_backend("numpy", studio.library))
        self.found: list[tuple[dict[str, Any], npt.NDArray[np.float64]]] = []

    def _radiance(self, points: dict[str, npt.NDArray[Any]]) -> npt.NDArray[np.float64]:
        shaded = super()._radiance(points)
        if "opacity" not in points and float(points["height"].min()) > 0.0:
            self.found.append((points, shaded))
        return shaded


def fragments(studio: FurStudio) -> Fragments:
    """The fragments of all shells of a picture."""
    march = _Collector(studio)
    march.draw()
    parts = []
    for points, shaded in march.found:
        values = np.zeros(len(shaded), PROBE)
        for name in ("position", "normal", "tangent", "share", "uv"):
            values[name] = points[name]
        values["layer"] = np.column_stack([points["height"][:, 0], np.ones(len(shaded))])
        parts.append(values)
    return Fragments(np.concatenate(parts), np.concatenate([shaded for _, shaded in march.found]))


def drawn(frame: Frame, target: str, found: Fragments) -> npt.NDArray[np.float64]:
    """What the fragment stage of the shells makes of fragments: (N, 3), NaN where it draws nothing."""
    side = int(np.ceil(np.sqrt(len(found.values))))
    number = np.arange(len(found.values))
    row, column = number // side, number % side
    vertices = np.repeat(found.values, 4).reshape(-1, 4)
    for k, (x, y) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
        vertices["place"][:, k, 0] = 2.0 * (column + x) / side - 1.0
        vertices["place"][:, k, 1] = 1.0 - 2.0 * (row + y) / side
    probe = (FOLDER / f"probe.{target}").read_text(encoding="utf-8")
    texts: Mapping[str, str] = frame.texts
    stages = probe, texts.get("shell.frag", "")
    if target == "wgsl":
        texts, stages = {"fur.wgsl": f"{texts['fur.wgsl']}\n{probe}"}, ("probe_vertex", "shell_fragment")
    draw = Draw(*stages, vertices.reshape(-1), quads(len(number)), 1, STATE)
    scene = open_scene(target, texts, "fur.wgsl", [draw], (side, side), bits=32)
    picture = scene.draw(frame.block).reshape(-1, 4)[: len(number)].astype(np.float64)
    scene.release()
    shown: npt.NDArray[np.float64] = np.where(picture[:, 3:] > 0.0, picture[:, :3], np.nan)
    return shown


def errors(frame: Frame, target: str, found: Fragments) -> dict[str, Any]:
    """Errors of linear RGB in half steps of 8 bits over the fragments."""
    got = drawn(frame, target, found)
    finite = np.isfinite(got).all(axis=1)
    off = np.abs(got[finite] - found.exact[finite]).max(axis=1) / HALF_STEP
    return {
        "max": float(off.max()),
        "p999": float(np.quantile(off, 0.999)),
        "median": float(np.median(off)),
        "missing": int((~finite).sum()),
        "fragments": len(got),
    }
