"""How shells converge to a coat as they grow in number: `python -m conformance.picture.fur.convergence`.

Rays meet the shells of a scene, shaded by a target that draws nothing; a rasteriser draws the same shells.
Both are compared with the rays' picture of many layers. Hairs keep their opacity (`shell_alpha_resample`), so
only the steps between the layers change.
"""

from __future__ import annotations

import argparse
import io
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from codegen.errors import UserError
from codegen.files import write_bytes
from codegen.library import load_library
from conformance.picture.fur.draw import draw_fur
from conformance.picture.fur.studio import FurStudio, set_up_fur
from conformance.picture.rasterise import develop
from conformance.picture.scene import SCENES
from conformance.picture.tone import eight_bit, steps_apart
from conformance.plots import BLUE, INK, LINE, ORANGE, SOFT

Doubles = npt.NDArray[np.float64]

LAYERS, REFERENCE = (5, 9, 17, 33, 65), 129
SHOWN = (5, 17, 65)
OPACITY = 0.3
"""Of a hair on one of the reference's shells: light passes several shells, so that their number matters."""
SIDE, SUPERSAMPLE = 96, 2
MARKS: tuple[dict[str, Any], ...] = (
    {"color": BLUE, "marker": "o", "markersize": 9.0, "markerfacecolor": "none"},
    {"color": ORANGE, "marker": "x", "markersize": 6.0, "linestyle": "none"},
)
"""The ways of drawing all but coincide."""
TICKS = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)
INTERFACES = {"glsl": "drawn by OpenGL", "wgsl": "drawn by WebGPU", "opencl": "rays on OpenCL"}


@dataclass(frozen=True)
class Series:
    """One way of drawing and its driver: mean differences in 8-bit steps by number of layers."""

    name: str
    driver: str
    steps: dict[int, float]


@dataclass(frozen=True)
class Convergence:
    """Both ways of drawing, and pictures (height, width, 3) of the first by number of layers."""

    series: tuple[Series, ...]
    pictures: dict[int, Doubles]


def converge(studio: FurStudio, targets: Sequence[str], layers: Sequence[int], reference: int) -> Convergence:
    """Draw with every number of layers; the first target's picture of `reference` layers is the goal."""

    def drawn(target: str, count: int) -> tuple[Doubles, str]:
        coat = replace(studio.fur, layers=count, opacity=OPACITY, authored_layers=float(reference - 1))
        samples, driver = draw_fur(replace(studio, fur=coat), target)
        return develop(studio.picture, samples), driver

    goal, _ = drawn(targets[0], reference)
    pictures, series = {reference: goal}, []
    for target in targets:
        steps, driver = {}, ""
        for count in layers:
            picture, driver = drawn(target, count)
            steps[count] = float(steps_apart(picture, goal).mean())
            if target == targets[0]:
                pictures[count] = picture
        series.append(Series(INTERFACES.get(target, f"rays on {target}"), driver, steps))
    return Convergence(tuple(series), pictures)


def figure(found: Convergence, reference: int, shown: Sequence[int]) -> bytes:
    """The curves, and the pictures that they are about, as PNG."""
    page = Figure(figsize=(11.0, 3.5), dpi=130, layout="constrained")
    grid = page.add_gridspec(1, 2, width_ratios=(1.0, 2.6))
    axes = page.add_subplot(grid[0])
    for one, mark in zip(found.series, MARKS, strict=False):
        axes.plot(list(one.steps), list(one.steps.values()), label=one.name, **mark)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.xaxis.set_major_locator(FixedLocator(list(found.series[0].steps)))
    axes.yaxis.set_major_locator(FixedLocator(TICKS))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_minor_locator(NullLocator())
        axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
    axes.set_xlabel("layers", color=SOFT)
    axes.set_ylabel("mean difference, 8-bit steps", color=SOFT)
    axes.grid(True, color=LINE, linewidth=0.7)
    axes.set_axisbelow(True)
    axes.legend(fontsize=9, frameon=False, labelcolor=INK, loc="lower left")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    strip = grid[1].subgridspec(1, len(shown) + 1, wspace=0.03)
    for k, count in enumerate((*shown, reference)):
        place = page.add_subplot(strip[k])
        place.imshow(eight_bit(found.pictures[count]), interpolation="nearest")
        title = f"{count} layers, the goal" if count == reference else f"{count} layers"
        place.set_title(title, fontsize=10, color=INK)
        place.set_axis_off()
    data = io.BytesIO()
    page.savefig(data, format="png", metadata={"Software": None})
    return data.getvalue()


def main() -> int:
    """Run; returns the exit status."""
    parser = argparse.ArgumentParser(description="How shells converge to a coat as their number grows.")
    parser.add_argument("-o", "--output", type=Path, required=True, help="the PNG file to write")
    parser.add_argument("--scene", type=Path, default=SCENES / "furry-bunny.toml", help="a scene file")
    parser.add_argument("--rays", default="opencl", help="opencl, numpy or numpy32")
    parser.add_argument("--drawn", default="glsl", help="glsl or wgsl")
    options = parser.parse_args()
    try:
        changes: dict[str, Any] = {"size": (SIDE, SIDE), "supersample": SUPERSAMPLE, "subdivide": 0}
        studio = set_up_fur(load_library(), options.scene, **changes)
        found = converge(studio, (options.rays, options.drawn), LAYERS, REFERENCE)
        write_bytes(options.output, figure(found, REFERENCE, SHOWN))
    except UserError as error:
        print(f"convergence: {error}", file=sys.stderr)
        return 2
    for one in found.series:
        steps = ", ".join(f"{count}: {mean:.2f}" for count, mean in one.steps.items())
        print(f"{one.name}, {one.driver}: {steps}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
